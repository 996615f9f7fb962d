#pragma once
/// A Stored matrix keeps an Eigen matrix of fixed size as plain numbers. Eigen's types are not trivially copyable; the
/// state of a law has to be (signals/law_snapshot.h).

#include <Eigen/Core>
#include <array>

namespace robot_control {

template <class Matrix>
class Stored {
 public:
  Stored() noexcept = default;  ///< zero
  explicit Stored(const Matrix& matrix) noexcept { **this = matrix; }

  /// Return the matrix to read or change in place.
  Eigen::Map<Matrix> operator*() noexcept { return Eigen::Map<Matrix>(numbers_.data()); }
  Eigen::Map<const Matrix> operator*() const noexcept { return Eigen::Map<const Matrix>(numbers_.data()); }

 private:
  std::array<double, Matrix::SizeAtCompileTime> numbers_{};
};

}  // namespace robot_control

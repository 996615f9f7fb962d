#include "control/legged/stand/foot_forces.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

namespace robot_control {

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) noexcept {
  Eigen::Matrix3d matrix;
  matrix << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return matrix;
}

std::array<Eigen::Vector3d, kLegs> foot_forces(const FootForcesInput& input) noexcept {
  // With Gᵢ = [1; pᵢ×], fᵢ = wᵢ Gᵢᵀ λ and Σ wᵢ Gᵢ Gᵢᵀ λ = [force; moment].
  Eigen::Matrix<double, 6, 6> sum = Eigen::Matrix<double, 6, 6>::Zero();
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const Eigen::Matrix3d lever = cross_matrix(input.feet[leg]);
    sum.topLeftCorner<3, 3>().diagonal().array() += input.share[leg];
    sum.bottomLeftCorner<3, 3>() += input.share[leg] * lever;
    sum.bottomRightCorner<3, 3>() -= input.share[leg] * lever * lever;
  }
  Eigen::Matrix<double, 6, 1> wrench;
  wrench << input.force, input.moment;
  const Eigen::Matrix<double, 6, 1> multiplier = sum.selfadjointView<Eigen::Lower>().ldlt().solve(wrench);
  std::array<Eigen::Vector3d, kLegs> forces;
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const Eigen::Vector3d force =
        input.share[leg] * (multiplier.head<3>() + multiplier.tail<3>().cross(input.feet[leg]));
    const bool pushes = input.up.dot(force) > 0;  // false for not-a-number, too
    forces[leg] = pushes ? force : Eigen::Vector3d::Zero();
  }
  return forces;
}

}  // namespace robot_control

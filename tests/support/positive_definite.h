#pragma once
/// Checks whether a matrix can be a covariance. The code is our own, because an instance of Eigen's solvers takes
/// seconds to compile.

#include <cmath>
#include <cstddef>
#include <vector>

namespace robot_control {

/// True if the smallest eigenvalue of the symmetric matrix p(i, j) of `size` rows, scaled to correlations, is above
/// -`slack`. Then the pivots of Cholesky's decomposition are positive once `slack` is added to the diagonal. Quantities
/// without variance, and so without covariances, are left out.
template <class Matrix>
bool positive_definite(const Matrix& p, std::size_t size, double slack) {
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < size; ++i) {
    if (p(i, i) != 0) {
      kept.push_back(i);
      continue;
    }
    for (std::size_t j = 0; j < size; ++j) {
      if (p(i, j) != 0) return false;
    }
  }
  std::vector<std::vector<double>> root(kept.size(), std::vector<double>(kept.size(), 0));
  for (std::size_t i = 0; i < kept.size(); ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double rest = p(kept[i], kept[j]) / std::sqrt(p(kept[i], kept[i]) * p(kept[j], kept[j]));
      for (std::size_t k = 0; k < j; ++k) rest -= root[i][k] * root[j][k];
      if (i != j) {
        root[i][j] = rest / root[j][j];
      } else if (rest + slack > 0) {
        root[i][i] = std::sqrt(rest + slack);
      } else {
        return false;  // true for a NaN, too: a variance below 0
      }
    }
  }
  return true;
}

}  // namespace robot_control

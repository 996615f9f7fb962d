#include "control/legged/load_sharing.h"

#include <Eigen/LU>
#include <algorithm>

namespace robot_control {

std::array<double, kLegs> shared_loads(const LoadInput& input) noexcept {
  Eigen::Matrix<double, 3, kLegs> balance;
  Eigen::Matrix<double, kLegs, 1> share;
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const auto column = static_cast<Eigen::Index>(leg);
    balance.col(column) << 1, input.feet[leg].x(), input.feet[leg].y();
    share[column] = input.share[leg];
  }
  const Eigen::Matrix<double, kLegs, 3> weighted = share.asDiagonal() * balance.transpose();
  const Eigen::Vector3d multiplier = (balance * weighted).inverse() * Eigen::Vector3d(input.weight, 0, 0);
  const Eigen::Matrix<double, kLegs, 1> forces = weighted * multiplier;
  std::array<double, kLegs> result{};
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const double force = forces[static_cast<Eigen::Index>(leg)];
    result[leg] = force > 0 ? std::min(force, input.weight) : 0;  // also for not-a-number
  }
  return result;
}

}  // namespace robot_control

#include "safety/measurements/attitude.h"

#include <algorithm>
#include <cmath>

#include "machine/gravity.h"

namespace robot_control {

void Attitude::step(const Eigen::Vector3d* rate, const Eigen::Vector3d* force, double dt) noexcept {
  uncorrected_ = std::min(uncorrected_ + dt, 2 * kTrustTime);
  if (rate != nullptr) {
    const Eigen::Matrix3d back = turned_back(*rate, dt);
    up_.turn(back);
    if (force_time_ > 0) *force_ = back * Eigen::Vector3d(*force_);
  }
  if (force != nullptr) pull(force_time_ > 0 ? smooth(*force, dt) : *force, dt);
  tilt_rate_ = rate != nullptr ? up_.tilt_rate(*rate) : 0;
}

Eigen::Vector3d Attitude::smooth(const Eigen::Vector3d& force, double dt) noexcept {
  if (force.norm() < kMaxForce)
    *force_ += ((*force_).isZero(0) ? 1 : std::min(1.0, dt / force_time_)) * (force - *force_);
  return *force_;
}

void Attitude::pull(const Eigen::Vector3d& force, double dt) noexcept {
  const double size = force.norm();
  if (!(std::abs(size - kGravity) < kBand)) return;
  up_.pull(force / size, known() ? std::min(1.0, dt / kTimeConstant) : 1);
  uncorrected_ = 0;
}

}  // namespace robot_control

#include "safety/measurements/attitude.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "machine/gravity.h"

namespace robot_control {
namespace {

constexpr double kUpright = 1e-9;  // rad; below it no direction of tilting is known

}  // namespace

void Attitude::step(const Eigen::Vector3d* rate, const Eigen::Vector3d* force, double dt) noexcept {
  uncorrected_ = std::min(uncorrected_ + dt, 2 * kTrustTime);
  if (rate != nullptr) carry(*rate, dt);
  if (force != nullptr) pull(force_time_ > 0 ? smooth(*force, dt) : *force, dt);
  horizontal_ = std::hypot((*up_).x(), (*up_).y());
  const bool leaning = rate != nullptr && horizontal_ > kUpright;
  tilt_rate_ = leaning ? (rate->x() * (*up_).y() - rate->y() * (*up_).x()) / horizontal_ : 0;
}

void Attitude::carry(const Eigen::Vector3d& rate, double dt) noexcept {
  const double size = rate.norm();
  const double angle = size * dt;
  if (!(angle > 0 && std::isfinite(angle))) return;
  const Eigen::AngleAxisd back(-angle, rate / size);
  *up_ = back * up();
  if (force_time_ > 0) *force_ = back * Eigen::Vector3d(*force_);
}

Eigen::Vector3d Attitude::smooth(const Eigen::Vector3d& force, double dt) noexcept {
  if (force.norm() < kMaxForce)
    *force_ += ((*force_).isZero(0) ? 1 : std::min(1.0, dt / force_time_)) * (force - *force_);
  return *force_;
}

void Attitude::pull(const Eigen::Vector3d& force, double dt) noexcept {
  const double size = force.norm();
  if (!(std::abs(size - kGravity) < kBand)) return;
  const Eigen::Vector3d measured = force / size;
  const double weight = known() ? std::min(1.0, dt / kTimeConstant) : 1;
  const Eigen::Vector3d pulled = *up_ + weight * (measured - *up_);
  uncorrected_ = 0;
  const double length = pulled.norm();
  *up_ = length > 0.5 ? Eigen::Vector3d(pulled / length) : measured;
}

double Attitude::tilt() const noexcept {
  return std::atan2(horizontal_, (*up_).z());
}

}  // namespace robot_control

#include "estimation/slip/motion_difference.h"

namespace robot_control {

void MotionDifference::restart() noexcept {
  count_ = 0;
  now_ = {.yaw = now_.yaw};
  inertial_path_ = wheel_path_ = {};
  path_begin_ = 0;
}

void MotionDifference::restart_on_line(const Planar& slope) noexcept {
  const Planar velocity = now_.velocity;
  const double yaw_rate = now_.yaw_rate;
  restart();
  now_.velocity = velocity;
  now_.yaw_rate = yaw_rate;
  constexpr std::size_t kPast = 34;  // points: twice the longest span, and its tolerance
  for (std::size_t i = kPast; i-- > 0;) {
    Point point = now_;
    point.time = -static_cast<double>(i) * Tuning::kPointInterval;
    point.path_difference = slope * point.time;
    points_[count_++] = point;
  }
  wheel_path_ = -lever_;
}

void MotionDifference::restart_at_rest(double yaw, const Vector3& up) noexcept {
  lever_ = lever(yaw, up);
  now_ = {.yaw = yaw};
  restart_on_line({});
}

/// Nose up, an IMU above the contacts moves backwards.
Planar MotionDifference::lever(double yaw, const Vector3& up) const noexcept {
  return rotated({params_.imu_x - params_.imu_above_ground * up[0], params_.imu_y - params_.imu_above_ground * up[1]},
                 yaw);
}

bool MotionDifference::step(const Sample& sample) noexcept {
  const Planar acceleration = rotated({sample.acceleration[0], sample.acceleration[1]}, sample.yaw - sample.turned / 2);
  inertial_path_ = inertial_path_ + (now_.velocity + acceleration * sample.dt / 2) * sample.dt;
  wheel_path_ = wheel_path_ + sample.path;
  lever_ = lever(sample.yaw, sample.up);
  now_.time += sample.dt;
  now_.velocity = now_.velocity + acceleration * sample.dt;
  now_.yaw = sample.yaw;
  now_.yaw_rate = sample.yaw_rate;
  now_.distance += sample.distance;
  now_.turn_difference += sample.right_minus_left - params_.wheel_base * sample.turned;
  now_.path_difference = wheel_path_ + lever_ - inertial_path_;
  const bool early = count_ > 0 && now_.time - last().time < Tuning::kPointInterval * (1 - 1e-9);
  if (!sample.both_sides_read || early) return false;
  points_[count_++ % kPoints] = now_;
  return true;
}

const MotionDifference::Point& MotionDifference::before(double time) const noexcept {
  const std::size_t oldest = count_ > kPoints ? count_ - kPoints : 0;
  std::size_t i = count_ - 1;
  while (i > oldest && points_[i % kPoints].time > time + 1e-9) --i;
  return points_[i % kPoints];
}

}  // namespace robot_control

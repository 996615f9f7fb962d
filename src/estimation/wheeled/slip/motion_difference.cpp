#include "estimation/wheeled/slip/motion_difference.h"

#include <algorithm>
#include <utility>

namespace robot_control {

void MotionDifference::restart() noexcept {
  count_ = 0;
  now_ = {.inertial = lever_, .yaw = now_.yaw};
  path_begin_ = 0;
}

void MotionDifference::restart_on_line(const Planar& slope) noexcept {
  path_begin_ = time();
  if (empty()) return;
  const Point end = last();
  for (std::size_t i = oldest(); i < count_ && record(i).time <= end.time; ++i) {
    const Point point = difference(record(i));
    const Planar on_line = end.path_difference + slope * (point.time - end.time);
    record(i).wheel_path = record(i).wheel_path + on_line - point.path_difference;
    record(i).right_minus_left += end.turn_difference - point.turn_difference;
  }
}

void MotionDifference::restart_at_rest(double yaw, const Vector3& up, const Planar& velocity) noexcept {
  lever_ = lever(yaw, up);
  now_.yaw = yaw;
  restart();
  now_.wheel_path = -lever_;
  constexpr std::size_t kPast = 34;  // points: twice the longest span, and its tolerance
  for (std::size_t i = kPast; i-- > 0;) {
    Record& past = record(count_++);
    past = now_;
    past.time = -static_cast<double>(i) * Tuning::kPointInterval;
  }
  now_.velocity = velocity;
}

/// When the nose rises, an IMU above the contacts moves backwards.
Planar MotionDifference::lever(double yaw, const Vector3& up) const noexcept {
  return rotated({params_.imu_x - params_.imu_above_ground * up[0], params_.imu_y - params_.imu_above_ground * up[1]},
                 yaw);
}

bool MotionDifference::step(const Sample& sample) noexcept {
  const Planar acceleration = rotated({sample.acceleration[0], sample.acceleration[1]}, sample.yaw - sample.turned / 2);
  const Planar lever_before = std::exchange(lever_, lever(sample.yaw, sample.up));
  now_.time += sample.dt;
  now_.inertial = now_.inertial + lever_ - lever_before - (now_.velocity + acceleration * sample.dt / 2) * sample.dt;
  now_.velocity = now_.velocity + acceleration * sample.dt;
  now_.yaw = sample.yaw;
  now_.yaw_rate = sample.yaw_rate;
  now_.wheel_path = now_.wheel_path + sample.path;
  now_.right_minus_left += sample.right_minus_left;
  now_.distance += sample.distance;
  const bool early = count_ > 0 && time() - record(count_ - 1).time < Tuning::kPointInterval * (1 - 1e-9);
  if (!sample.both_sides_read || early) return false;
  record(count_++) = now_;
  return true;
}

std::size_t MotionDifference::index_before(double time) const noexcept {
  std::size_t i = count_ - 1;
  while (i > oldest() && record(i).time > time + 1e-9) --i;
  return i;
}

MotionDifference::Point MotionDifference::before(double time) const noexcept {
  return difference(record(index_before(std::min(time, this->time() + std::min(0.0, clock_offset_)))));
}

/// Between two points the inertial motion has a constant acceleration.
MotionDifference::Point MotionDifference::difference(const Record& wheels) const noexcept {
  const double time = wheels.time - clock_offset_;
  const std::size_t i = index_before(time);
  const Record& from = record(i);
  const Record& to = i + 1 < count_ ? record(i + 1) : now_;
  const double span = to.time - from.time;
  const double part = span > 0 ? std::clamp((time - from.time) / span, 0.0, 1.0) : 0;
  const double bend = span * part * (part - 1) / 2;
  const Planar inertial = from.inertial + (to.inertial - from.inertial) * part - (to.velocity - from.velocity) * bend;
  const double yaw = from.yaw + (to.yaw - from.yaw) * part + (to.yaw_rate - from.yaw_rate) * bend;
  return {.time = wheels.time,
          .path_difference = wheels.wheel_path + inertial,
          .turn_difference = wheels.right_minus_left - params_.wheel_base * yaw,
          .distance = wheels.distance,
          .yaw = yaw,
          .velocity = from.velocity + (to.velocity - from.velocity) * part,
          .yaw_rate = from.yaw_rate + (to.yaw_rate - from.yaw_rate) * part};
}

}  // namespace robot_control

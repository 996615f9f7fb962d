#include "estimation/slip/motion_difference.h"

#include <algorithm>

namespace robot_control {

void MotionDifference::restart() noexcept {
  count_ = 0;
  const double yaw = now_.inertial.yaw;
  now_ = {};
  now_.inertial.yaw = yaw;
  path_begin_ = 0;
}

void MotionDifference::restart_on_line(const Planar& slope) noexcept {
  path_begin_ = time();
  if (empty()) return;
  const Point end = last();
  const std::size_t last_record = last_index();
  for (std::size_t i = oldest(); i <= last_record; ++i) {
    const Point point = difference(record(i));
    const Planar on_line = end.path_difference + slope * (point.time - end.time);
    Record& moved = records_[i % kPoints];
    moved.wheel_path = moved.wheel_path + on_line - point.path_difference;
    moved.right_minus_left += end.turn_difference - point.turn_difference;
  }
}

void MotionDifference::restart_at_rest(double yaw, const Vector3& up, const Planar& velocity) noexcept {
  restart();
  now_.inertial.yaw = yaw;
  now_.inertial.lever = lever(yaw, up);
  now_.wheel_path = -now_.inertial.lever;
  constexpr std::size_t kPast = 34;  // points: twice the longest span, and its tolerance
  for (std::size_t i = kPast; i-- > 0;) {
    Record& record = records_[count_++];
    record = now_;
    record.inertial.time = -static_cast<double>(i) * Tuning::kPointInterval;
  }
  now_.inertial.velocity = velocity;
}

/// When the nose rises, an IMU above the contacts moves backwards.
Planar MotionDifference::lever(double yaw, const Vector3& up) const noexcept {
  return rotated({params_.imu_x - params_.imu_above_ground * up[0], params_.imu_y - params_.imu_above_ground * up[1]},
                 yaw);
}

bool MotionDifference::step(const Sample& sample) noexcept {
  const Planar acceleration = rotated({sample.acceleration[0], sample.acceleration[1]}, sample.yaw - sample.turned / 2);
  Inertial& inertial = now_.inertial;
  inertial.time += sample.dt;
  inertial.path = inertial.path + (inertial.velocity + acceleration * sample.dt / 2) * sample.dt;
  inertial.lever = lever(sample.yaw, sample.up);
  inertial.velocity = inertial.velocity + acceleration * sample.dt;
  inertial.yaw = sample.yaw;
  inertial.yaw_rate = sample.yaw_rate;
  now_.wheel_path = now_.wheel_path + sample.path;
  now_.right_minus_left += sample.right_minus_left;
  now_.distance += sample.distance;
  const bool early = count_ > 0 && time() - record(count_ - 1).inertial.time < Tuning::kPointInterval * (1 - 1e-9);
  if (!sample.both_sides_read || early) return false;
  records_[count_++ % kPoints] = now_;
  return true;
}

std::size_t MotionDifference::index_before(double time) const noexcept {
  std::size_t i = count_ - 1;
  while (i > oldest() && record(i).inertial.time > time + 1e-9) --i;
  return i;
}

MotionDifference::Point MotionDifference::before(double time) const noexcept {
  return difference(record(std::min(index_before(time), last_index())));
}

/// Path and yaw follow the cubic through values and derivatives of both points (Hermite), the rest a line.
MotionDifference::Inertial MotionDifference::inertial_at(double time) const noexcept {
  const std::size_t i = index_before(time);
  const Inertial& from = record(i).inertial;
  const Inertial& to = i + 1 < count_ ? record(i + 1).inertial : now_.inertial;
  const double span = to.time - from.time;
  const double passed = time - from.time;
  const double part = span > 0 ? std::clamp(passed / span, 0.0, 1.0) : 0;
  const auto cubic = [&](const auto& a, const auto& a_rate, const auto& b, const auto& b_rate, const auto& rate) {
    return a + (a_rate + rate) * (passed / 2) +
           (b - a - (a_rate + b_rate) * (span / 2)) * (part * part * (3 - 2 * part));
  };
  Inertial motion{.time = time,
                  .lever = from.lever + (to.lever - from.lever) * part,
                  .velocity = from.velocity + (to.velocity - from.velocity) * part,
                  .yaw_rate = from.yaw_rate + (to.yaw_rate - from.yaw_rate) * part};
  motion.path = cubic(from.path, from.velocity, to.path, to.velocity, motion.velocity);
  motion.yaw = cubic(from.yaw, from.yaw_rate, to.yaw, to.yaw_rate, motion.yaw_rate);
  return motion;
}

MotionDifference::Point MotionDifference::difference(const Record& record) const noexcept {
  const Inertial inertial = inertial_at(record.inertial.time - clock_offset_);
  return {.time = record.inertial.time,
          .path_difference = record.wheel_path + inertial.lever - inertial.path,
          .turn_difference = record.right_minus_left - params_.wheel_base * inertial.yaw,
          .distance = record.distance,
          .yaw = inertial.yaw,
          .velocity = inertial.velocity,
          .yaw_rate = inertial.yaw_rate};
}

}  // namespace robot_control

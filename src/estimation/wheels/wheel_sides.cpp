#include "estimation/wheels/wheel_sides.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimation/tuning.h"

namespace robot_control {

WheelSides::WheelSides(const RobotModel& robot, double bandwidth, double period, double count)
    : geometry_(robot),
      longest_held_(static_cast<double>(Tuning::kMaxHeld) * period),
      sides_{SideState{SideEncoder(robot, Side::kLeft), SpeedTracker(bandwidth, period)},
             SideState{SideEncoder(robot, Side::kRight), SpeedTracker(bandwidth, period)}},
      quantum_(count) {}

WheelSides::Readings WheelSides::step(const SensorFrame& sensors, double dt) noexcept {
  Readings readings;
  for (SideState& side : sides_) {
    const EncoderReading reading = side.encoder.step(sensors, dt);
    if (reading == EncoderReading::kTravel && side.encoder.time() > 0) {
      side.speed.step(side.encoder.travel(), side.encoder.time());
    }
    if (reading == EncoderReading::kTravel && &side == &sides_[kLeft] && side.encoder.time() > 0) {
      jitter_.add(side.encoder.time());
      quantum_.add(side.encoder.travel(), side.encoder.time());
    }
    if (reading == EncoderReading::kRejected) readings.refused = true;
    if (reading == EncoderReading::kOffset || reading == EncoderReading::kLost) readings.restarted = true;
    if (reading == EncoderReading::kLost) {
      ++readings.lost_travels;
      side.credited = 0;
    }
  }
  return readings;
}

void WheelSides::turn(double angle) noexcept {
  for (SideState& side : sides_) side.turned += angle;
}

void WheelSides::forget_turn() noexcept {
  for (SideState& side : sides_) side.turned = 0;
}

FixedVector<WheelSides::Travel, 2> WheelSides::take_travels(double ratio) noexcept {
  FixedVector<Travel, 2> travels;
  const SideState& first = sides_[kLeft];
  const bool together = both_received() && first.credited == 0 && sides_[kRight].credited == 0;
  if (together && first.turned == sides_[kRight].turned) {
    travels.emplace_back(mean() + ratio * (right() - left()) / 4, first.turned / 2);
    forget_turn();
    return travels;
  }
  for (const std::size_t side : {kLeft, kRight}) {
    if (received(side)) travels.emplace_back(take_travel(side));
  }
  return travels;
}

WheelSides::Travel WheelSides::take_travel(std::size_t i) noexcept {
  SideState& side = sides_[i];
  SideState& other = sides_[1 - i];
  const double turned = std::exchange(side.turned, 0);
  double distance = (travel(i) - std::exchange(side.credited, 0)) / 2;
  if (lost(1 - i)) {
    const double across = (i == kLeft ? 1 : -1) * turned * geometry_.wheel_base;
    distance = travel(i) + across / 2;
    other.credited += travel(i) + across;
  }
  return {distance, turned / 2};
}

void WheelSides::average_speed(double lateness) noexcept {
  const SideEncoder& left = sides_[kLeft].encoder;
  const double span = std::max(lateness, left.gap());
  const double keep = span / (span + left.time());
  recent_distance_ = keep * recent_distance_ + mean();
  recent_time_ = keep * recent_time_ + left.time();
}

void WheelSides::set_speed(double speed, double rate) noexcept {
  const double turn = rate * geometry_.wheel_base / 2;
  sides_[kLeft].speed.reset(speed - turn);
  sides_[kRight].speed.reset(speed + turn);
}

double WheelSides::speed_at(double rate) const noexcept {
  if (lost(kLeft) == lost(kRight)) return speed();
  const std::size_t side = lost(kLeft) ? kRight : kLeft;
  return sides_[side].speed.speed() + (side == kLeft ? 1 : -1) * rate * geometry_.wheel_base / 2;
}

double WheelSides::unread_distance(std::size_t side) const noexcept {
  if (received(side) || (lost(side) && !lost(1 - side))) return 0;  // The other side replaces it.
  const SideEncoder& encoder = sides_[side].encoder;
  return sides_[side].speed.speed() * std::min(encoder.waiting(), std::max(encoder.gap(), longest_held_)) / 2;
}

bool WheelSides::lost(std::size_t side) const noexcept {
  const SideEncoder& encoder = sides_[side].encoder;
  return !encoder.known() || encoder.waiting() > std::max(longest_held_ * (1 + 1e-9), 2 * encoder.gap());
}

bool WheelSides::both_fell_silent() const noexcept {
  return both_lost() && sides_[kLeft].encoder.gap() > 0 && sides_[kRight].encoder.gap() > 0;
}

bool WheelSides::in_a_batch() noexcept {
  if (!both_received()) return false;
  const double gap = sides_[kLeft].encoder.time();
  usual_gap_ = usual_gap_ == 0 ? gap : usual_gap_ * (gap > usual_gap_ ? 1.05 : 0.95);
  return gap < Tuning::kBatch * usual_gap_;
}

}  // namespace robot_control

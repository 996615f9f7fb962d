#include "estimation/wheeled/wheels/wheel_sides.h"

#include <algorithm>
#include <utility>

#include "estimation/common/tuning.h"

namespace robot_control {

WheelSides::WheelSides(const DriveTrain& robot, double bandwidth, double period, double count)
    : longest_held_(static_cast<double>(Tuning::kMaxHeld) * period),
      sides_{SideEncoder(robot, Side::kLeft, bandwidth, period), SideEncoder(robot, Side::kRight, bandwidth, period)},
      quantum_(count) {}

WheelReading WheelSides::step(const SensorFrame& sensors, double dt, bool turns) noexcept {
  WheelReading reading;
  for (const std::size_t i : {0U, 1U}) {
    SideEncoder& encoder = sides_[i];
    const EncoderReading result = encoder.step(sensors, dt);
    if (i == 0 && result == EncoderReading::kTravel && encoder.time() > 0) {
      quantum_.add(encoder.travel(), encoder.time());
      const double change = encoder.time() > usual_gap_ ? 1.05 : 0.95;
      usual_gap_ = usual_gap_ == 0 ? encoder.time() : usual_gap_ * change;
    }
    encoder.assume_encoder_of(sides_[1 - i]);
    reading.refused = reading.refused || result == EncoderReading::kRejected;
    if (result == EncoderReading::kLost) reading.unknown_time[i] = encoder.time();
    reading.restarted = reading.restarted || result == EncoderReading::kOffset || result == EncoderReading::kLost;
    reading.travel[i] = encoder.travel();
    reading.speed[i] = encoder.speed();
    reading.received[i] = encoder.received();
    reading.lost[i] = lost(encoder);
  }
  for (const std::size_t i : {0U, 1U}) {
    if (reading.received[i] || (reading.lost[i] && !reading.lost[1 - i] && turns)) continue;  // It is replaced.
    reading.unread += reading.speed[i] * std::min(sides_[i].waiting(), std::max(sides_[i].gap(), longest_held_)) / 2;
    if (!reading.lost[i]) continue;
    reading.lost_time = std::max(reading.lost_time, sides_[i].waiting());
    reading.lost_speed[i] = std::exchange(reading.speed[i], 0);
  }
  reading.fell_silent = reading.both_lost() && sides_[0].gap() > 0 && sides_[1].gap() > 0;
  reading.batch = reading.both_received() && sides_[0].time() < Tuning::kBatch * usual_gap_;
  reading.gap = usual_gap_;
  reading.speed_step = quantum_.step();
  if (reading.both_received()) reading.travel_variance = quantum_.travel_variance();
  return reading;
}

void WheelSides::set_speed(double left, double right) noexcept {
  sides_[0].set_speed(left);
  sides_[1].set_speed(right);
}

bool WheelSides::lost(const SideEncoder& encoder) const noexcept {
  return !encoder.known() || encoder.waiting() > std::max(longest_held_ * (1 + 1e-9), 2 * encoder.gap());
}

}  // namespace robot_control

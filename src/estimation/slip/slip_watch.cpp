#include "estimation/slip/slip_watch.h"

#include <algorithm>

namespace robot_control {

SlipWatch::Output SlipWatch::step(const Input& input) noexcept {
  yaw_ += input.motion.turned;
  MotionDifference::Sample motion = input.motion;
  motion.yaw = yaw_;
  motion.path = rotated(motion.path, yaw_);
  Output output;
  const bool point = detector_.step(motion);
  if (point) evaluate(input, output);
  output.correction.shift = rotated(output.correction.shift, -yaw_);
  return output;
}

void SlipWatch::evaluate(const Input& input, Output& output) noexcept {
  const bool learns = !slide_.active();
  if (learns) detector_.set_clock_offset(input.clock_offset);
  detector_.evaluate(input.uncertainty, learns);
  output.judged = true;
  for (const auto channel : SlipResidual::kEach) output.nis[channel] = detector_.nis(channel);
  const MotionDifference& difference = detector_.difference();
  if (slide_.active()) {
    output.correction = slide_.step(difference, slide_input(input));
    if (!slide_.active()) detector_.restart_on_line(slide_.rolling_slope(difference));
  } else if (const double span = detector_.shortest_proven_span(); span == 0) {
    output.gravity = detector_.gravity_error();
  } else if (input.corrects) {
    output.sideways_began = detector_.proven(SlipResidual::kAcross);
    output.correction = slide_.begin(difference, span, slide_input(input));
  }
}

WheelSlide::Input SlipWatch::slide_input(const Input& input) const noexcept {
  const auto& variance = input.uncertainty.acceleration_variance;
  return {.noise = detector_.acceleration_noise(std::max(variance[0], variance[1])),
          .path_slope_deviation = detector_.slope_deviation(SlipResidual::kAlong),
          .turn_slope_deviation = detector_.slope_deviation(SlipResidual::kTurn),
          .side_speed = input.side_speed,
          .wheel_base = wheel_base_,
          .sideways = detector_.proven(SlipResidual::kAcross)};
}

void SlipWatch::restart() noexcept {
  slide_.end();
  detector_.restart();
}

void SlipWatch::restart_at_rest(const Vector3& up, const Planar& velocity) noexcept {
  slide_.end();
  detector_.restart_at_rest(yaw_, up, rotated(velocity, yaw_));
}

}  // namespace robot_control

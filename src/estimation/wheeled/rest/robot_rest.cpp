#include "estimation/wheeled/rest/robot_rest.h"

#include <cmath>
#include <utility>

#include "estimation/common/tuning.h"

namespace robot_control {

RestWatch::Bias RobotRest::bias(const Input& input) const noexcept {
  const bool known = bias_measured_ || !moved_ || input.bias_variance[2] < square(steady_ / Tuning::kSignificant);
  RestWatch::Bias bias{.value = input.bias, .known = known};
  for (std::size_t i = 0; i < 3; ++i) {
    bias.deviation[i] = std::sqrt(input.mean_variance + (bias.known ? input.bias_variance[i] : input.mean_variance));
  }
  return bias;
}

RobotRest::Output RobotRest::step(const Input& input) noexcept {
  if (!resting_) {
    const RestWindow window = watch_.step(input.sample, bias(input));
    if (input.any_lost) watch_.reset();
    if (input.any_lost || window != RestWindow::kQuiet) return {};
    resting_ = standing_ = true;
    forget_held();
    if (watch_.bias_changed()) return learn(true);
    watch_.discard();
    return {.began = true};
  }
  HeldMotion now{.time = input.sample.dt,
                 .left = input.sample.left,
                 .right = input.sample.right,
                 .velocity = input.acceleration * input.sample.dt,
                 .gyro = input.rate.has_value()};
  for (std::size_t i = 0; now.gyro && i < 3; ++i) now.turn[i] = (*input.rate)[i] * input.sample.dt;
  open_.add(now);
  if (input.fell_silent) {  // No sensor confirms that the robot still rests.
    watch_.reset();
    standing_ = false;
    return {};
  }
  return close(watch_.step(input.sample, bias(input)));
}

RobotRest::Output RobotRest::close(RestWindow window) noexcept {
  if (window == RestWindow::kOpen) return {};
  if (window == RestWindow::kQuiet) {
    last_ = std::exchange(open_, {});
    standing_ = true;
    return learn(false);
  }
  Output output;
  if (watch_.confirmed()) output = learn(false);
  rested_ = rested_ || bias_measured_;
  moved_ = true;
  resting_ = false;
  output.held = std::exchange(open_, {});
  output.held->add(std::exchange(last_, {}));
  output.was_standing = std::exchange(standing_, false);
  return output;
}

RobotRest::Output RobotRest::learn(bool began) noexcept {
  const bool known = std::exchange(bias_measured_, bias_measured_ || watch_.means().gyro);
  return {.began = began, .means = watch_.means(), .bias_changed = known && watch_.bias_changed()};
}

}  // namespace robot_control

#include "robots/wheeled/start_check.h"

#include <cmath>
#include <numbers>

#include "control/wheeled/control_problems.h"
#include "control/wheeled/smooth_speed.h"
#include "signals/formatted_text.h"
#include "signals/roles.h"

namespace robot_control {

void require_drivable(const Parameters& parameters, const DriveTrain& robot) {
  std::string message;
  for (const std::string& problem : control_problems(parameters.controller, robot, parameters.loop.period())) {
    message += (message.empty() ? "" : "\n") + problem;
  }
  if (!message.empty()) throw ParameterError(message);
}

double encoder_count(const EstimatorParameters& estimator) noexcept {
  return std::sqrt(12.0) * estimator.encoder_noise;
}

std::string note_on_slow_driving(const Parameters& parameters, const DriveTrain& robot) {
  const double count = encoder_count(parameters.estimator);
  const double speed = smooth_speed(parameters.controller, robot, count, parameters.loop.period());
  if (speed <= kSlowRim) return {};
  return formatted(
      "encoders of %.0f counts a turn (%s.encoder_noise): below about %.2g m/s of their rims, wheels "
      "may move in jerks if friction, ground or load differ from the description",
      2 * std::numbers::pi / count, std::string(program_of(Role::kEstimator)).c_str(), speed);
}

}  // namespace robot_control

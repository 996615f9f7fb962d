#include "runtime/start_check.h"

#include "control/control_problems.h"

namespace robot_control {

void require_drivable(const Parameters& parameters, const RobotModel& robot) {
  std::string message;
  for (const std::string& problem : control_problems(parameters.controller, robot, parameters.loop.period())) {
    message += (message.empty() ? "" : "\n") + problem;
  }
  if (!message.empty()) throw ParameterError(message);
}

}  // namespace robot_control

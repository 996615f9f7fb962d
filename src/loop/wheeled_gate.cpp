#include "loop/wheeled_gate.h"

#include <cmath>

#include "gate/wheeled/wheel_stop.h"

namespace robot_control {

GateParameters gate_parameters(const Parameters& parameters, const DriveTrain& robot) {
  const double ramp = std::ceil(parameters.safety.ramp_time / parameters.loop.period() - 1e-9);
  GateParameters gate{.stops = std::vector<StopAction>(robot.joints.size()),
                      .longest_ramp = static_cast<std::uint64_t>(ramp) + parameters.safety.loss_cycles};
  for (std::size_t i = 0; i < robot.wheels.size(); ++i) {
    gate.stops[robot.wheels[i].joint] = wheel_stop(robot, i, parameters.loop.fail_action);
  }
  return gate;
}

}  // namespace robot_control

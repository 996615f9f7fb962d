#pragma once
/// A Setup holds everything that a node reads before it takes its locks: parameters, robot, name of the bus.
///
/// It is read after ros::init and before the first NodeHandle. A NodeHandle registers this node's name, and ROS would
/// then shut down a running node of that name.

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "configuration/parameters.h"
#include "machine/machine_model.h"
#include "signals/roles.h"

namespace robot_control {

/// The text lists every reason not to start, one per line.
class SetupError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct Setup {
  Parameters parameters;
  std::shared_ptr<const MachineModel> machine;  ///< a DriveTrain or a LegModel (robots/robot_kind.h)
  std::string bus;
  std::vector<std::string> overrides;  ///< "/robot/rate = 500 overrides robot.rate of config/robot_params.yaml"
  std::vector<std::string> unexpected_overrides;  ///< those of `overrides` that no launch file sets
  std::string unread_description;                 ///< warning that another robot_description is on the server, or empty
};

/// Returns the problem if `clock: wall` meets /use_sim_time = true, or `clock: lockstep` meets false; "" if they agree.
/// Otherwise all stamps and times would be wrong.
std::string clock_problem(ClockMode clock, bool use_sim_time);

/// Returns the parameters that the node of another role would read from its file and its overrides if it started now.
/// Throws ParameterError.
Parameters parameters_of(Role role);

/// Refuses the controller of another kind of robot. A program that is not `in_loop` needs no robot: `machine` is null.
///
/// `node` names the program and its block of the YAML file (signals/roles.h). The robot is selected as in
/// description.h. Throws SetupError with all problems at once.
Setup read_setup(const std::string& node, bool in_loop = true);

}  // namespace robot_control

#pragma once
/// Everything a node reads before it takes its locks: parameters, robot, name of the bus.
///
/// Read after ros::init and before the first NodeHandle, because a NodeHandle registers this node's name and ROS
/// would then shut a running node of that name down.

#include <stdexcept>
#include <string>
#include <vector>

#include "parameters/parameters.h"
#include "robot/robot_model.h"

namespace robot_control {

/// Every reason not to start, one problem a line.
class SetupError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct Setup {
  Parameters parameters;
  RobotModel robot;
  std::string bus;
  std::vector<std::string> overrides;  ///< "/robot/rate = 500 overrides robot.rate of config/robot_params.yaml"
  std::vector<std::string> unexpected_overrides;  ///< of these, without those that the launch file itself causes
  std::string unread_description;                 ///< that another robot_description stands on the server, or empty
};

/// `clock: wall` with /use_sim_time = true would stamp and time everything wrongly, `clock: lockstep` without it
/// too; empty when they agree.
std::string clock_problem(ClockMode clock, bool use_sim_time);

/// What the node `node` beside this one reads where it starts now: its file, its overrides. Throws ParameterError.
Parameters parameters_of(const std::string& node);

/// `node`: program and block of the YAML file ("state_estimator"). The robot is that of description.h. Throws
/// SetupError with all problems at once.
Setup read_setup(const std::string& node);

}  // namespace robot_control

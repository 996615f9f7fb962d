#pragma once
/// What the controller tells about the commands it received: every changed value with the wheel speeds it leads to,
/// those after the speed limits where it lies above them; one warning per timeout that stopped a motion, one per series
/// of refused (NaN, infinite) messages. What is refused for its stamp or its sender is told by command_input.h. Pure.

#include <cstdint>
#include <string>
#include <vector>

#include "control/drive_controller.h"
#include "control/kinematics.h"
#include "control/speed_limiter.h"
#include "robot/robot_model.h"
#include "signals/command_frame.h"

namespace robot_control {

struct ReportLine {
  bool warning = false;
  std::string text;
};

class CommandReport {
 public:
  CommandReport(const RobotModel& robot, const DriveControllerParameters& parameters);

  /// Other limits and another timeout, from now on.
  void limit(const DriveControllerParameters& parameters);

  /// Any number of cycles may lie between two frames.
  std::vector<ReportLine> look(const CommandFrame& command);

 private:
  std::string speeds(const PlanarTwist& wish) const;

  DriveKinematics kinematics_;
  SpeedLimits limits_;
  double timeout_;  ///< s
  std::uint64_t run_ = 0;
  std::uint64_t received_ = 0;
  std::uint64_t refused_ = 0;  ///< NaN, infinite
  std::uint64_t timeouts_ = 0;
  bool told_ = false;  ///< `linear_` and `angular_` were told
  bool refusing_ = false;
  double linear_ = 0;   ///< m/s, last accepted
  double angular_ = 0;  ///< rad/s, last accepted
};

}  // namespace robot_control

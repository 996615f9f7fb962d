#pragma once
/// Limits and gains of the controller, changed while it drives: the services ~set_parameters and
/// ~set_parameter_map, without ROS.
///
/// A request is accepted as a whole or refused. It is refused for every reason that would refuse a start: the schema's
/// rules and contradictions, control_problems. The monitor's limits stay those of its start: it stops a robot whose
/// wheels exceed its wheel_speed limit Ω. Speed limits that command a wheel to turn faster than those of the start must
/// leave the monitor its smallest margin (derived_limits.h),
///
///   least_wheel_speed_limit(commanded_wheel_speed) ≤ Ω
///
/// Values that the request leaves out stay derived, from the new values. The next request is laid over accepted values.

#include <mutex>
#include <string>
#include <vector>

#include "bus/latest_value.h"
#include "configuration/live_parameters.h"
#include "configuration/parameters.h"
#include "machine/wheeled/drive_train.h"
#include "robots/robot.h"
#include "safety/safety_parameters.h"

namespace robot_control {

class Retuning final : public Retuner {
 public:
  /// `parameters` with which the controller starts; the cycle takes `inbox` over. The monitor is assumed to run with
  /// the same parameters.
  Retuning(const Parameters& parameters, const DriveTrain& robot, LatestValue<LiveTuning>& inbox);

  std::unique_ptr<Retuner> clone(LatestValue<LiveTuning>& inbox) const override;

  /// The monitor's limits are derived from these parameters.
  void expect_monitor(const Parameters& monitor) override;
  Retuned set(const std::string& request) override;
  Parameters in_force() const override;
  /// Derived values are those of the first wheel.
  std::vector<LiveParameter> live() const override;

 private:
  Retuning(const Retuning& other, LatestValue<LiveTuning>& inbox);
  std::string monitor_problem(const DriveControllerParameters& wanted) const;

  mutable std::mutex mutex_;
  Parameters parameters_;  ///< in force
  DriveTrain robot_;
  double commanded_at_start_;  ///< rad/s of a wheel
  Condition wheel_speed_;      ///< the monitor's
  LatestValue<LiveTuning>& inbox_;
  std::uint64_t count_ = 0;
};

}  // namespace robot_control

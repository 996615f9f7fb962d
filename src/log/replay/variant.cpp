#include "log/replay/variant.h"

#include "control/derived_tuning.h"
#include "loop/safety_limits.h"

namespace robot_control {

Variant::Variant(const Parameters& parameters, const DriveTrain& robot)
    : estimator_(parameters.estimator, robot, parameters.loop.period()),
      tuning_(drive_tuning(parameters.controller, robot, parameters.loop.period())),
      monitor_(safety_limits(parameters, robot), robot, parameters.loop.period()) {}

const StateFrame* Variant::step(const EstimatorCalls& calls, const SensorFrame& sensors) noexcept {
  if (calls.law.new_run != 0) {
    const bool restarted = estimates_ && calls.law.process != process_ && state_.head.run == sensors.head.run;
    if (restarted) {
      estimator_.resume(state_);  // the node, too, continues from the last state of its predecessor
    } else {
      estimator_.enter_run();
    }
    process_ = calls.law.process;
    estimates_ = true;
  }
  if (!estimates_) return nullptr;
  if (calls.pose_set != 0) estimator_.set_pose(calls.pose);
  estimator_.step(sensors, state_);
  state_.head.run = sensors.head.run;
  state_.head.cycle = sensors.head.cycle;
  return &state_;
}

const CommandFrame* Variant::step(const ControllerCalls& calls, const ControlInput& input,
                                  const DriveController& law) noexcept {
  if (!controller_) {
    controller_ = law;
    controller_->tune(tuning_);
  } else if (calls.law.new_run != 0) {
    controller_->enter_run(calls.inbox, calls.with_zero != 0);
  }
  controller_->step(input, command_);
  return &command_;
}

const Permit* Variant::step(const MonitorCalls& calls, const MonitorInput& input) noexcept {
  monitors_ = monitors_ || calls.law.new_run != 0;
  if (!monitors_) return nullptr;
  monitor_.step(input, permit_);
  return &permit_;
}

}  // namespace robot_control

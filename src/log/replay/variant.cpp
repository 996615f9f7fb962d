#include "log/replay/variant.h"

namespace robot_control {

Variant::Variant(const Robot& robot)
    : estimator_(robot.make_estimator()),
      controller_(robot.make_controller()),
      monitor_(robot.make_monitor()),
      tuning_(controller_->tuning()) {}

const StateFrame* Variant::step(const EstimatorCalls& calls, const SensorFrame& sensors) noexcept {
  if (calls.law.new_run != 0) {
    const bool restarted = estimates_ && calls.law.process != process_ && state_.head.run == sensors.head.run;
    if (restarted) {
      estimator_->resume(state_);  // the node, too, continues from the last state of its predecessor
    } else {
      estimator_->enter_run();
    }
    process_ = calls.law.process;
    estimates_ = true;
  }
  if (!estimates_) return nullptr;
  if (calls.pose_set != 0) estimator_->set_pose(calls.pose);
  estimator_->step(sensors, state_);
  state_.head.run = sensors.head.run;
  state_.head.cycle = sensors.head.cycle;
  return &state_;
}

const CommandFrame* Variant::step(const ControllerCalls& calls, const ControlInput& input,
                                  const ControllerLaw& law) noexcept {
  if (!controls_) {
    law.save(snapshot_);
    controller_->restore(snapshot_);
    controller_->tune(tuning_);
    controls_ = true;
  } else if (calls.law.new_run != 0) {
    controller_->enter_run(calls.inbox, calls.with_zero != 0);
  }
  controller_->step(input, command_);
  return &command_;
}

const Permit* Variant::step(const MonitorCalls& calls, const MonitorInput& input) noexcept {
  monitors_ = monitors_ || calls.law.new_run != 0;
  if (!monitors_) return nullptr;
  monitor_->step(input, permit_);
  return &permit_;
}

}  // namespace robot_control

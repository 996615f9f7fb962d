#include "ros/wheeled/wheel_outputs.h"

#include "machine/wheeled/drive_train.h"
#include "ros/messages/motion_messages.h"

namespace robot_control {

WheelOutputs::WheelOutputs(const Setup& setup)
    : odom_frame_(setup.parameters.report.odom_frame),
      base_frame_(setup.parameters.report.base_frame),
      keeper_(setup.parameters, drive_train_of(*setup.machine)) {}

void WheelOutputs::connect(ros::NodeHandle& handle) {
  wheel_odom_ = handle.advertise<nav_msgs::Odometry>("wheel_odom", 10);
}

void WheelOutputs::publish(const StateFrame& state, ros::Time stamp) {
  wheel_odom_.publish(wheel_odometry(state, odom_frame_, base_frame_, stamp));
}

void WheelOutputs::keep(const StateFrame& state, std::int64_t now_ns) {
  keeper_.write_if_due(state, now_ns);
}

void WheelOutputs::finish(const StateFrame& state) {
  keeper_.finish(state);
}

std::unique_ptr<Node> make_wheel_estimator(const Setup& setup) {
  Setup calibrated = setup;
  calibrated.parameters = with_calibration(setup.parameters, drive_train_of(*setup.machine));
  return make_estimator(calibrated, std::make_unique<WheelOutputs>(setup));
}

}  // namespace robot_control

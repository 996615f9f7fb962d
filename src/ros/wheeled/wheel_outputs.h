#pragma once
/// WheelOutputs publishes the odometry of the wheels alone (wheel_odom), and writes the calibration that the estimator
/// of a robot on wheels learns to its file.

#include <ros/ros.h>

#include <string>

#include "ros/nodes/estimator_node.h"
#include "ros/wheeled/calibration_keeper.h"

namespace robot_control {

class WheelOutputs final : public EstimatorOutputs {
 public:
  /// The machine of `setup` is a drive train.
  explicit WheelOutputs(const Setup& setup);

  void connect(ros::NodeHandle& handle) override;
  void publish(const StateFrame& state, ros::Time stamp) override;
  void keep(const StateFrame& state, std::int64_t now_ns) override;
  void finish(const StateFrame& state) override;

 private:
  std::string odom_frame_, base_frame_;
  CalibrationKeeper keeper_;
  ros::Publisher wheel_odom_;
};

/// Returns the estimator of a robot on wheels, which begins with the calibration of its file. Throws as
/// with_calibration does.
std::unique_ptr<Node> make_wheel_estimator(const Setup& setup);

}  // namespace robot_control

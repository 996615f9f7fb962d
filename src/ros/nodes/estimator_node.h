#pragma once
/// The estimator publishes joint_states, odom, imu/data and tf, and what its kind of robot has beside them. It has the
/// services reset_odometry and set_odometry.

#include <ros/time.h>

#include <cstdint>
#include <memory>

#include "ros/nodes/node.h"
#include "signals/state_frame.h"

namespace robot_control {

/// The outputs of one kind of robot beside the common ones. The ordinary thread calls them.
class EstimatorOutputs {
 public:
  virtual ~EstimatorOutputs() = default;

  virtual void connect(ros::NodeHandle& handle) = 0;

  /// Is called together with odom.
  virtual void publish(const StateFrame& state, ros::Time stamp) = 0;

  /// Writes what has to be kept, if it is due.
  virtual void keep(const StateFrame& state, std::int64_t now_ns) = 0;

  /// Writes what has to be kept of the last state, and waits for it.
  virtual void finish(const StateFrame& state) = 0;
};

/// `outputs` is null for a kind that has none.
std::unique_ptr<Node> make_estimator(const Setup& setup, std::unique_ptr<EstimatorOutputs> outputs);

}  // namespace robot_control

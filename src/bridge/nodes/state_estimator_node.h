#pragma once
/// state_estimator: joint_states, odom, wheel_odom, imu/data, tf; services reset_odometry, set_odometry; the
/// calibration file.

#include <memory>

#include "bridge/nodes/node.h"
#include "hal/frame_output.h"
#include "signals/state_frame.h"

namespace robot_control {

/// `decorator`: of its output; null in the programs of a robot.
std::unique_ptr<Node> make_state_estimator(const Setup& setup, OutputDecoratorPtr<StateFrame> decorator = nullptr);

}  // namespace robot_control

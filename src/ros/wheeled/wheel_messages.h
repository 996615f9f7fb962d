#pragma once
/// These functions convert the command of a robot on wheels to messages. They are pure.

#include <robot_control/DriveState.h>
#include <ros/time.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/Float64MultiArray.h>

#include "machine/wheeled/drive_train.h"
#include "signals/command_frame.h"

namespace robot_control {

/// Returns the velocity targets of the wheels [rad/s] in the order of DriveTrain::wheels; dim[0].label is "wheel".
std_msgs::Float64MultiArray joint_commands(const CommandFrame& command, const DriveTrain& robot);

/// Returns the velocity targets of the wheels with the names of their joints.
sensor_msgs::JointState joint_targets(const CommandFrame& command, const DriveTrain& robot, ros::Time stamp);

/// `plan` is the command two cycles before `command`; an ideal wheel now has its targets (wheel_loop.h). `reasons` are
/// CommandReason bits. While the brake acts, the reported target is standstill.
DriveState drive_state(const CommandFrame& command, const CommandFrame& plan, std::uint64_t reasons,
                       const DriveTrain& robot, ros::Time stamp);

}  // namespace robot_control

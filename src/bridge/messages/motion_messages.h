#pragma once
/// Frames → standard messages. Pure: the stamp is an argument, nothing is published here.

#include <ros/time.h>

#include <string>

#include "bridge/messages/messages.h"
#include "estimation/estimator_parameters.h"
#include "parameters/parameters.h"
#include "robot/robot_model.h"
#include "signals/command_frame.h"
#include "signals/sensor_frame.h"
#include "signals/state_frame.h"
#include "signals/truth_frame.h"
#include "signals/velocity_command.h"

namespace robot_control {

Twist twist_of(const msg::Twist& message);

/// All joints in the order of the frames: wheels first, left before right; casters and other joints follow. The wheels'
/// velocities are those that the estimator tracks (StateFrame::wheel_velocity): what the encoder reports jumps by a
/// count per period. Without a `state` of this run (null), and of other joints, velocities are as reported.
msg::JointState joint_states(const SensorFrame& sensors, const StateFrame* state, const RobotModel& robot,
                             ros::Time stamp);

/// Pose in `odom_frame`, twist in `base_frame`; both covariances complete (REP 105, nav_msgs/Odometry).
msg::Odometry odometry(const StateFrame& state, const std::string& odom_frame, const std::string& base_frame,
                       ros::Time stamp);

/// Replaces covariances by the diagonals that the user gave, for programs that need constant ones.
void state_covariances(const ReportParameters& given, msg::Odometry& message);

/// The log line about it at start; empty: nothing was given.
std::string covariance_note(const ReportParameters& given);

/// odom_frame → base_frame.
msg::TransformStamped transform(const msg::Odometry& odometry);

/// Odometry from the wheels alone. Its uncertainty is not estimated: both covariances are all zero, "unknown" as in
/// sensor_msgs.
msg::Odometry wheel_odometry(const StateFrame& state, const std::string& odom_frame, const std::string& base_frame,
                             ros::Time stamp);

/// The true motion, in the same form; covariances are zero, because truth has none.
msg::Odometry ground_truth(const TruthFrame& truth, const std::string& odom_frame, const std::string& base_frame,
                           ros::Time stamp);

/// REP 145: in the IMU link's axes; a covariance that begins with −1 says "not measured", all zero "unknown".
msg::Imu imu(const SensorFrame& sensors, const RobotModel& robot, ros::Time stamp);

/// The same with all that is known (REP 145 "imu/data"): orientation of the IMU's axes in odom, z against gravity,
///   q = attitude ⊗ imu_in_base,   covariance StateFrame::attitude_covariance, about odom axes;
/// rates and accelerations as measured, bias and all. Their covariance is that of white noise sampled at the loop's
/// rate, density² / period. `sensors` and `state` are of one cycle.
msg::Imu imu_data(const SensorFrame& sensors, const StateFrame& state, const RobotModel& robot,
                  const EstimatorParameters& parameters, double period, ros::Time stamp);

/// True if all of imu_data is available: gyro and accelerometer were measured in this cycle and are trusted, and the
/// state is valid.
bool has_imu_data(const SensorFrame& sensors, const StateFrame& state);

/// Voltage and current as measured, the current negative when discharging; what no driver reports is NaN or unknown.
msg::BatteryState battery_state(const SensorFrame& sensors, ros::Time stamp);

/// Velocity targets of the wheels [rad/s] in the order of RobotModel::wheels; dim[0].label is "wheel".
msg::Float64MultiArray joint_commands(const CommandFrame& command, const RobotModel& robot);

/// The same with names.
msg::JointState joint_targets(const CommandFrame& command, const RobotModel& robot, ros::Time stamp);

/// After limits.
msg::TwistStamped velocity_out(const CommandFrame& command, const std::string& base_frame, ros::Time stamp);

/// `plan`: the command two cycles before `command`, whose targets are what an ideal wheel does now (wheel_loop.h).
/// `reasons`: CommandReason bits. While the brake acts, the reported target is standstill.
msg::DriveState drive_state(const CommandFrame& command, const CommandFrame& plan, std::uint64_t reasons,
                            const RobotModel& robot, ros::Time stamp);

}  // namespace robot_control

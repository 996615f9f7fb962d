#pragma once
/// These functions convert frames to standard messages. They are pure: the stamp is an argument, nothing is published
/// here.

#include <geometry_msgs/TransformStamped.h>
#include <geometry_msgs/TwistStamped.h>
#include <nav_msgs/Odometry.h>
#include <ros/time.h>
#include <sensor_msgs/BatteryState.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/LaserScan.h>

#include <string>

#include "configuration/parameters.h"
#include "drivers/external_imu.h"
#include "drivers/laser_scan.h"
#include "estimation/wheeled/estimator_parameters.h"
#include "machine/machine_model.h"
#include "signals/command_frame.h"
#include "signals/sensor_frame.h"
#include "signals/state_frame.h"
#include "signals/truth_frame.h"
#include "signals/velocity_command.h"

namespace robot_control {

Twist twist_of(const geometry_msgs::Twist& message);

/// Returns all joints in the order of the frames: wheels first, left before right, then casters and other joints. The
/// velocities are those of the state (StateFrame::joint_velocity), because those of an encoder jump by a count per
/// period. If `state` is null because this run has no state yet, they are those of the sensors.
sensor_msgs::JointState joint_states(const SensorFrame& sensors, const StateFrame* state, const MachineModel& robot,
                                     ros::Time stamp);

/// Returns the pose in `odom_frame` and the twist in `base_frame`, both with complete covariances (REP 105,
/// nav_msgs/Odometry).
nav_msgs::Odometry odometry(const StateFrame& state, const std::string& odom_frame, const std::string& base_frame,
                            ros::Time stamp);

/// Replaces the covariances by the diagonals that the user gave, for programs that need constant covariances.
void state_covariances(const ReportParameters& given, nav_msgs::Odometry& message);

/// Returns the log line that reports given covariances at start; "" if none are given.
std::string covariance_note(const ReportParameters& given);

/// Returns the transform from odom_frame to base_frame.
geometry_msgs::TransformStamped transform(const nav_msgs::Odometry& odometry);

/// Returns the odometry of the wheels alone. Its uncertainty is not estimated, so both covariances are all zero, which
/// means "unknown" in sensor_msgs.
nav_msgs::Odometry wheel_odometry(const StateFrame& state, const std::string& odom_frame, const std::string& base_frame,
                                  ros::Time stamp);

/// Returns the true motion as odometry. The covariances are zero, because the truth is exact.
nav_msgs::Odometry ground_truth(const TruthFrame& truth, const std::string& odom_frame, const std::string& base_frame,
                                ros::Time stamp);

/// Returns one turn of the laser; all rays are of `stamp`. Without intensities.
sensor_msgs::LaserScan laser_scan(const LaserScan& scan, ros::Time stamp);

/// Returns the measured rates and accelerations in the axes of the IMU's link (REP 145). A covariance that begins with
/// −1 means "not measured", one that is all zero "unknown".
sensor_msgs::Imu imu(const SensorFrame& sensors, const MachineModel& robot, ros::Time stamp);

/// Returns the sample of a message that is received at `now_ns`; `age_ns` is that of the message. Parts whose
/// covariance begins with -1 are not measured.
ExternalImuSample imu_sample(const sensor_msgs::Imu& message, std::int64_t now_ns, std::int64_t age_ns);

/// Returns the frame in whose axes an IMU of this robot measures.
const std::string& imu_frame(const MachineModel& robot);

/// Returns `imu` with orientation and covariances (REP 145 "imu/data"). The orientation is that of the IMU's axes in
/// odom, whose z axis points against gravity,
///   q = attitude ⊗ imu_in_base,   covariance StateFrame::attitude_covariance, about odom axes;
/// Rates and accelerations are as measured, with their biases. Their covariance is that of white noise sampled at the
/// loop's rate, density² / period. `sensors` and `state` are of the same cycle.
sensor_msgs::Imu imu_data(const SensorFrame& sensors, const StateFrame& state, const MachineModel& robot,
                          const EstimatorParameters& parameters, double period, ros::Time stamp);

/// Returns whether imu_data is complete: gyro and accelerometer were measured in this cycle and are trusted, and the
/// state is valid.
bool has_imu_data(const SensorFrame& sensors, const StateFrame& state);

/// Returns voltage and current as measured; the current is negative when discharging. Quantities that no driver reports
/// are NaN or unknown.
sensor_msgs::BatteryState battery_state(const SensorFrame& sensors, ros::Time stamp);

/// Returns the limited twist.
geometry_msgs::TwistStamped velocity_out(const CommandFrame& command, const std::string& base_frame, ros::Time stamp);

/// Returns the requested twist, before all limits.
geometry_msgs::TwistStamped velocity_requested(const CommandFrame& command, const std::string& base_frame,
                                               ros::Time stamp);

}  // namespace robot_control

#pragma once
/// The estimator sends this frame to all nodes: pose and twist of the robot with covariances.

#include <array>
#include <cstdint>

#include "signals/frame_head.h"
#include "signals/geometry.h"

namespace robot_control {

/// The values are indices of StateFrame::confidence, nis and rejected. The last two are assumptions about the contact
/// with the ground. Wheels do not slide sideways. The robot neither sinks nor flies, which is always trusted.
enum SensorIndex : std::size_t {
  kLeftEncoder = 0,
  kRightEncoder = 1,
  kGyro = 2,
  kAccelerometer = 3,
  kLateralContact = 4,
  kVerticalContact = 5,
};
inline constexpr std::size_t kMaxConfidences = 8;

inline constexpr std::size_t kMaxWheelVelocities =
    8;  ///< equals kMaxWheels of robot/, which this folder does not include

/// Bits of StateFrame::flags.
enum StateFlag : std::uint64_t {
  kStateValid = 1u << 0,       ///< Pose and twist may be used.
  kStateSlip = 1u << 1,        ///< Wheels and inertial sensors disagree.
  kStateStandstill = 1u << 2,  ///< The robot stands: wheels and gyro are quiet.
  kStateRestarted =
      1u << 3,              ///< The state continues from the last frame of an earlier process, with a grown covariance.
  kStateSkipped = 1u << 4,  ///< At least one cycle of sensors was missed since the last frame.
  kStateNoGyro = 1u << 5,   ///< Yaw comes from the wheels alone.
  kStateBadSample = 1u << 6,        ///< A sample of this cycle was missing or not finite and was not used.
  kStateNoLeftEncoder = 1u << 7,    ///< No valid readings of the left encoders.
  kStateNoRightEncoder = 1u << 8,   ///< No valid readings of the right encoders.
  kStateNoAccelerometer = 1u << 9,  ///< Tilt and simultaneous slip of all wheels are not detected.
  kStateDegraded = 1u << 10,        ///< The pose is less certain than usual; StateFrame::degraded says why.
};

/// Bits of StateFrame::degraded: why the pose is less certain.
enum DegradedReason : std::uint64_t {
  kDegradedPosition = 1u << 0,  ///< Wheels slip (estimation/slip/wheel_slide.h).
  kDegradedHeading = 1u << 1,   ///< The gyro's bias was not measured at a rest yet, or the wheels contradict the gyro.
};

/// Bits of StateFrame::slip: the contact that is not trusted, and the contradicting measurement.
enum SlipReason : std::uint64_t {
  kSlipLeft = 1u << 0,      ///< The left wheels do not roll.
  kSlipRight = 1u << 1,     ///< The right wheels do not roll.
  kSlipSpinning = 1u << 2,  ///< A wheel turns faster than the ground passes.
  kSlipStalled = 1u << 3,   ///< A wheel turns slower than the ground passes, or stands.
  kSlipTurn = 1u << 4,      ///< The wheels' yaw rate contradicts the gyro.
  kSlipSideways = 1u << 5,  ///< The robot slides sideways.
};

/// The estimated calibration of wheels and gyro relative to RobotModel, with standard deviations.
struct WheelCalibration {
  double radius_ratio = 1;            ///< right over left radius, relative to the model's
  double wheel_base_factor = 1;       ///< effective wheel base over the model's
  double radius_ratio_deviation = 0;  ///< standard deviation; 0: not estimated
  double wheel_base_deviation = 0;    ///< standard deviation of wheel_base_factor; 0: not estimated
};

/// Odometry from the wheels and the model's dimensions, without gyro and calibration, for comparison.
struct WheelOdometry {
  double x = 0, y = 0;  ///< m, odom axes
  double yaw = 0;       ///< rad
  double linear = 0;    ///< m/s, base x
  double angular = 0;   ///< rad/s, base z
};

struct StateFrame {
  FrameHead head;
  std::uint64_t first_cycle = 0;  ///< cycle of this run in which this process computed its first state
  Pose pose_odom;                 ///< base_link in odom
  Twist twist_base;               ///< twist of base_link in its own axes
  Matrix6 pose_covariance{};      ///< m², m·rad, rad²; odom axes
  Matrix6 twist_covariance{};     ///< base axes
  Vector3 gyro_bias{};            ///< rad/s, IMU axes
  Vector3 accelerometer_bias{};   ///< m/s², IMU axes
  Quaternion attitude{0, 0, 0,
                      1};  ///< rotates base axes to odom axes, z against gravity; roll and pitch are always estimated
  std::array<double, 9> attitude_covariance{};  ///< rad², about odom axes
  Vector3 gyro_bias_deviation{};                ///< rad/s, standard deviation, IMU axes
  WheelCalibration calibration;
  WheelOdometry wheels;
  std::array<double, kMaxWheelVelocities>
      wheel_velocity{};  ///< rad/s, tracked, in the order of RobotModel::wheels, with the joint's sign
  std::array<double, kMaxConfidences> confidence{};  ///< 0 (not used) … 1 (agrees fully), by SensorIndex
  std::array<double, kMaxConfidences>
      nis{};  ///< normalised innovation squared per degree of freedom, smoothed; ideal 1
  std::array<std::uint64_t, kMaxConfidences>
      rejected{};              ///< comparisons of this run that were beyond their gate and not used
  std::uint64_t slip = 0;      ///< SlipReason bits
  std::uint64_t degraded = 0;  ///< DegradedReason bits
  double residual_level = 0;   ///< residual of wheels minus accelerometer over the sensors' noise; 0: none
  std::uint64_t flags = 0;
  double distance = 0;        ///< m travelled since the run began, always growing
  std::uint64_t skipped = 0;  ///< missed sensor cycles of this run
};

}  // namespace robot_control

#pragma once
/// state_estimator → everybody: where the robot is, how fast, and how sure that is.

#include <array>
#include <cstdint>

#include "signals/frame_head.h"
#include "signals/geometry.h"

namespace robot_control {

/// Index into StateFrame::confidence.
enum SensorIndex : std::size_t { kLeftEncoder = 0, kRightEncoder = 1, kGyro = 2, kAccelerometer = 3 };
inline constexpr std::size_t kMaxConfidences = 8;

/// Bits of StateFrame::flags.
enum StateFlag : std::uint64_t {
  kStateValid = 1u << 0,       ///< Pose and twist may be used.
  kStateSlip = 1u << 1,        ///< Wheels and inertial sensors disagree.
  kStateStandstill = 1u << 2,  ///< All sensors are quiet.
  kStateRestarted = 1u << 3,   ///< Continued from the last frame of an earlier process; covariance grown.
  kStateSkipped = 1u << 4,     ///< At least one cycle of sensors was never seen since the last frame.
  kStateNoGyro = 1u << 5,      ///< Yaw from the wheels alone.
  kStateBadSample = 1u << 6,   ///< A sample of this cycle was missing or not finite and was not used.
};

struct StateFrame {
  FrameHead head;
  Pose pose_odom;                                    ///< base_link in odom
  Twist twist_base;                                  ///< of base_link in its own axes
  Matrix6 pose_covariance{};                         ///< m², m·rad, rad²; odom axes
  Matrix6 twist_covariance{};                        ///< base axes
  Vector3 gyro_bias{};                               ///< rad/s, IMU axes
  Vector3 accelerometer_bias{};                      ///< m/s², IMU axes
  std::array<double, kMaxConfidences> confidence{};  ///< 0 (not used) … 1 (agrees fully), by SensorIndex
  std::uint64_t flags = 0;
  double distance = 0;        ///< m travelled since the run began, always growing
  std::uint64_t skipped = 0;  ///< sensor cycles of this run never seen
};

}  // namespace robot_control

#pragma once
/// The estimator sends this frame to all nodes: the state of base, joints and contacts, and of the kind of machine.

#include <array>
#include <cstdint>

#include "signals/contact.h"
#include "signals/frame_head.h"
#include "signals/geometry.h"
#include "signals/joint.h"
#include "signals/wheeled/wheeled_state.h"

namespace robot_control {

/// Bits of BaseState::flags.
enum StateFlag : std::uint64_t {
  kStateValid = 1u << 0,       ///< Pose and twist may be used.
  kStateSlip = 1u << 1,        ///< Wheels and inertial sensors disagree.
  kStateStandstill = 1u << 2,  ///< The robot stands: wheels and gyro are quiet.
  kStateRestarted =
      1u << 3,              ///< The state continues from the last frame of an earlier process, with a grown covariance.
  kStateSkipped = 1u << 4,  ///< At least one cycle of sensors was missed since the last frame.
  kStateNoGyro = 1u << 5,   ///< Yaw comes from the wheels alone.
  kStateBadSample = 1u << 6,          ///< A sample of this cycle was missing or not finite and was not used.
  kStateNoLeftEncoder = 1u << 7,      ///< No valid readings of the left encoders.
  kStateNoRightEncoder = 1u << 8,     ///< No valid readings of the right encoders.
  kStateNoAccelerometer = 1u << 9,    ///< Tilt and simultaneous slip of all wheels are not detected.
  kStateDegraded = 1u << 10,          ///< The pose is less certain than usual; BaseState::degraded says why.
  kStateEncoderRestarted = 1u << 11,  ///< An encoder began again in this cycle: its travel is lost.
};

/// Bits of BaseState::degraded: why the pose is less certain.
enum DegradedReason : std::uint64_t {
  kDegradedPosition = 1u << 0,  ///< Wheels slip (estimation/wheeled/slip/slip_watch.h).
  kDegradedHeading = 1u << 1,   ///< The gyro's bias was not measured at a rest yet, or the wheels contradict the gyro.
};

/// The motion of the base of any machine.
struct BaseState {
  Pose pose_odom;                ///< base_link in odom
  Twist twist_base;              ///< twist of base_link in its own axes
  Matrix6 pose_covariance{};     ///< m², m·rad, rad²; odom axes
  Matrix6 twist_covariance{};    ///< base axes
  Vector3 gyro_bias{};           ///< rad/s, IMU axes
  Vector3 accelerometer_bias{};  ///< m/s², IMU axes
  Quaternion attitude{0, 0, 0,
                      1};  ///< rotates base axes to odom axes, z against gravity; roll and pitch are always estimated
  std::array<double, 9> attitude_covariance{};  ///< rad², about odom axes
  Vector3 gyro_bias_deviation{};                ///< rad/s, standard deviation, IMU axes
  std::uint64_t degraded = 0;                   ///< DegradedReason bits
  std::uint64_t flags = 0;                      ///< StateFlag bits
  double distance = 0;                          ///< m travelled since the run began, always growing
};

struct StateFrame {
  FrameHead head;
  std::uint64_t first_cycle = 0;  ///< cycle of this run in which this process computed its first state
  std::uint64_t skipped = 0;      ///< missed sensor cycles of this run
  BaseState base;
  /// rad/s or m/s, in the order of MachineModel::joints; of wheels tracked, of others as measured
  std::array<double, kMaxJoints> joint_velocity{};
  std::uint64_t contact_count = 0;                    ///< estimated contacts
  std::array<ContactState, kMaxContacts> contacts{};  ///< in the order of SensorFrame::contacts
  WheeledState wheeled;                               ///< only wheeled machines fill it
};

}  // namespace robot_control

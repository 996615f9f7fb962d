#pragma once
/// The driver sends this frame to all nodes: the sensors of cycle k, the driver's state, and the gate's verdict of tick
/// k-1.

#include <array>
#include <cstdint>

#include "signals/contact.h"
#include "signals/frame_head.h"
#include "signals/gate_report.h"
#include "signals/geometry.h"
#include "signals/injected_fault.h"
#include "signals/joint.h"

namespace robot_control {

/// The sample is in the axes of the IMU's link. The angular velocity belongs to t_k. The linear acceleration is the
/// specific force (+g upwards at rest), averaged over [t_k-1, t_k). In world axes, plus gravity, times the period, it
/// is the change of the IMU's velocity.
struct ImuSample {
  Vector3 angular_velocity{};     ///< rad/s
  Vector3 linear_acceleration{};  ///< m/s²
  Quaternion orientation{};       ///< all zero if the device has none
};

inline constexpr std::size_t kMaxLinks = 4;

enum class LinkState : std::uint64_t {
  kStarting = 0,
  kUp = 1,
  kDegraded = 2,  ///< It still carries messages, but reports errors, as a CAN controller that is error-passive.
  kDown = 3,      ///< It carries nothing: unplugged, or a CAN controller that is bus-off.
};

/// Counts what a link between the driver and its drives and sensors carried in this run: a bus, or a serial line.
struct LinkStatus {
  LinkState state = LinkState::kStarting;
  std::uint64_t sent = 0;    ///< messages
  std::uint64_t lost = 0;    ///< expected answers that never came
  std::uint64_t late = 0;    ///< answers that came after the cycle in which they were due
  std::uint64_t errors = 0;  ///< errors that the link itself reported
};

enum class DriverState : std::uint64_t {
  kStarting = 0,
  kRunning = 1,
  kPaused = 2,
  kFault = 3,
  kEnded = 4,  ///< The driver ends and stops its machine; this process sends no further frame.
};

/// Bits of SensorFrame::faults.
enum DriverFault : std::uint64_t {
  kFaultSimulationDiverged = 1u << 0,  ///< The physics engine warned: NaN, huge values, bad inertia.
  kFaultSimulationError = 1u << 1,     ///< The physics engine raised an error.
  kFaultNotFinite = 1u << 2,           ///< The driver read NaN or infinity.
  kFaultLink = 1u << 3,                ///< The device does not answer.
  kFaultDrive = 1u << 4,               ///< A motor drive reports a fault.
};

/// Bits of SensorFrame::valid; joints and contacts have their own.
enum SensorValidity : std::uint64_t {
  kValidGyro = 1u << 0,
  kValidAccelerometer = 1u << 1,
  kValidOrientation = 1u << 2,
  kValidBattery = 1u << 3,
};

/// Bits of SensorFrame::digital_inputs.
enum DigitalInput : std::uint64_t { kInputEmergencyStop = 1u << 0 };

struct SensorFrame {
  FrameHead head;
  std::uint64_t driver_instance = 0;  ///< Random number of the driver process; a restart changes it, a reset does not.
  DriverState driver_state = DriverState::kStarting;
  std::uint64_t faults = 0;
  std::uint64_t valid = 0;
  std::uint64_t joint_count = 0;
  std::array<JointSample, kMaxJoints> joints{};  ///< in the order of MachineModel::joints
  ImuSample imu;
  std::uint64_t contact_count = 0;  ///< contacts with a sensor

  /// Contacts of the model, as many as fit: the wheels in the order of DriveTrain::wheels, then the casters.
  /// On legs they are the feet in the order of LegModel::legs.
  std::array<ContactSample, kMaxContacts> contacts{};
  std::uint64_t link_count = 0;
  std::array<LinkStatus, kMaxLinks> links{};  ///< the links from the driver to its drives and sensors
  std::uint64_t digital_inputs = 0;
  double battery_voltage = 0;    ///< V, at the terminals
  double battery_current = 0;    ///< A, positive when discharging
  GateReport gate;               ///< gate's report of the last tick: k-1, or before cycles that were skipped
  std::uint64_t overruns = 0;    ///< Ticks of this run that ended after the next deadline.
  InjectedFaults injected{};     ///< simulators only, for the log and ClosedLoop
  std::uint64_t slipped_ns = 0;  ///< Time by which a simulated plant fell behind the wall clock in this run.
  std::uint64_t resumes = 0;     ///< Number of resumptions of a simulated plant after a pause, on the wall clock.
  std::uint64_t held_ns =
      0;  ///< Total time in which a simulated plant was paused or being reset; not cleared by a reset.
};

/// Sets JointSample::valid of every joint.
inline void set_joints_valid(SensorFrame& sensors, std::uint32_t bits) noexcept {
  for (JointSample& sample : sensors.joints) sample.valid = bits;
}

/// Returns whether the first `count` joints of the frame have all numbers that `bits` names.
inline bool joints_have(const SensorFrame& sensors, std::size_t count, std::uint32_t bits) noexcept {
  if (sensors.joint_count < count || count > kMaxJoints) return false;
  for (std::size_t i = 0; i < count; ++i) {
    if (!has(sensors.joints[i], bits)) return false;
  }
  return true;
}

/// Returns the first joint whose drive reports a fault; kMaxJoints: none.
inline std::size_t first_faulty_joint(const SensorFrame& sensors) noexcept {
  for (std::size_t i = 0; i < kMaxJoints && i < sensors.joint_count; ++i) {
    if (sensors.joints[i].fault != 0) return i;
  }
  return kMaxJoints;
}

}  // namespace robot_control

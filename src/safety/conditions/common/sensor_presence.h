#pragma once
/// These conditions find sensors that do not report.
///
///   encoders lost  a driven joint gave no new sample with kValidMotion, which the controller needs, for the
///                  persistence. The time is the age of a valid sample, and grows by the elapsed time while there is
///                  none. The joint with the longest time is named.
///   IMU lost       gyro or accelerometer is not valid, but was valid earlier in this run: a robot without an IMU may
///                  drive
///
/// Value and limit of both: s without a valid sample, and the persistence.

#include <array>
#include <cstddef>
#include <cstdint>

#include "safety/latch/active_causes.h"
#include "signals/joint.h"
#include "signals/sensor_frame.h"

namespace robot_control {

class SensorPresence {
 public:
  /// The first `joints` of the machine report. `period` s.
  SensorPresence(const SafetyParameters& parameters, std::size_t joints, double period) noexcept;

  void enter_run() noexcept;
  void step(const SensorFrame& sensors, std::uint64_t elapsed, ActiveCauses& out) noexcept;

 private:
  /// Silent for `cycles`, which are known, so that the condition acts in the cycle that reaches its persistence.
  void report(ConditionWatch& watch, std::uint64_t cycles, std::uint64_t joint, ActiveCauses& out) const noexcept;
  void step_encoders(const SensorFrame& sensors, std::uint64_t elapsed, ActiveCauses& out) noexcept;

  std::size_t joints_;
  std::uint32_t needed_;  ///< JointValidity bits
  double period_;
  std::uint64_t period_ns_;
  ConditionWatch encoders_;
  ConditionWatch imu_;
  std::array<std::uint64_t, kMaxJoints> joint_silent_{};  ///< cycles since the sample of each joint
  std::uint64_t imu_silent_ = 0;                          ///< cycles
  std::uint64_t imu_seen_ = 0;                            ///< kValidGyro, kValidAccelerometer
};

}  // namespace robot_control

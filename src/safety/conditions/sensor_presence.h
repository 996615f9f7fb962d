#pragma once
/// Do the sensors report?
///
///   encoders lost  the joint samples are not valid, or fewer than the robot has wheels
///   IMU lost       gyro or accelerometer is not valid, but was valid earlier in this run: a robot without an IMU may
///                  drive
///
/// Value and limit of both: s without a valid sample, and the persistence.

#include <cstddef>
#include <cstdint>

#include "safety/latch/active_causes.h"
#include "signals/sensor_frame.h"

namespace robot_control {

class SensorPresence {
 public:
  /// `period` s.
  SensorPresence(const SafetyParameters& parameters, std::size_t wheels, double period) noexcept;

  void enter_run() noexcept;
  void step(const SensorFrame& sensors, std::uint64_t elapsed, ActiveCauses& out) noexcept;

 private:
  class Silence {
   public:
    Silence(StopCause cause, const Condition& condition, double period) noexcept;
    void reset() noexcept;
    void step(bool silent, std::uint64_t elapsed, ActiveCauses& out) noexcept;

   private:
    ConditionWatch watch_;
    double period_;
    double persistence_;
    std::uint64_t cycles_ = 0;
  };

  std::size_t wheels_;
  Silence encoders_;
  Silence imu_;
  std::uint64_t imu_seen_ = 0;  ///< kValidGyro, kValidAccelerometer
};

}  // namespace robot_control

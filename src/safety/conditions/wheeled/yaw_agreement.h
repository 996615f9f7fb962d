#pragma once
/// This condition finds gyro and wheels that measure different yaw rates.
///
///   |ω_gyro·z − ω| > limit + kScrub·|ω| + δ,   ω = (v_right − v_left)/b
///
/// z the base's z axis in the IMU's axes (MachineModel::imu_in_base), v the mean rim speed of a side, b the effective
/// wheel base, δ = 2·(quantum/T)·radius/b the encoders' tolerance (wheel_motion.h), summed over the wheels.
/// kScrub applies with several wheels a side: in a turn they scrub by up to half of ω, depending on the ground. With
/// one wheel a side it is 0. `excess` is the left side less the right one, at least 0, and 0 where either is unknown.

#include <array>
#include <cstdint>

#include "machine/wheeled/drive_train.h"
#include "safety/latch/active_causes.h"
#include "safety/measurements/wheel_motion.h"
#include "signals/sensor_frame.h"

namespace robot_control {

class YawAgreement {
 public:
  static constexpr double kScrub = 0.5;

  /// `period` s.
  YawAgreement(const Condition& condition, const DriveTrain& robot, double period) noexcept;

  void enter_run() noexcept {
    watch_.reset();
    excess_ = 0;
  }
  void step(const SensorFrame& sensors, const WheelMotion& motion, std::uint64_t elapsed, ActiveCauses& out) noexcept;

  /// rad/s
  double excess() const noexcept { return excess_; }

 private:
  ConditionMeasurement compare(const Vector3& gyro, const WheelMotion& motion) const noexcept;

  ConditionWatch watch_;
  Vector3 up_imu_;  ///< the base's z axis in the IMU's axes
  double scrub_ = 0;
  double excess_ = 0;
  std::array<double, kMaxWheels> yaw_per_speed_{};  ///< yaw rate per wheel speed, signed
};

}  // namespace robot_control

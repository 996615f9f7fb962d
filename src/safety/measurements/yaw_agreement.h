#pragma once
/// The difference of the yaw rates that gyro and wheels measure.
///
///   |ω_gyro·z − ω| > limit + kScrub·|ω| + δ,   ω = (v_right − v_left)/b
///
/// z the base's z axis in the IMU's axes (MachineModel::imu_in_base), v the mean rim speed of a side, b the effective
/// wheel base, δ = 2·(quantum/T)·radius/b the encoders' tolerance (wheel_motion.h), summed over the wheels.
/// kScrub applies with several wheels a side: in a turn they scrub by up to half of ω, depending on the ground. With
/// one wheel a side it is 0.

#include <array>

#include "machine/wheeled/drive_train.h"
#include "safety/conditions/common/condition_watch.h"
#include "safety/measurements/wheel_motion.h"
#include "signals/sensor_frame.h"

namespace robot_control {

class YawAgreement {
 public:
  static constexpr double kScrub = 0.5;

  YawAgreement(const SafetyParameters& parameters, const DriveTrain& robot) noexcept;

  ConditionMeasurement measure(const SensorFrame& sensors, const WheelMotion& motion) const noexcept;

 private:
  double limit_;    ///< rad/s
  Vector3 up_imu_;  ///< the base's z axis in the IMU's axes
  double scrub_ = 0;
  std::array<double, kMaxWheels> yaw_per_speed_{};  ///< yaw rate per wheel speed, signed
};

}  // namespace robot_control

#pragma once
/// state_estimator's law: sensors of one cycle → state of that cycle.

#include <cstdint>

#include "robot/robot_model.h"
#include "signals/sensor_frame.h"
#include "signals/state_frame.h"

namespace robot_control {

struct EstimatorParameters {
  double wheel_slip_noise = 0.02;      ///< m/√m: standard deviation of travelled distance per √distance, per wheel
  double gyro_noise = 1.0e-3;          ///< rad/s/√Hz, white noise density of the gyro
  double standstill_speed = 0.01;      ///< rad/s, wheel and yaw rate below which the robot may be standing
};

class Estimator {
 public:
  /// `period`: s, > 0.
  Estimator(const EstimatorParameters& parameters, const RobotModel& robot, double period);

  /// A new run: the first sample is the offset of the encoders, the pose starts at zero.
  void reset() noexcept;

  /// After a restart within a run: continue from the last frame published, covariance grown.
  void resume(const StateFrame& last) noexcept;

  /// reset_odometry: the pose is zero from this cycle on; velocities and biases stay.
  void reset_pose() noexcept;

  /// Fills everything but `out.head`. dt = (sensors.head.cycle − the last one's) · period.
  void step(const SensorFrame& sensors, StateFrame& out) noexcept;
};

}  // namespace robot_control

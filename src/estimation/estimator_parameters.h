#pragma once
/// What a user sets of the state estimator.

namespace robot_control {

struct EstimatorParameters {
  double wheel_slip_noise = 0.02;  ///< m/√m: standard deviation of travelled distance per √distance, per wheel
  double gyro_noise = 1.0e-3;      ///< rad/s/√Hz, white noise density of the gyro
  double standstill_speed = 0.01;  ///< rad/s, wheel and yaw rate below which the robot may be standing
  double standstill_time = 0.25;   ///< s, for which all sensors must be quiet before the robot stands
  double standstill_acceleration = 0.3;  ///< m/s² RMS; MEMS noise is 0.05, a shaken robot above 0.5
  double gyro_turn_noise = 1.0e-3;       ///< rad/√rad: scale and alignment errors, as a random walk over the turn
  double gyro_bias_initial = 0.05;       ///< rad/s, standard deviation at switch-on (3 °/s, a consumer MEMS gyro)
  double gyro_bias_walk = 2.0e-5;        ///< rad/s/√s
  double speed_bandwidth = 20.0;         ///< Hz, of the tracking loop behind the twist
};

}  // namespace robot_control

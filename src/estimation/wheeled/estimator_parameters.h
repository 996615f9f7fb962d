#pragma once
/// These are the parameters of the state estimator that a user sets. Deviations are standard deviations.

#include "estimation/wheeled/calibration_bounds.h"
#include "parameters/block.h"
#include "signals/geometry.h"
#include "signals/state_frame.h"

namespace robot_control {

struct EstimatorParameters {
  double wheel_slip_noise = 8e-5;  ///< m/√m, standard deviation of travelled distance per √distance, per wheel
  double wheel_radius_deviation = 0.017;  ///< relative, of the mean radius: evenly within ±3 %, as of tyres under load
  double tyre_creep = 0.003;    ///< s²/m, slip per specific force: 1/(g C), tyres of stiffness C = 34 loads; 0: none
  double gyro_noise = 2.44e-4;  ///< rad/s/√Hz, white noise density of the gyro
  double standstill_speed = 0.01;      ///< rad/s, wheel and yaw rate below which the robot may be standing
  double standstill_time = 0.25;       ///< s, for which all sensors must be quiet before the robot stands
  double encoder_noise = 4.4e-4;       ///< rad, standard deviation of an angle: 2π/4096/√12 for 4096 counts per turn
  double gyro_scale_deviation = 3e-3;  ///< standard deviation of the gyro's scale; it enters the covariance only
  double gyro_bias_initial = 0.0175;   ///< rad/s, standard deviation at switch-on: 1 °/s, a consumer MEMS gyro
  double gyro_bias_walk = 8.7e-6;      ///< rad/s/√s
  double accelerometer_noise = 1.716e-3;    ///< m/s²/√Hz, white noise density
  double accelerometer_bias_initial = 0.2;  ///< m/s², standard deviation at switch-on (20 mg)
  double accelerometer_bias_walk = 6.5e-5;  ///< m/s²/√s
  double speed_bandwidth = 20.0;            ///< Hz, of the tracking loops behind wheel speeds
  double rate_bandwidth = 20.0;             ///< Hz, of the tracking loop behind the twist's angular velocity

  bool slip_detection = true;    ///< false: wheels are always trusted
  bool self_calibration = true;  ///< false: the calibration stays as it starts
  bool planar = true;            ///< pose_odom has z, roll and pitch zero; false: it has all six

  /// This is the calibration at the start; a deviation of 0 holds its value for ever.
  WheelCalibration calibration{.radius_ratio_deviation = 0.01, .wheel_base_deviation = 0.03};
  Vector3 gyro_bias{};  ///< rad/s, IMU axes, from an earlier run; its deviation is gyro_bias_initial
};

inline Keys keys(EstimatorParameters& estimator) {
  return {
      {"wheel_slip_noise", &estimator.wheel_slip_noise, "m/√m", 1.0e-6, 1},
      {"tyre_creep", &estimator.tyre_creep, "s²/m", 0, 0.05},
      {"gyro_noise", &estimator.gyro_noise, "rad/s/√Hz", 1.0e-9, 1},
      {"standstill_speed", &estimator.standstill_speed, "rad/s", 1.0e-6, 1},
      {"standstill_time", &estimator.standstill_time, "s", 0.01, 60},
      {"encoder_noise", &estimator.encoder_noise, "rad", 1.0e-6, 1},
      {"wheel_radius_deviation", &estimator.wheel_radius_deviation, {}, 0, 0.1},
      {"gyro_scale_deviation", &estimator.gyro_scale_deviation, {}, 0, 0.1},
      {"gyro_bias_initial", &estimator.gyro_bias_initial, "rad/s", 1.0e-6, 10},
      {"gyro_bias_walk", &estimator.gyro_bias_walk, "rad/s/√s", 1.0e-9, 1},
      {"accelerometer_noise", &estimator.accelerometer_noise, "m/s²/√Hz", 1.0e-9, 10},
      {"accelerometer_bias_initial", &estimator.accelerometer_bias_initial, "m/s²", 1.0e-6, 10},
      {"accelerometer_bias_walk", &estimator.accelerometer_bias_walk, "m/s²/√s", 1.0e-9, 10},
      {"slip_detection", &estimator.slip_detection},
      {"self_calibration", &estimator.self_calibration},
      {"planar", &estimator.planar},
      {"radius_ratio", &estimator.calibration.radius_ratio, {}, kRadiusRatioMin, kRadiusRatioMax},
      {"radius_ratio_deviation", &estimator.calibration.radius_ratio_deviation, {}, 0, 0.05},
      {"wheel_base_factor", &estimator.calibration.wheel_base_factor, {}, kWheelBaseFactorMin, kWheelBaseFactorMax},
      {"wheel_base_deviation", &estimator.calibration.wheel_base_deviation, {}, 0, 0.3},
      {"gyro_bias", &estimator.gyro_bias, "rad/s", -kGyroBiasMax, kGyroBiasMax},
      {"speed_bandwidth", &estimator.speed_bandwidth, "Hz", 0.1, 500},
      {"rate_bandwidth", &estimator.rate_bandwidth, "Hz", 0.1, 500},
  };
}

}  // namespace robot_control

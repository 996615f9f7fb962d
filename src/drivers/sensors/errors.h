#pragma once
/// The errors of the simulated machine that no description of a robot states. Those of the data sheet alone make
/// sensors that are better than they are on any floor; those of the field were measured on recordings of real robots
/// (docs/simulation.md says on which).

#include <cstdint>

namespace robot_control {

enum class ErrorLevel {
  kIdeal,      ///< every sensor is exact and immediate
  kDataSheet,  ///< encoder counts; noise, bias, walk and scale of gyro and accelerometer; delay
  kField,      ///< these, and what a floor, a load and a serial line add
};

struct Errors {
  ErrorLevel sensor_errors = ErrorLevel::kField;

  // The data sheet (sensor_errors.h). Gyro and accelerometer are those of a Bosch BMI088 (data sheet BST-BMI088-DS001,
  // section 1 "Specification", typical values): noise 0.014 °/s/√Hz and 175 µg/√Hz (mean of 160 in x and y, 190 in z),
  // offset ±1 °/s and ±20 mg. It gives no bias walk; its temperature coefficients of the offset, 0.015 °/s/K and
  // 0.2 mg/K, make that of a device whose temperature walks by 2 K in an hour. Its gyro's scale is right to
  // ±1 % ("sensitivity tolerance"), to 0.1 % after a calibration on a turntable; that is an error itself, no spread.
  double encoder_resolution = 4096;         ///< counts per turn of a wheel; 0: exact
  double gyro_noise = 2.44e-4;              ///< rad/s/√Hz
  double gyro_bias = 0.01745;               ///< rad/s, standard deviation of each axis' draw
  double gyro_bias_walk = 8.7e-6;           ///< rad/s/√s
  double gyro_scale_error = 0;              ///< measured rate = true rate · (1 + error), every axis
  double accelerometer_noise = 1.716e-3;    ///< m/s²/√Hz
  double accelerometer_bias = 0.196;        ///< m/s², standard deviation of each axis' draw
  double accelerometer_bias_walk = 6.5e-5;  ///< m/s²/√s
  std::uint64_t sensor_delay = 0;           ///< cycles

  // The field: what follows acts at kField alone.
  double roughness = 1;                    ///< of the floor, times both vibrations and the slow error (vibration.h)
  double accelerometer_vibration = 0.12;   ///< m/s²/√Hz at 1 m/s, and in proportion to the speed
  double gyro_vibration = 7e-4;            ///< rad/s/√Hz at 1 m/s, likewise
  double accelerometer_slow_error = 0.08;  ///< m/s², standard deviation along the way
  double imu_delay = 0.05;                 ///< s, of gyro and accelerometer after the encoders (late_samples.h)
  double imu_jitter = 0.002;               ///< s, standard deviation
  double encoder_jitter = 0;               ///< s; the wheels' loops are closed over a synchronous bus
  double wheel_slip_noise = 5e-3;          ///< m/√m, of a side with wheels behind each other (slip_noise.h)
  double centre_of_gravity_error = 0.03;   ///< of the wheel base, ahead and to the left (true_robot.h)
};

}  // namespace robot_control

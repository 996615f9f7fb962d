#pragma once
/// These are the errors of the simulated machine, which no robot description contains. With the errors of the data
/// sheet alone, sensors are better than on any real floor. The errors of the field were measured on recordings of real
/// robots, which docs/simulation.md names.

#include <cstdint>
#include <optional>

#include "parameters/block.h"

namespace robot_control {

enum class ErrorLevel {
  kIdeal,      ///< every sensor is exact and immediate
  kDataSheet,  ///< encoder counts; noise, bias, walk and scale of gyro and accelerometer; delay
  kField,      ///< errors of the data sheet, and those of a floor, a load and a serial line
};

/// true and false are the words of versions without levels.
inline std::vector<Word> words_of(ErrorLevel) {
  using enum ErrorLevel;
  return {{"ideal", kIdeal},
          {"data_sheet", kDataSheet},
          {"field", kField},
          {"true", kDataSheet, "data_sheet"},
          {"yes", kDataSheet, "data_sheet"},
          {"on", kDataSheet, "data_sheet"},
          {"off", kIdeal, "ideal"},
          {"no", kIdeal, "ideal"}};
}

struct Errors {
  ErrorLevel sensor_errors = ErrorLevel::kField;

  // These errors are those of the data sheet (sensor_errors.h). Gyro and accelerometer are a Bosch BMI088 (data sheet
  // BST-BMI088-DS001, section 1 "Specification", typical values). Its noise is 0.014 °/s/√Hz and 175 µg/√Hz (mean of
  // 160 in x and y, 190 in z), its offset ±1 °/s and ±20 mg. The sheet states no bias walk. The values here follow from
  // its temperature coefficients, 0.015 °/s/K and 0.2 mg/K, for a temperature that walks by 2 K per hour. The scale of
  // the gyro is right to ±1 % ("sensitivity tolerance"), or to 0.1 % after a calibration on a turntable. The value
  // `gyro_scale_error` is the error itself, not a standard deviation.
  double encoder_resolution = 4096;         ///< counts per turn of a wheel; 0: exact
  double gyro_noise = 2.44e-4;              ///< rad/s/√Hz
  double gyro_bias = 0.01745;               ///< rad/s, standard deviation of the initial bias of each axis
  double gyro_bias_walk = 8.7e-6;           ///< rad/s/√s
  double gyro_scale_error = 0;              ///< measured rate = true rate · (1 + error), every axis
  double accelerometer_noise = 1.716e-3;    ///< m/s²/√Hz
  double accelerometer_bias = 0.196;        ///< m/s², standard deviation of the initial bias of each axis
  double accelerometer_bias_walk = 6.5e-5;  ///< m/s²/√s
  std::uint64_t sensor_delay = 0;           ///< cycles

  // Force sensors at feet, of robots on legs alone: as cheap cells in a rubber foot have them.
  double foot_offset = 3;      ///< N, standard deviation of each axis' draw
  double foot_noise = 0.05;    ///< N/√Hz
  double foot_threshold = 10;  ///< N; a smaller force is measured as zero
  double joint_offset = 0;     ///< rad, standard deviation of the zero of each encoder on legs: set by hand, 0.01

  // These errors act only at kField.
  double roughness = 1;  ///< factor of the floor on both vibrations and the slow error (sensor_errors.h)
  double accelerometer_vibration = 0.12;   ///< m/s²/√Hz at 1 m/s, proportional to the speed
  double gyro_vibration = 7e-4;            ///< rad/s/√Hz at 1 m/s, proportional to the speed
  double accelerometer_slow_error = 0.08;  ///< m/s², standard deviation along the path
  /// s, of gyro and accelerometer behind the encoders (sensor_errors.h); none: that of the robot's kind
  std::optional<double> imu_delay = std::nullopt;
  std::optional<double> imu_jitter = std::nullopt;  ///< s, standard deviation
  double encoder_jitter = 0;                        ///< s; zero because the wheels' loops use a synchronous bus
  double wheel_slip_noise = 5e-3;         ///< m/√m, for a side with wheels behind each other (wheel_contacts.h)
  double centre_of_gravity_error = 0.03;  ///< part of the wheel base, ahead and to the left (true_robot.h)
};

/// The delay of an IMU and its standard deviation, s, where they are left out.
struct ImuDelay {
  double mean = 0;
  double jitter = 0;
};
// On wheels the IMU is a device of its own, behind a serial line. On legs it is on the synchronous bus of the joints,
// and two of its cycles of 1 ms are assumed.
inline constexpr ImuDelay kImuOnWheels{.mean = 0.05, .jitter = 0.002};
inline constexpr ImuDelay kImuOnLegs{.mean = 0.002};

inline Keys keys(Errors& errors) {
  return {
      {"sensor_errors", &errors.sensor_errors},
      {"roughness", &errors.roughness, {}, 0, 100},
      {"accelerometer_vibration", &errors.accelerometer_vibration, "m/s²/√Hz", 0, 10},
      {"gyro_vibration", &errors.gyro_vibration, "rad/s/√Hz", 0, 1},
      {"accelerometer_slow_error", &errors.accelerometer_slow_error, "m/s²", 0, 10},
      {"imu_delay", &errors.imu_delay, "s", 0, 0.5, kOptional},
      {"imu_jitter", &errors.imu_jitter, "s", 0, 0.1, kOptional},
      {"encoder_jitter", &errors.encoder_jitter, "s", 0, 0.1},
      {"wheel_slip_noise", &errors.wheel_slip_noise, "m/√m", 0, 0.1},
      {"centre_of_gravity_error", &errors.centre_of_gravity_error, {}, -0.2, 0.2},
      {"encoder_resolution", &errors.encoder_resolution, "counts", 0, 1.0e9, kZeroIsOff},
      {"gyro_noise", &errors.gyro_noise, "rad/s/√Hz", 0, 1},
      {"gyro_bias", &errors.gyro_bias, "rad/s", 0, 10},
      {"gyro_bias_walk", &errors.gyro_bias_walk, "rad/s/√s", 0, 1},
      {"gyro_scale_error", &errors.gyro_scale_error, {}, -0.5, 0.5},
      {"accelerometer_noise", &errors.accelerometer_noise, "m/s²/√Hz", 0, 10},
      {"accelerometer_bias", &errors.accelerometer_bias, "m/s²", 0, 10},
      {"accelerometer_bias_walk", &errors.accelerometer_bias_walk, "m/s²/√s", 0, 10},
      {"sensor_delay", &errors.sensor_delay, "cycles", 0, 100},
      {"foot_offset", &errors.foot_offset, "N", 0, 1000},
      {"foot_noise", &errors.foot_noise, "N/√Hz", 0, 100},
      {"foot_threshold", &errors.foot_threshold, "N", 0, 1000},
      {"joint_offset", &errors.joint_offset, "rad", 0, 0.2},
  };
}

}  // namespace robot_control

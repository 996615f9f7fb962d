#include "estimation/wheeled/estimator_setup.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <variant>

namespace robot_control {

const EstimatorParameters& checked(const EstimatorParameters& parameters, const DriveTrain& robot, double period) {
  const auto require = [](bool holds, const std::string& what, double value) {
    if (!holds) throw std::invalid_argument("estimator: " + what + ", is " + std::to_string(value));
  };
  const auto positive = [&](double value, const char* what) {
    require(value > 0 && std::isfinite(value), what, value);
  };
  positive(period, "period must be > 0 s");
  positive(robot.effective_wheel_base(), "wheel_base and its multiplier must be > 0 m");
  const Quaternion& q = robot.imu_in_base.orientation;
  positive(std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]),
           "orientation of the IMU is no rotation: its norm must be > 0");
  for (const auto side : {Side::kLeft, Side::kRight}) {
    const auto wheels = std::ranges::count(robot.wheels, side, &WheelModel::side);
    require(wheels > 0, "there must be a wheel on either side", static_cast<double>(wheels));
  }
  for (const WheelModel& wheel : robot.wheels) positive(wheel.radius, "radius of a wheel must be > 0 m");
  EstimatorParameters given = parameters;
  for (const Key& key : keys(given)) {
    if (!std::holds_alternative<double*>(key.field)) continue;
    const double value = *std::get<double*>(key.field);
    const std::string rule = std::string(key.name) + (key.min > 0 ? " must be > 0 " : " must be >= 0 ");
    require((key.min > 0 ? value > 0 : value >= 0) && std::isfinite(value), rule + std::string(key.unit), value);
  }
  return parameters;
}

double encoder_deviation(const EstimatorParameters& parameters, const DriveTrain& robot) {
  return parameters.encoder_noise * std::ranges::max(robot.wheels, {}, &WheelModel::radius).radius;
}

double icr_deviation(const DriveTrain& robot) {
  const auto along = [](const WheelModel& wheel) { return wheel.centre_base[0]; };
  const auto [last, first] = std::ranges::minmax(robot.wheels, {}, along);
  const double scrubs = std::sqrt(std::max(0.0, robot.wheel_base_multiplier - 1)) * robot.wheel_base;
  const double unknown = drags_wheels(robot) ? robot.effective_wheel_base() / 2 : 0;
  const double length = along(first) - along(last);
  return (length > 0 ? length : scrubs > 0 ? scrubs : unknown) / std::sqrt(12.0);
}

bool drags_wheels(const DriveTrain& robot) {
  return !robot.bodies || robot.wheels.size() != 2 || robot.wheel_base_multiplier != 1;
}

PlanarCoreParams core_params(const EstimatorParameters& parameters, const DriveTrain& robot) {
  const double learns = parameters.self_calibration ? 1.0 : 0.0;
  return {.wheel_base = robot.effective_wheel_base(),
          .gyro_noise = parameters.gyro_noise,
          .gyro_bias_walk = parameters.gyro_bias_walk,
          .gyro_bias_initial = parameters.gyro_bias_initial,
          .gyro_scale = parameters.gyro_scale_deviation,
          .encoder = encoder_deviation(parameters, robot),
          .slip_least = parameters.wheel_slip_noise,
          .drags_wheels = drags_wheels(robot),
          .ratio_deviation = learns * parameters.calibration.radius_ratio_deviation,
          .wheel_base_deviation = learns * parameters.calibration.wheel_base_deviation,
          .radius_deviation = parameters.wheel_radius_deviation,
          .icr_deviation = icr_deviation(robot)};
}

TiltParams tilt_params(const EstimatorParameters& parameters) {
  return {.accelerometer = parameters.accelerometer_noise,
          .bias = parameters.accelerometer_bias_initial,
          .bias_walk = parameters.accelerometer_bias_walk};
}

RestWatchParams rest_params(const EstimatorParameters& parameters, const DriveTrain& robot) {
  return {.window = parameters.standstill_time,
          .tolerance = parameters.standstill_speed * parameters.standstill_time *
                       std::ranges::min(robot.wheels, {}, &WheelModel::radius).radius,
          .steady = parameters.standstill_speed,
          .turn_per_metre = 1 / robot.effective_wheel_base()};
}

SlipParams slip_params(const EstimatorParameters& parameters, const DriveTrain& robot) {
  Vector3 ground = middle_of_axles(robot);
  for (const WheelModel& wheel : robot.wheels) ground[2] -= wheel.radius / static_cast<double>(robot.wheels.size());
  return {.encoder = encoder_deviation(parameters, robot),
          .accelerometer = parameters.accelerometer_noise,
          .imu_x = robot.imu_in_base.position[0] - ground[0],
          .imu_y = robot.imu_in_base.position[1] - ground[1],
          .imu_above_ground = robot.imu_in_base.position[2] - ground[2]};
}

}  // namespace robot_control

#include "estimation/estimator.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace robot_control {
namespace {

constexpr double kGravity = 9.80665;        // m/s², standard gravity
constexpr double kGravityDeviation = 1.0;   // m/s², see the header's confidence
constexpr double kSpeedDeviation = 0.005;   // m/s, encoder counts behind the tracking loop
constexpr double kGravitySmoothing = 0.05;  // s

const EstimatorParameters& checked(const EstimatorParameters& parameters, const RobotModel& robot, double period) {
  const auto require = [](bool holds, const char* what, double value) {
    if (!holds) throw std::invalid_argument("estimator: " + std::string(what) + ", is " + std::to_string(value));
  };
  const auto positive = [&](double value, const char* what) {
    require(value > 0 && std::isfinite(value), what, value);
  };
  const auto no_less = [&](double value, const char* what) {
    require(value >= 0 && std::isfinite(value), what, value);
  };
  positive(period, "period must be > 0 s");
  positive(robot.effective_wheel_base(), "wheel_base and its multiplier must be > 0 m");
  for (const Side side : {Side::kLeft, Side::kRight}) {
    const auto wheels = std::ranges::count(robot.wheels, side, &WheelModel::side);
    require(wheels > 0, "there must be a wheel on either side", static_cast<double>(wheels));
  }
  for (const WheelModel& wheel : robot.wheels) positive(wheel.radius, "radius of a wheel must be > 0 m");
  no_less(parameters.wheel_slip_noise, "wheel_slip_noise must be >= 0 m/√m");
  no_less(parameters.gyro_noise, "gyro_noise must be >= 0 rad/s/√Hz");
  positive(parameters.standstill_speed, "standstill_speed must be > 0 rad/s");
  positive(parameters.standstill_time, "standstill_time must be > 0 s");
  positive(parameters.standstill_acceleration, "standstill_acceleration must be > 0 m/s²");
  no_less(parameters.gyro_turn_noise, "gyro_turn_noise must be >= 0 rad/√rad");
  no_less(parameters.gyro_bias_initial, "gyro_bias_initial must be >= 0 rad/s");
  no_less(parameters.gyro_bias_walk, "gyro_bias_walk must be >= 0 rad/s/√s");
  positive(parameters.speed_bandwidth, "speed_bandwidth must be > 0 Hz");
  return parameters;
}

double square(double value) noexcept {
  return value * value;
}

bool finite(const Vector3& vector) noexcept {
  return std::isfinite(vector[0]) && std::isfinite(vector[1]) && std::isfinite(vector[2]);
}

double dot(const Vector3& a, const Vector3& b) noexcept {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Third row of the rotation matrix of q.
Vector3 up_in(const Quaternion& q) {
  const double norm = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
  if (!(norm > 0)) throw std::invalid_argument("estimator: orientation of the IMU is no rotation");
  return {2 * (q[0] * q[2] - q[1] * q[3]) / norm, 2 * (q[1] * q[2] + q[0] * q[3]) / norm,
          1 - 2 * (q[0] * q[0] + q[1] * q[1]) / norm};
}

double yaw_of(const Quaternion& q) noexcept {
  return std::atan2(2 * (q[3] * q[2] + q[0] * q[1]), 1 - 2 * (q[1] * q[1] + q[2] * q[2]));
}

bool continuable(const StateFrame& last) noexcept {
  bool good = (last.flags & kStateValid) != 0 && finite(last.pose_odom.position) && finite(last.twist_base.linear) &&
              finite(last.twist_base.angular) && finite(last.gyro_bias) && std::isfinite(last.distance) &&
              std::isfinite(yaw_of(last.pose_odom.orientation));
  for (const double entry : last.pose_covariance) good = good && std::isfinite(entry);
  return good;
}

YawFusionParameters fusion_parameters(const EstimatorParameters& parameters, const RobotModel& robot) {
  return {.wheel_slip_noise = parameters.wheel_slip_noise,
          .wheel_base = robot.effective_wheel_base(),
          .gyro_noise = parameters.gyro_noise,
          .gyro_turn_noise = parameters.gyro_turn_noise,
          .rate_floor = parameters.standstill_speed};
}

StandstillLimits standstill_limits(const EstimatorParameters& parameters, const RobotModel& robot, double period) {
  const double cycles = std::max(1.0, std::ceil(parameters.standstill_time / period - 1e-9));
  return {.cycles = static_cast<std::uint64_t>(cycles),
          .tolerance = parameters.standstill_speed * parameters.standstill_time *
                       std::ranges::min(robot.wheels, {}, &WheelModel::radius).radius,
          .acceleration = parameters.standstill_acceleration};
}

}  // namespace

Estimator::Estimator(const EstimatorParameters& parameters, const RobotModel& robot, double period)
    : parameters_(checked(parameters, robot, period)),
      period_(period),
      geometry_(robot),
      up_in_imu_(up_in(robot.imu_in_base.orientation)),
      encoders_(robot),
      left_speed_(parameters.speed_bandwidth, period),
      right_speed_(parameters.speed_bandwidth, period),
      fusion_(fusion_parameters(parameters, robot)),
      covariance_(square(parameters.gyro_bias_initial)),
      standstill_(standstill_limits(parameters, robot, period)),
      gravity_(kGravity) {}

void Estimator::reset() noexcept {
  encoders_.reset();
  left_speed_.reset(0);
  right_speed_.reset(0);
  fusion_.reset();
  covariance_.reset();
  standstill_.reset();
  x_ = y_ = yaw_ = 0;
  distance_ = 0;
  bias_ = {};
  gyro_ = {};
  accelerometer_good_ = false;
  gravity_ = kGravity;
  began_ = anchored_ = restart_pending_ = false;
  pose_pending_.reset();
  cycle_ = cycles_ = skipped_ = 0;
  flags_ = lasting_flags_ = 0;
  clear_gap();
}

void Estimator::resume(const StateFrame& last) noexcept {
  reset();
  if (!continuable(last)) return;
  x_ = last.pose_odom.position[0];
  y_ = last.pose_odom.position[1];
  yaw_ = yaw_of(last.pose_odom.orientation);
  distance_ = last.distance;
  bias_ = last.gyro_bias;
  skipped_ = last.skipped;
  covariance_.restore(last.pose_covariance);
  const double turn_speed = last.twist_base.angular[2] * geometry_.wheel_base / 2;
  const double speed = last.twist_base.linear[0] - last.twist_base.angular[2] * geometry_.axle_y;
  left_speed_.reset(speed - turn_speed);
  right_speed_.reset(speed + turn_speed);
  cycle_ = last.head.cycle;
  began_ = restart_pending_ = true;
  lasting_flags_ = kStateRestarted;
}

void Estimator::set_pose(const Vector3& pose) noexcept {
  pose_pending_ = pose;
}

void Estimator::step(const SensorFrame& sensors, StateFrame& out) noexcept {
  const std::uint64_t cycle = sensors.head.cycle;
  if (began_ && cycle <= cycle_ && !restart_pending_) return fill(out);
  count_cycles(cycle);
  read_gyro(sensors);
  read_accelerometer(sensors);
  covariance_.grow_bias(square(parameters_.gyro_bias_walk) * static_cast<double>(cycles_) * period_);
  travel(sensors);
  if (pose_pending_) {
    x_ = (*pose_pending_)[0];
    y_ = (*pose_pending_)[1];
    yaw_ = (*pose_pending_)[2];
    pose_pending_.reset();
    covariance_.reset_pose();
  }
  fill(out);
}

void Estimator::step(const SensorFrame& sensors, double /*dt*/, StateFrame& out) noexcept {
  step(sensors, out);
}

void Estimator::count_cycles(std::uint64_t cycle) noexcept {
  flags_ = lasting_flags_;
  if (!began_) {
    cycles_ = 0;
    skipped_ = cycle;  // the run began without us
  } else {
    cycles_ = cycle > cycle_ ? cycle - cycle_ : 0;
    if (cycles_ > 1) {
      skipped_ += cycles_ - 1;
      flags_ |= kStateSkipped;
    }
  }
  began_ = true;
  cycle_ = cycle;
  gap_cycles_ += cycles_;
}

void Estimator::read_gyro(const SensorFrame& sensors) noexcept {
  const GyroSample before = gyro_;
  gyro_.rate = sensors.imu.angular_velocity;
  const bool offered = (sensors.valid & kValidGyro) != 0;
  gyro_.good = offered && finite(gyro_.rate) && dot(gyro_.rate, gyro_.rate) <= square(kGyroRange);
  if (!gyro_.good) {
    flags_ |= kStateNoGyro;
    if (offered) flags_ |= kStateBadSample;
    gap_gyro_ = false;
    return;
  }
  gyro_.yaw = dot(up_in_imu_, gyro_.rate);
  if (!before.good) {
    gap_gyro_ = false;
    return;
  }
  const double dt = static_cast<double>(cycles_) * period_;
  gap_turn_ += (before.yaw + gyro_.yaw) / 2 * dt;
  // Between two samples that are more than a cycle apart the rate is somewhere between them: a uniform error.
  if (cycles_ > 1) gap_variance_ += square((gyro_.yaw - before.yaw) * dt) / 12;
}

void Estimator::read_accelerometer(const SensorFrame& sensors) noexcept {
  const Vector3& acceleration = sensors.imu.linear_acceleration;
  const bool offered = (sensors.valid & kValidAccelerometer) != 0;
  const double norm = std::sqrt(dot(acceleration, acceleration));
  accelerometer_good_ = offered && std::isfinite(norm);
  if (offered && !accelerometer_good_) flags_ |= kStateBadSample;
  if (!accelerometer_good_) return;
  const double dt = static_cast<double>(std::max<std::uint64_t>(cycles_, 1)) * period_;
  gravity_ += dt / (kGravitySmoothing + dt) * (norm - gravity_);
}

void Estimator::travel(const SensorFrame& sensors) noexcept {
  const double time = static_cast<double>(gap_cycles_) * period_;
  const EncoderReading reading = encoders_.step(sensors, time);
  if (reading == EncoderReading::kRejected) {
    flags_ |= kStateBadSample;
    standstill_.reset();
    return;
  }
  if (reading != EncoderReading::kTravel || gap_cycles_ == 0) {
    if (restart_pending_ || reading == EncoderReading::kLost) lose_travel(time);
    if (!restart_pending_) {
      left_speed_.reset(encoders_.left_speed(sensors));
      right_speed_.reset(encoders_.right_speed(sensors));
    }
    restart_pending_ = false;
    anchored_ = true;
    clear_gap();
    return;
  }

  const double left = encoders_.left();
  const double right = encoders_.right();
  left_speed_.step(left, time);
  right_speed_.step(right, time);
  learn(sensors);

  YawSources sources;
  sources.turn_wheels = geometry_.turn(left, right);
  sources.turn_gyro = gap_turn_ - bias_yaw() * time;
  sources.travel = std::abs(left) + std::abs(right);
  sources.dt = time;
  sources.bias_variance = covariance_.bias_variance();
  sources.gap_variance = gap_variance_;
  sources.gyro = gap_gyro_;
  sources.standing = standstill_.standing();
  fusion_.step(sources);
  if (!gap_gyro_) flags_ |= kStateNoGyro;

  const double distance = (left + right) / 2;
  const Motion motion = geometry_.base_motion(distance, fusion_.turn());
  const Chord chord = chord_of(motion, yaw_);
  if (!standstill_.standing()) {
    CovarianceStep growth;
    growth.chord = chord;
    growth.per_turn = geometry_.base_motion(0, 1);
    growth.gain = fusion_.gain();
    growth.dt = time;
    growth.distance_variance = square(geometry_.wheel_base) / 4 * fusion_.wheel_variance();
    growth.wheel_turn_variance = fusion_.wheel_variance();
    growth.gyro_turn_variance = fusion_.gyro_variance();
    covariance_.step(growth);
    distance_ += std::abs(distance);
  }
  x_ += chord.x;
  y_ += chord.y;
  yaw_ += motion.turn;
  if (std::abs(yaw_) > std::numbers::pi) yaw_ = std::remainder(yaw_, 2 * std::numbers::pi);
  clear_gap();
}

void Estimator::learn(const SensorFrame& sensors) noexcept {
  if (!gap_gyro_) {
    standstill_.reset();
    return;
  }
  StandstillSample sample;
  sample.left = encoders_.left();
  sample.right = encoders_.right();
  sample.cycles = gap_cycles_;
  sample.angular_velocity = gyro_.rate;
  sample.accelerometer = accelerometer_good_;
  sample.linear_acceleration = sensors.imu.linear_acceleration;
  if (!standstill_.step(sample)) return;

  const double window = static_cast<double>(standstill_.cycles()) * period_;
  const Vector3& mean = standstill_.mean_angular_velocity();
  const double turned = geometry_.turn(standstill_.left(), standstill_.right()) / window;
  const double rate = dot(up_in_imu_, mean) - turned - bias_yaw();
  const double noise = square(parameters_.gyro_noise) / window;
  const double tolerance = parameters_.standstill_speed + 3 * std::sqrt(covariance_.bias_variance() + noise);
  standstill_.judge(std::abs(rate) <= tolerance);
  if (!standstill_.standing()) return;
  const double gain = covariance_.learn_bias(noise);
  for (std::size_t i = 0; i < 3; ++i) bias_[i] += gain * (mean[i] - turned * up_in_imu_[i] - bias_[i]);
}

void Estimator::lose_travel(double time) noexcept {
  const double speed = (left_speed_.speed() + right_speed_.speed()) / 2;
  const double rate = geometry_.turn(left_speed_.speed(), right_speed_.speed());
  covariance_.grow_pose(square(kRestartPosition) + square(speed * time), square(kRestartYaw) + square(rate * time));
}

void Estimator::clear_gap() noexcept {
  gap_cycles_ = 0;
  gap_turn_ = 0;
  gap_variance_ = 0;
  gap_gyro_ = true;
}

double Estimator::bias_yaw() const noexcept {
  return dot(up_in_imu_, bias_);
}

void Estimator::fill_twist(StateFrame& out) const noexcept {
  const double speed = (left_speed_.speed() + right_speed_.speed()) / 2;
  const double wheel_rate = geometry_.turn(left_speed_.speed(), right_speed_.speed());
  const double gain = gyro_.good ? fusion_.gain() : 0;
  const double rate = wheel_rate + gain * (gyro_.yaw - bias_yaw() - wheel_rate);
  const Motion motion = geometry_.base_motion(speed, rate);
  out.twist_base = {{motion.forward, motion.left, 0}, {0, 0, rate}};

  // White wheel noise behind the tracking loop has its density times the loop's bandwidth as variance.
  const double speed_variance = square(kSpeedDeviation) + square(parameters_.wheel_slip_noise) *
                                                              parameters_.speed_bandwidth *
                                                              (std::abs(speed) + std::abs(wheel_rate));
  const double wheel_rate_variance = 4 * speed_variance / square(geometry_.wheel_base);
  const double gyro_rate_variance = square(parameters_.gyro_noise) / period_ + covariance_.bias_variance();
  const double rate_variance = square(1 - gain) * wheel_rate_variance + square(gain) * gyro_rate_variance;
  out.twist_covariance = {};
  for (const std::size_t i : {1U, 2U, 3U, 4U}) out.twist_covariance[7 * i] = kPlanarVariance;
  out.twist_covariance[0] = speed_variance;
  out.twist_covariance[35] = rate_variance;
}

void Estimator::fill(StateFrame& out) const noexcept {
  out.pose_odom.position = {x_, y_, 0};
  out.pose_odom.orientation = {0, 0, std::sin(yaw_ / 2), std::cos(yaw_ / 2)};
  fill_twist(out);

  constexpr std::size_t kIndex[3] = {0, 1, 5};
  out.pose_covariance = {};
  for (const std::size_t i : {2U, 3U, 4U}) out.pose_covariance[7 * i] = kPlanarVariance;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      out.pose_covariance[6 * kIndex[row] + kIndex[column]] = covariance_.at(row, column);
    }
  }
  out.gyro_bias = bias_;
  out.accelerometer_bias = {};

  const bool encoders_good = anchored_ && gap_cycles_ == 0;
  const bool gyro_used = (flags_ & kStateNoGyro) == 0;
  const double agreement = fusion_.confidence();
  out.confidence = {};
  out.confidence[kLeftEncoder] = out.confidence[kRightEncoder] = encoders_good ? agreement : 0;
  out.confidence[kGyro] = gyro_used ? agreement : 0;
  out.confidence[kAccelerometer] =
      accelerometer_good_ ? std::exp(-square((gravity_ - kGravity) / kGravityDeviation) / 2) : 0;

  out.flags = flags_;
  if (anchored_ && gap_cycles_ <= kMaxHeld) out.flags |= kStateValid;
  if (fusion_.slip()) out.flags |= kStateSlip;
  if (standstill_.standing()) out.flags |= kStateStandstill;
  out.distance = distance_;
  out.skipped = skipped_;
}

}  // namespace robot_control

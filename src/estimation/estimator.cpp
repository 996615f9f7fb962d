#include "estimation/estimator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

namespace robot_control {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Filter = ErrorStateFilter;
constexpr int kLeft = 0;
constexpr int kRight = 1;

constexpr double kQuietAcceleration = 0.1;  // m/s², mean at rest beside what is expected: sliding slower is no slide
constexpr std::uint64_t kDoubtfulWindows = 8;   // then the velocity was wrong, not the window
constexpr double kAccelerometerAtRest = 0.005;  // m/s², what a motor's hum leaves in a mean
constexpr double kSpeedDeviation = 0.005;       // m/s, encoder counts behind the tracking loop

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
  for (const auto side : {robot_control::Side::kLeft, robot_control::Side::kRight}) {
    const auto wheels = std::ranges::count(robot.wheels, side, &WheelModel::side);
    require(wheels > 0, "there must be a wheel on either side", static_cast<double>(wheels));
  }
  for (const WheelModel& wheel : robot.wheels) positive(wheel.radius, "radius of a wheel must be > 0 m");
  no_less(parameters.wheel_slip_noise, "wheel_slip_noise must be >= 0 m/√m");
  positive(parameters.encoder_noise, "encoder_noise must be > 0 rad");
  positive(parameters.gyro_noise, "gyro_noise must be > 0 rad/s/√Hz");
  positive(parameters.accelerometer_noise, "accelerometer_noise must be > 0 m/s²/√Hz");
  positive(parameters.standstill_speed, "standstill_speed must be > 0 rad/s");
  positive(parameters.standstill_time, "standstill_time must be > 0 s");
  positive(parameters.standstill_acceleration, "standstill_acceleration must be > 0 m/s²");
  no_less(parameters.gyro_scale_deviation, "gyro_scale_deviation must be >= 0");
  no_less(parameters.gyro_bias_initial, "gyro_bias_initial must be >= 0 rad/s");
  no_less(parameters.gyro_bias_walk, "gyro_bias_walk must be >= 0 rad/s/√s");
  no_less(parameters.accelerometer_bias_initial, "accelerometer_bias_initial must be >= 0 m/s²");
  no_less(parameters.accelerometer_bias_walk, "accelerometer_bias_walk must be >= 0 m/s²/√s");
  no_less(parameters.calibration.radius_ratio_deviation, "radius_ratio_deviation must be >= 0");
  no_less(parameters.calibration.wheel_base_deviation, "wheel_base_deviation must be >= 0");
  positive(parameters.speed_bandwidth, "speed_bandwidth must be > 0 Hz");
  return parameters;
}

double square(double value) noexcept {
  return value * value;
}

bool finite(const Vector3& vector) noexcept {
  return std::isfinite(vector[0]) && std::isfinite(vector[1]) && std::isfinite(vector[2]);
}

Vector3d vector(const Vector3& v) noexcept {
  return {v[0], v[1], v[2]};
}

Vector3 array(const Vector3d& v) noexcept {
  return {v.x(), v.y(), v.z()};
}

Matrix3d rotation(const Quaternion& q) {
  const Eigen::Quaterniond quaternion(q[3], q[0], q[1], q[2]);
  if (!(quaternion.norm() > 0)) throw std::invalid_argument("estimator: orientation of the IMU is no rotation");
  return quaternion.normalized().toRotationMatrix();
}

double yaw_of(const Matrix3d& r) noexcept {
  return std::atan2(r(1, 0), r(0, 0));
}

double yaw_of(const Quaternion& q) noexcept {
  return std::atan2(2 * (q[3] * q[2] + q[0] * q[1]), 1 - 2 * (q[1] * q[1] + q[2] * q[2]));
}

Quaternion quaternion(const Matrix3d& r) noexcept {
  const Eigen::Quaterniond q(r);
  return {q.x(), q.y(), q.z(), q.w()};
}

Matrix3d about_z(double yaw) noexcept {
  return Eigen::AngleAxisd(yaw, Vector3d::UnitZ()).toRotationMatrix();
}

Matrix3d cross_matrix(const Vector3d& v) noexcept {
  Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

bool continuable(const StateFrame& last) noexcept {
  bool good = (last.flags & kStateValid) != 0 && finite(last.pose_odom.position) && finite(last.twist_base.linear) &&
              finite(last.twist_base.angular) && finite(last.gyro_bias) && finite(last.accelerometer_bias) &&
              finite(last.gyro_bias_deviation) && std::isfinite(last.distance) &&
              std::isfinite(yaw_of(last.pose_odom.orientation));
  for (const double entry : last.pose_covariance) good = good && std::isfinite(entry);
  const WheelCalibration& c = last.calibration;
  for (const double entry : {c.radius_ratio, c.wheel_base_factor, c.radius_ratio_deviation, c.wheel_base_deviation}) {
    good = good && std::isfinite(entry);
  }
  const Quaternion& q = last.attitude;
  return good && std::abs(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] - 1) < 1e-6;
}

ContactGeometry contact_geometry(const WheelGeometry& wheels, const RobotModel& robot) {
  const Vector3& imu = robot.imu_in_base.position;
  return {.wheel_base = wheels.wheel_base,
          .middle_y = wheels.axle_y - imu[1],
          .middle_x = wheels.axle_x - imu[0],
          .height = wheels.ground - imu[2],
          .imu_in_base = vector(imu)};
}

FilterNoise filter_noise(const EstimatorParameters& parameters, const RobotModel& robot) {
  FilterNoise noise;
  noise.gyro = parameters.gyro_noise;
  noise.gyro_bias_walk = parameters.gyro_bias_walk;
  noise.accelerometer = parameters.accelerometer_noise;
  noise.accelerometer_bias_walk = parameters.accelerometer_bias_walk;
  noise.wheel_slip = parameters.wheel_slip_noise;
  noise.encoder = parameters.encoder_noise * std::ranges::max(robot.wheels, {}, &WheelModel::radius).radius;
  return noise;
}

FilterPrior filter_prior(const EstimatorParameters& parameters) {
  const double learns = parameters.self_calibration ? 1.0 : 0.0;
  return {.gyro_bias = parameters.gyro_bias_initial,
          .accelerometer_bias = parameters.accelerometer_bias_initial,
          .radius_ratio = learns * parameters.calibration.radius_ratio_deviation,
          .wheel_base = learns * parameters.calibration.wheel_base_deviation,
          .gyro_scale = parameters.gyro_scale_deviation};
}

StandstillLimits standstill_limits(const EstimatorParameters& parameters, const RobotModel& robot) {
  return {.time = parameters.standstill_time,
          .tolerance = parameters.standstill_speed * parameters.standstill_time *
                       std::ranges::min(robot.wheels, {}, &WheelModel::radius).radius,
          .acceleration = parameters.standstill_acceleration};
}

}  // namespace

Estimator::Estimator(const EstimatorParameters& parameters, const RobotModel& robot, double period)
    : parameters_(checked(parameters, robot, period)),
      period_(period),
      geometry_(robot),
      base_from_imu_(rotation(robot.imu_in_base.orientation)),
      filter_(contact_geometry(geometry_, robot), filter_noise(parameters, robot), filter_prior(parameters)),
      standstill_(standstill_limits(parameters, robot)),
      sides_{Side{SideEncoder(robot, robot_control::Side::kLeft), SpeedTracker(parameters.speed_bandwidth, period)},
             Side{SideEncoder(robot, robot_control::Side::kRight), SpeedTracker(parameters.speed_bandwidth, period)}} {
  reset();
}

void Estimator::reset() noexcept {
  filter_.reset();
  filter_.radius_ratio = parameters_.calibration.radius_ratio - 1;
  filter_.wheel_base = parameters_.calibration.wheel_base_factor - 1;
  filter_.gyro_bias = base_from_imu_ * vector(parameters_.gyro_bias);
  slip_.reset();
  standstill_.reset();
  imu_.reset();
  for (Side& side : sides_) {
    side.encoder.reset();
    side.speed.reset(0);
    side.total = 0;
    side.ahead = 0;
    side.refused = 0;
    side.believed = true;
  }
  resting_ = true;
  held_ = {};
  steady_time_ = 0;
  doubtful_windows_ = 0;
  rested_ = 0;
  wheels_ = {};
  distance_ = 0;
  nis_ = {};
  rejected_ = {};
  began_ = restart_pending_ = false;
  pose_pending_.reset();
  cycle_ = skipped_ = 0;
  flags_ = lasting_flags_ = 0;
}

void Estimator::resume(const StateFrame& last) noexcept {
  reset();
  if (!continuable(last)) return;
  filter_.rotation = rotation(last.attitude);
  place({last.pose_odom.position[0], last.pose_odom.position[1], yaw_of(last.pose_odom.orientation)});
  filter_.gyro_bias = base_from_imu_ * vector(last.gyro_bias);
  filter_.accelerometer_bias = base_from_imu_ * vector(last.accelerometer_bias);
  filter_.radius_ratio = last.calibration.radius_ratio - 1;
  filter_.wheel_base = last.calibration.wheel_base_factor - 1;
  auto& p = filter_.covariance;
  p(Filter::kRadiusRatio, Filter::kRadiusRatio) = square(last.calibration.radius_ratio_deviation);
  p(Filter::kWheelBase, Filter::kWheelBase) = square(last.calibration.wheel_base_deviation);
  for (int i = 0; i < 3; ++i) {
    p(Filter::kGyroBias + i, Filter::kGyroBias + i) = square(last.gyro_bias_deviation[static_cast<std::size_t>(i)]);
  }
  constexpr int kIndex[3] = {Filter::kPosition, Filter::kPosition + 1, Filter::kOrientation + 2};
  constexpr std::size_t kEntry[3] = {0, 1, 5};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) p(kIndex[i], kIndex[j]) = last.pose_covariance[6 * kEntry[i] + kEntry[j]];
  }
  const Vector3d base_velocity = vector(last.twist_base.linear);
  const Vector3d rate = vector(last.twist_base.angular);
  filter_.velocity = base_velocity + rate.cross(filter_.geometry().imu_in_base);
  const double turn = rate.z() * geometry_.wheel_base / 2;
  const double speed = base_velocity.x() - rate.z() * geometry_.axle_y;
  sides_[kLeft].speed.reset(speed - turn);
  sides_[kRight].speed.reset(speed + turn);
  wheels_ = last.wheels;
  distance_ = last.distance;
  rejected_ = last.rejected;
  skipped_ = last.skipped;
  cycle_ = last.head.cycle;
  began_ = restart_pending_ = true;
  resting_ = false;
  lasting_flags_ = kStateRestarted;
}

void Estimator::set_pose(const Vector3& pose) noexcept {
  pose_pending_ = pose;
}

void Estimator::step(const SensorFrame& sensors, StateFrame& out) noexcept {
  const std::uint64_t cycle = sensors.head.cycle;
  if (began_ && cycle <= cycle_ && !restart_pending_) return fill(out);
  flags_ = lasting_flags_;
  std::uint64_t cycles = 0;
  if (!began_) {
    skipped_ = cycle;  // the run began without us
  } else if (cycle > cycle_) {
    cycles = cycle - cycle_;
    skipped_ += cycles - 1;
    if (cycles > 1) flags_ |= kStateSkipped;
  }
  began_ = true;
  cycle_ = cycle;
  advance(sensors, static_cast<double>(cycles) * period_);
  fill(out);
}

void Estimator::step(const SensorFrame& sensors, double dt, StateFrame& out) noexcept {
  flags_ = lasting_flags_;
  advance(sensors, began_ ? dt : 0);
  began_ = true;
  fill(out);
}

void Estimator::advance(const SensorFrame& sensors, double dt) noexcept {
  read(sensors, dt);
  if (restart_pending_) {
    restart_pending_ = false;
    const double speed = (sides_[kLeft].speed.speed() + sides_[kRight].speed.speed()) / 2;
    const double rate = geometry_.turn(sides_[kLeft].speed.speed(), sides_[kRight].speed.speed());
    auto& p = filter_.covariance;
    const double moved = square(kRestartPosition) + square(speed * dt);
    p(Filter::kPosition, Filter::kPosition) += moved;
    p(Filter::kPosition + 1, Filter::kPosition + 1) += moved;
    p(Filter::kOrientation + 2, Filter::kOrientation + 2) += square(kRestartYaw) + square(rate * dt);
    slip_.begin(filter_);
  } else if (dt > 0) {
    follow_wheels();
    if (resting_) {
      rest(dt);
    } else {
      move(dt);
    }
  }
  if (pose_pending_) {
    place(*pose_pending_);
    pose_pending_.reset();
    slip_.begin(filter_);
  }
}

void Estimator::read(const SensorFrame& sensors, double dt) noexcept {
  imu_.step(sensors, base_from_imu_, dt);
  if (imu_.refused()) flags_ |= kStateBadSample;
  if (!imu_.gyro()) flags_ |= kStateNoGyro;
  if (!imu_.accelerometer()) flags_ |= kStateNoAccelerometer;
  constexpr std::uint64_t kLost[2] = {kStateNoLeftEncoder, kStateNoRightEncoder};
  for (const int i : {kLeft, kRight}) {
    Side& side = sides_[static_cast<std::size_t>(i)];
    const EncoderReading reading = side.encoder.step(sensors, dt);
    if (reading == EncoderReading::kRejected) flags_ |= kStateBadSample;
    if (!side.encoder.heard()) flags_ |= kLost[i];
    side.total += side.encoder.travel();
    if (reading == EncoderReading::kTravel && side.encoder.time() > 0) {
      side.speed.step(side.encoder.travel(), side.encoder.time());
    }
    if (reading == EncoderReading::kLost) {
      side.ahead = 0;
      filter_.anchor_travel(i, side.total);
      filter_.doubt_velocity(0, kRestartPosition / std::max(side.encoder.time(), period_),
                             std::max(side.encoder.time(), period_));
      slip_.begin(filter_);
    }
  }
}

/// Raw odometry: whatever either side has travelled since it was last heard.
void Estimator::follow_wheels() noexcept {
  const double left = sides_[kLeft].encoder.travel();
  const double right = sides_[kRight].encoder.travel();
  const double distance = (left + right) / 2;
  const Motion motion = geometry_.base_motion(distance, geometry_.turn(left, right));
  const Chord chord = chord_of(motion, wheels_.yaw);
  wheels_.x += chord.x;
  wheels_.y += chord.y;
  wheels_.yaw = std::remainder(wheels_.yaw + motion.turn, 2 * std::numbers::pi);
  const double speed = (sides_[kLeft].speed.speed() + sides_[kRight].speed.speed()) / 2;
  const double rate = geometry_.turn(sides_[kLeft].speed.speed(), sides_[kRight].speed.speed());
  const Motion velocity = geometry_.base_motion(speed, rate);
  wheels_.linear = velocity.forward;
  wheels_.angular = velocity.turn;
}

void Estimator::rest(double dt) noexcept {
  const double left = sides_[kLeft].encoder.travel();
  const double right = sides_[kRight].encoder.travel();
  held_.time += dt;
  held_.forward += (left + right) / 2;
  held_.wheel_turn += geometry_.turn(left, right);
  if (imu_.gyro()) {
    held_.turn += *imu_.gyro() * dt;
  } else {
    held_.gyro = false;
  }
  StandstillSample sample{.dt = dt, .left = left, .right = right, .gyro = {}, .accelerometer = {}};
  if (imu_.new_gyro()) sample.gyro = imu_.last_gyro();
  if (imu_.new_accelerometer()) sample.accelerometer = imu_.last_accelerometer();
  const WindowEnd window = standstill_.step(sample);
  if (window == WindowEnd::kOpen) return;
  if (window == WindowEnd::kQuiet && quiet()) {
    learn_at_rest();
    flags_ |= kStateStandstill;
    held_ = {};
    return;
  }
  end_rest();
}

void Estimator::end_rest() noexcept {
  resting_ = false;
  lasting_flags_ &= ~std::uint64_t{kStateStandstill};
  flags_ &= ~std::uint64_t{kStateStandstill};
  const Vector3d turn =
      held_.gyro ? Vector3d(held_.turn - held_.time * filter_.gyro_bias) : Vector3d(0, 0, held_.wheel_turn);
  filter_.position += filter_.rotation.col(0) * held_.forward;
  filter_.turn_by(turn);
  distance_ += std::abs(held_.forward);
  auto& p = filter_.covariance;
  p(Filter::kOrientation + 2, Filter::kOrientation + 2) += square(parameters_.gyro_noise) * held_.time;
  filter_.stand(kRestSpeed);
  for (const int i : {kLeft, kRight}) filter_.anchor_travel(i, sides_[static_cast<std::size_t>(i)].total);
  slip_.begin(filter_);
  held_ = {};
}

bool Estimator::quiet() const noexcept {
  const auto& p = filter_.covariance;
  if (standstill_.gyro()) {
    const double turned = geometry_.turn(standstill_.left(), standstill_.right()) / standstill_.time();
    const double noise = square(parameters_.gyro_noise) / standstill_.time();
    for (int i = 0; i < 3; ++i) {
      const double rate = (*standstill_.gyro())[i] - filter_.gyro_bias[i] - (i == 2 ? turned : 0);
      const double bias = p(Filter::kGyroBias + i, Filter::kGyroBias + i);
      if (std::abs(rate) > parameters_.standstill_speed + 3 * std::sqrt(bias + noise)) return false;
    }
  }
  return true;
}

bool Estimator::bias_changed() noexcept {
  const Vector3d& gyro = *standstill_.gyro();
  if (steady_time_ == 0 || (gyro - steady_gyro_).cwiseAbs().maxCoeff() > parameters_.standstill_speed) {
    steady_time_ = 0;
    steady_gyro_ = gyro;
  }
  steady_time_ += standstill_.time();
  if (steady_time_ < kSteadyTime) return false;
  steady_time_ = 0;
  for (int i = 0; i < 3; ++i) {
    const int index = Filter::kGyroBias + i;
    filter_.covariance(index, index) += square(gyro[i] - filter_.gyro_bias[i]);
  }
  return true;
}

void Estimator::learn_at_rest() noexcept {
  const double window = standstill_.time();
  rested_ += window;
  const Filter::Rest rest = rested_ <= kSettling ? Filter::Rest::kBegins : Filter::Rest::kGoesOn;
  lasting_flags_ |= kStateStandstill;
  filter_.age(window);
  if (standstill_.gyro()) {
    const double turned = geometry_.turn(standstill_.left(), standstill_.right()) / window;
    for (int i = 0; i < 3; ++i) {
      filter_.correct_gyro_at_rest(i, (*standstill_.gyro())[i] - (i == 2 ? turned : 0),
                                   square(parameters_.gyro_noise) / window, rest);
    }
  }
  if (standstill_.accelerometer()) {
    const double variance = square(parameters_.accelerometer_noise) / window + square(kAccelerometerAtRest);
    for (int i = 0; i < 3; ++i) {
      filter_.correct_accelerometer_at_rest(i, (*standstill_.accelerometer())[i], variance);
    }
  }
}

void Estimator::move(double dt) noexcept {
  const double left_speed = sides_[kLeft].speed.speed();
  const double right_speed = sides_[kRight].speed.speed();
  Filter::Motion motion;
  motion.dt = dt;
  motion.gyro = imu_.gyro();
  motion.accelerometer = imu_.accelerometer();
  motion.left_travel = rolled(kLeft, dt);
  motion.right_travel = rolled(kRight, dt);
  motion.caution = slip_.caution();
  motion.sliding = !slip_.believed(Contact::kLeft) && !slip_.believed(Contact::kRight);
  motion.left_speed = left_speed;
  motion.right_speed = right_speed;
  filter_.predict(motion);
  if (imu_.gyro_catches_up()) filter_.rate = (1 + filter_.gyro_scale) * (imu_.last_gyro() - filter_.gyro_bias);
  correct(dt);
  distance_ += std::abs(filter_.velocity.x()) * dt;

  constexpr double kSilent = std::numeric_limits<double>::quiet_NaN();
  if (parameters_.slip_detection) {
    const auto heard = [&](int side, double travel) {  // a reading that spans more than a window contradicts none
      const bool slow = sides_[static_cast<std::size_t>(side)].encoder.gap() > ImuSamples::kSlow;
      return slow || lost(side) ? kSilent : travel;
    };
    slip_.step({.dt = dt,
                .left = heard(kLeft, motion.left_travel),
                .right = heard(kRight, motion.right_travel),
                .inertial = motion.gyro.has_value() && motion.accelerometer.has_value()},
               filter_);
  }

  StandstillSample sample{
      .dt = dt, .left = motion.left_travel, .right = motion.right_travel, .gyro = {}, .accelerometer = {}};
  if (imu_.new_gyro()) sample.gyro = imu_.last_gyro();
  if (imu_.new_accelerometer()) sample.accelerometer = imu_.last_accelerometer();
  const WindowEnd window = standstill_.step(sample);
  if (lost(kLeft) || lost(kRight)) standstill_.reset();
  if (window == WindowEnd::kBroken || window == WindowEnd::kShaken) steady_time_ = 0;
  if (window != WindowEnd::kQuiet || !(quiet() || bias_changed())) return;
  if (standstill_.accelerometer()) {
    const Vector3d rest = *standstill_.accelerometer() - filter_.accelerometer_bias +
                          filter_.rotation.transpose() * Vector3d(0, 0, -Filter::kGravity);
    const Vector3d deviation = filter_.acceleration_deviation();
    const bool slides = std::abs(rest.x()) > kQuietAcceleration + 3 * deviation.x() ||
                        std::abs(rest.y()) > kQuietAcceleration + 3 * deviation.y();
    if (slides && ++doubtful_windows_ < kDoubtfulWindows) return;
  }
  doubtful_windows_ = 0;
  filter_.halt(kRestSpeed);
  rested_ = 0;
  learn_at_rest();
  resting_ = true;
  held_ = {};
  for (Side& side : sides_) side.ahead = 0;
  flags_ |= kStateStandstill;
}

double Estimator::rolled(int index, double dt) noexcept {
  Side& side = sides_[static_cast<std::size_t>(index)];
  if (side.encoder.heard()) return side.encoder.travel() - std::exchange(side.ahead, 0);
  const double travel = (filter_.velocity.x() - filter_.rate.z() * filter_.lever(index)) * dt;
  side.ahead += travel;
  return travel;
}

bool Estimator::lost(int side) const noexcept {
  const SideEncoder& encoder = sides_[static_cast<std::size_t>(side)].encoder;
  const double longest = static_cast<double>(kMaxHeld) * period_ * (1 + 1e-9);
  return !encoder.known() || encoder.waiting() > std::max(longest, 2 * encoder.gap());
}

void Estimator::correct(double dt) noexcept {
  for (const int side : {kLeft, kRight}) correct_side(side, dt);
  if (slip_.believed(Contact::kLateral)) {
    const auto [nis, used] = filter_.correct_lateral(dt);
    note(kLateralContact, nis, dt);
    if (!used) ++rejected_[kLateralContact];
  }
  if (slip_.believed(Contact::kVertical)) {
    const auto [nis, used] = filter_.correct_vertical(dt);
    note(kVerticalContact, nis, dt);
    if (!used) ++rejected_[kVerticalContact];
  }
  note(kGyro, slip_.turn_nis(), dt);
  note(kAccelerometer, slip_.travel_nis(), dt);
}

void Estimator::correct_side(int index, double dt) noexcept {
  Side& side = sides_[static_cast<std::size_t>(index)];
  const bool believed = slip_.believed(index == kLeft ? Contact::kLeft : Contact::kRight);
  if (believed && !side.believed) filter_.anchor_travel(index, side.total);
  side.believed = believed;
  if (!believed || !side.encoder.heard()) return;
  const auto [nis, used] = filter_.correct_travel(index, side.total);
  note(index == kLeft ? kLeftEncoder : kRightEncoder, nis, dt);
  side.refused = used ? 0 : side.refused + 1;
  if (used) return;
  ++rejected_[index == kLeft ? kLeftEncoder : kRightEncoder];
  if (side.refused < kMaxRefused) return;
  side.refused = 0;
  filter_.anchor_travel(index, side.total);
  filter_.doubt_velocity(0, std::abs(side.speed.speed() - filter_.velocity.x()) + kRestSpeed, dt);
}

void Estimator::note(SensorIndex sensor, double nis, double dt) noexcept {
  constexpr double kLargest = 1e6;
  if (std::isnan(nis)) return;  // a sensor it compares is lost
  double& smoothed = nis_[sensor];
  smoothed += dt / (kSmoothing + dt) * (std::min(nis, kLargest) - smoothed);
}

/// base_link at x, y, yaw; height and tilt stay. The covariance of what is set is zero.
void Estimator::place(const Vector3& pose) noexcept {
  const Matrix3d turn = about_z(pose[2] - yaw_of(filter_.rotation));
  const double z = filter_.position.z();
  filter_.rotation = turn * filter_.rotation;
  const Vector3d lever = filter_.rotation * filter_.geometry().imu_in_base;
  filter_.position = {pose[0] + lever.x(), pose[1] + lever.y(), z};
  auto& p = filter_.covariance;
  p.middleCols<3>(Filter::kOrientation) = (p.middleCols<3>(Filter::kOrientation) * turn.transpose()).eval();
  p.middleRows<3>(Filter::kOrientation) = (turn * p.middleRows<3>(Filter::kOrientation)).eval();
  // base_link and yaw are exact; what the tilt is in doubt by then moves θ_z and, on its lever, the IMU.
  const Vector3d h = filter_.rotation.col(0);
  const double level = std::max(h.x() * h.x() + h.y() * h.y(), 1e-6);
  const double a = h.z() * h.x() / level;
  const double b = h.z() * h.y() / level;
  constexpr int kPlaced[] = {Filter::kPosition, Filter::kPosition + 1, Filter::kPosition + 2, Filter::kOrientation + 2};
  const double by_tilt[][2] = {{-a * lever.y(), lever.z() - b * lever.y()},
                               {a * lever.x() - lever.z(), b * lever.x()},
                               {lever.y(), -lever.x()},
                               {a, b}};
  constexpr int x = Filter::kOrientation;
  for (int i = 0; i < 4; ++i) p.col(kPlaced[i]) = by_tilt[i][0] * p.col(x) + by_tilt[i][1] * p.col(x + 1);
  for (int i = 0; i < 4; ++i) p.row(kPlaced[i]) = by_tilt[i][0] * p.row(x) + by_tilt[i][1] * p.row(x + 1);
}

void Estimator::fill(StateFrame& out) const noexcept {
  fill_pose(out);
  fill_twist(out);
  fill_health(out);
}

void Estimator::fill_pose(StateFrame& out) const noexcept {
  const Matrix3d& r = filter_.rotation;
  const Vector3d lever = r * filter_.geometry().imu_in_base;
  const Vector3d base = filter_.position - lever;
  // δ(p − R r) = δp + [R r]× θ;  δyaw = θ_z − h_z (h_x θ_x + h_y θ_y) / (h_x² + h_y²), h = R e_x
  const auto& p = filter_.covariance;
  Eigen::Matrix<double, 6, 6> joint = p.topLeftCorner<6, 6>();
  Eigen::Matrix<double, 6, 6> by = Eigen::Matrix<double, 6, 6>::Identity();
  by.topRightCorner<3, 3>() = cross_matrix(lever);
  const Vector3d h = r.col(0);
  const double level = std::max(h.x() * h.x() + h.y() * h.y(), 1e-6);
  if (parameters_.planar) {
    by(5, 3) = -h.z() * h.x() / level;
    by(5, 4) = -h.z() * h.y() / level;
  }
  const Eigen::Matrix<double, 6, 6> covariance = by * joint * by.transpose();
  out.attitude = quaternion(r);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) out.attitude_covariance[static_cast<std::size_t>(3 * i + j)] = p(3 + i, 3 + j);
  }
  out.pose_covariance = {};
  if (!parameters_.planar) {
    out.pose_odom = {array(base), out.attitude};
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < 6; ++j) out.pose_covariance[static_cast<std::size_t>(6 * i + j)] = covariance(i, j);
    }
    return;
  }
  const double yaw = yaw_of(r);
  out.pose_odom.position = {base.x(), base.y(), 0};
  out.pose_odom.orientation = {0, 0, std::sin(yaw / 2), std::cos(yaw / 2)};
  for (const std::size_t i : {2U, 3U, 4U}) out.pose_covariance[7 * i] = kPlanarVariance;
  constexpr int kIndex[3] = {0, 1, 5};
  for (const int i : kIndex) {
    for (const int j : kIndex) out.pose_covariance[static_cast<std::size_t>(6 * i + j)] = covariance(i, j);
  }
}

void Estimator::fill_twist(StateFrame& out) const noexcept {
  const auto& p = filter_.covariance;
  const Vector3d& imu = filter_.geometry().imu_in_base;
  const Vector3d rate = filter_.rate;
  const Vector3d linear = filter_.velocity - rate.cross(imu);
  // δv = δu + (δbg + noise) × r;  δω = −δbg − noise
  Eigen::Matrix<double, 6, 6> joint;
  joint.topLeftCorner<3, 3>() = p.block<3, 3>(Filter::kVelocity, Filter::kVelocity);
  joint.topRightCorner<3, 3>() = p.block<3, 3>(Filter::kVelocity, Filter::kGyroBias);
  joint.bottomLeftCorner<3, 3>() = joint.topRightCorner<3, 3>().transpose();
  joint.bottomRightCorner<3, 3>() = p.block<3, 3>(Filter::kGyroBias, Filter::kGyroBias);
  const double speed = (sides_[kLeft].speed.speed() + sides_[kRight].speed.speed()) / 2;
  double yaw_noise = square(parameters_.gyro_noise) / (2 * period_);  // the rate is the mean of two samples
  if (resting_) yaw_noise = 0;
  if (!imu_.gyro()) {
    yaw_noise = 4 / square(geometry_.wheel_base) *
                (square(kSpeedDeviation) + square(parameters_.wheel_slip_noise) * parameters_.speed_bandwidth *
                                               (std::abs(speed) + std::abs(rate.z())));
    joint.bottomRightCorner<3, 3>().setZero();
    joint.topRightCorner<3, 3>().setZero();
    joint.bottomLeftCorner<3, 3>().setZero();
  }
  for (int i = 0; i < 3; ++i) joint(3 + i, 3 + i) += yaw_noise;
  Eigen::Matrix<double, 6, 6> by = Eigen::Matrix<double, 6, 6>::Zero();
  by.topLeftCorner<3, 3>().setIdentity();
  by.topRightCorner<3, 3>() = -cross_matrix(imu);
  by.bottomRightCorner<3, 3>() = -Matrix3d::Identity();
  const Eigen::Matrix<double, 6, 6> covariance = by * joint * by.transpose();
  out.twist_covariance = {};
  if (parameters_.planar) {
    out.twist_base = {{linear.x(), linear.y(), 0}, {0, 0, rate.z()}};
    for (const std::size_t i : {2U, 3U, 4U}) out.twist_covariance[7 * i] = kPlanarVariance;
    constexpr int kIndex[3] = {0, 1, 5};
    for (const int i : kIndex) {
      for (const int j : kIndex) out.twist_covariance[static_cast<std::size_t>(6 * i + j)] = covariance(i, j);
    }
    return;
  }
  out.twist_base = {array(linear), array(rate)};
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) out.twist_covariance[static_cast<std::size_t>(6 * i + j)] = covariance(i, j);
  }
}

void Estimator::fill_health(StateFrame& out) const noexcept {
  const auto& p = filter_.covariance;
  const auto deviation = [&](int index) { return std::sqrt(std::max(0.0, p(index, index))); };
  out.gyro_bias = array(base_from_imu_.transpose() * filter_.gyro_bias);
  out.accelerometer_bias = array(base_from_imu_.transpose() * filter_.accelerometer_bias);
  const Matrix3d bias =
      base_from_imu_.transpose() * p.block<3, 3>(Filter::kGyroBias, Filter::kGyroBias) * base_from_imu_;
  out.gyro_bias_deviation = array(bias.diagonal().cwiseMax(0).cwiseSqrt());
  out.calibration = {.radius_ratio = 1 + filter_.radius_ratio,
                     .wheel_base_factor = 1 + filter_.wheel_base,
                     .radius_ratio_deviation = deviation(Filter::kRadiusRatio),
                     .wheel_base_deviation = deviation(Filter::kWheelBase)};
  out.wheels = wheels_;
  out.nis = nis_;
  out.rejected = rejected_;
  out.slip = resting_ ? 0 : slip_.reasons();

  const auto confidence = [&](SensorIndex sensor, bool used) {
    out.confidence[sensor] = used ? 1 / std::max(1.0, out.nis[sensor]) : 0;
  };
  out.confidence = {};
  const bool left = sides_[kLeft].encoder.heard();
  const bool right = sides_[kRight].encoder.heard();
  confidence(kLeftEncoder, left && slip_.believed(Contact::kLeft));
  confidence(kRightEncoder, right && slip_.believed(Contact::kRight));
  confidence(kGyro, imu_.gyro().has_value());
  confidence(kAccelerometer, imu_.accelerometer().has_value());
  confidence(kLateralContact, slip_.believed(Contact::kLateral));
  confidence(kVerticalContact, slip_.believed(Contact::kVertical));

  out.flags = flags_;
  const int silent = (lost(kLeft) ? 1 : 0) + (lost(kRight) ? 1 : 0);
  if (silent == 0 || (silent == 1 && imu_.gyro())) out.flags |= kStateValid;
  if (resting_) out.flags |= lasting_flags_ & kStateStandstill;
  if (out.slip != 0) out.flags |= kStateSlip;
  out.distance = distance_;
  out.skipped = skipped_;
}

}  // namespace robot_control

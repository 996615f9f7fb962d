#include "estimation/estimator.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "estimation/estimator_setup.h"
#include "estimation/values.h"
#include "estimation/wheels/arc.h"
#include "signals/rotation.h"

namespace robot_control {
namespace {

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

}  // namespace

EstimatorState::EstimatorState(const EstimatorParameters& parameters, const RobotModel& robot, double period)
    : wheels_(robot, parameters.speed_bandwidth, period, std::sqrt(12.0) * encoder_deviation(parameters, robot)),
      core_(core_params(parameters, robot)),
      tilt_(tilt_params(parameters)),
      gyro_noise_(parameters.gyro_noise),
      rate_(parameters.rate_bandwidth, period),
      wheel_velocities_(robot, parameters.speed_bandwidth, period),
      slip_detector_(slip_params(parameters, robot)),
      watch_(rest_params(parameters, robot)) {}

Estimator::Estimator(const EstimatorParameters& parameters, const RobotModel& robot, double period)
    : EstimatorState(checked(parameters, robot, period), robot, period),
      parameters_(parameters),
      period_(period),
      geometry_(robot),
      base_from_imu_(rotation_of(robot.imu_in_base.orientation)),
      encoder_(encoder_deviation(parameters, robot)),
      rate_noise_gain_(rate_.noise_gain()),
      drags_wheels_(drags_wheels(robot)),
      fresh_(*this) {
  const Vector3 bias = in_base(parameters.gyro_bias);
  for (const std::size_t i : {0U, 1U}) gyro_bias_[i] = {bias[i], square(parameters.gyro_bias_initial)};
  core_.set_bias(bias[2], parameters.gyro_bias_initial);
  core_.set_calibration(parameters.calibration);
  core_.set_bias_known(false);
  place({0, 0, 0});
  fresh_ = *this;
}

Vector3 Estimator::in_base(const Vector3& imu) const noexcept {
  return array(base_from_imu_ * Eigen::Vector3d(imu.data()));
}

Eigen::Vector3d Estimator::gyro_bias() const noexcept {
  return {gyro_bias_[0].value, gyro_bias_[1].value, core_.bias()};
}

Eigen::Vector3d Estimator::gyro_bias_variance() const noexcept {
  return {gyro_bias_[0].variance, gyro_bias_[1].variance, core_.bias_variance()};
}

void Estimator::resume(const StateFrame& last) noexcept {
  enter_run();
  if (!continuable(last)) return;
  const Vector3 bias = in_base(last.gyro_bias);
  const Vector3 force = in_base(last.accelerometer_bias);
  const Eigen::Vector3d deviation(last.gyro_bias_deviation.data());
  const Eigen::Vector3d variance = base_from_imu_.cwiseAbs2() * deviation.cwiseAbs2();
  for (const std::size_t i : {0U, 1U}) gyro_bias_[i] = {bias[i], variance[static_cast<int>(i)]};
  core_.set_bias(bias[2], std::sqrt(variance[2]));
  core_.set_calibration(last.calibration);
  tilt_.set(array(rotation_of(last.attitude).row(2)), {force[0], force[1]});
  height_ = last.pose_odom.position[2];
  place({last.pose_odom.position[0], last.pose_odom.position[1], yaw_of(last.pose_odom.orientation)});
  core_.set_pose_covariance(covariance_of_middle(last));
  core_.set_bias_known(true);
  yaw_rate_ = last.twist_base.angular[2];
  wheels_.set_speed(last.twist_base.linear[0] - yaw_rate_ * geometry_.axle_y, yaw_rate_);
  wheel_odometry_ = last.wheels;
  distance_ = last.distance;
  rejected_ = last.rejected;
  skipped_ = last.skipped;
  cycle_ = last.head.cycle;
  rested_ = moved_ = true;
  began_ = restart_pending_ = true;
  resting_ = false;
  lasting_flags_ = kStateRestarted;
}

void Estimator::place(const Vector3& pose) noexcept {
  const Planar lever = axle(pose[2]);
  const Prediction ahead = prediction();
  core_.place({pose[0] + lever.x - ahead.distance * std::cos(pose[2]),
               pose[1] + lever.y - ahead.distance * std::sin(pose[2]), pose[2] - ahead.turn});
  comparison_ = {};
}

void Estimator::step(const SensorFrame& sensors, StateFrame& out) noexcept {
  const std::uint64_t cycle = sensors.head.cycle;
  if (began_ && cycle <= cycle_ && !restart_pending_) return fill(out);
  flags_ = lasting_flags_;
  std::uint64_t cycles = 0;
  if (!began_) {
    skipped_ = cycle;  // The run began before the first frame.
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
    core_.shift(0, 0, square(Tuning::kRestart) + square(wheels_.speed() * dt));
    core_.add_yaw_variance(square(Tuning::kRestart) + square(wheels_.rate() * dt));
  } else if (dt > 0) {
    integrate_wheels();
    if (wheels_.both_received()) wheels_.average_speed(std::abs(core_.offset()));
    if (resting_) {
      rest(dt);
    } else {
      move(dt);
    }
  }
  follow_rate(dt);
  wheel_velocities_.step(sensors, dt);
  pose_set_ = std::exchange(pose_request_, std::nullopt);
  if (pose_set_) {
    place(*pose_set_);
    open_window_ = last_window_ = {};
    slip_detector_.begin_path();
  }
}

void Estimator::read(const SensorFrame& sensors, double dt) noexcept {
  imu_.step(sensors, base_from_imu_, dt);
  const WheelSides::Readings readings = wheels_.step(sensors, dt);
  if (imu_.refused() || readings.refused) flags_ |= kStateBadSample;
  if (!imu_.gyro()) flags_ |= kStateNoGyro;
  if (!imu_.accelerometer()) flags_ |= kStateNoAccelerometer;
  if (!wheels_.received(kLeft)) flags_ |= kStateNoLeftEncoder;
  if (!wheels_.received(kRight)) flags_ |= kStateNoRightEncoder;
  if (readings.restarted) comparison_ = {};
  if (readings.lost_travels == 0) return;
  core_.shift(0, 0, readings.lost_travels * square(Tuning::kRestart));
  end_slide();
}

/// Raw odometry integrates the travel of either side since its last reading.
void Estimator::integrate_wheels() noexcept {
  const Motion motion = geometry_.base_motion(wheels_.mean(), wheels_.turned());
  const Planar chord = chord_of(motion, wheel_odometry_.yaw);
  wheel_odometry_.x += chord.x;
  wheel_odometry_.y += chord.y;
  wheel_odometry_.yaw = std::remainder(wheel_odometry_.yaw + motion.turn, 2 * std::numbers::pi);
  const Motion velocity = geometry_.base_motion(wheels_.speed(), wheels_.rate());
  wheel_odometry_.linear = velocity.forward;
  wheel_odometry_.angular = velocity.turn;
}

void Estimator::follow_rate(double dt) noexcept {
  const bool smooth = !resting_ && imu_.gyro();
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();
  if (smooth) {
    rate = imu_.gyro_rate() - gyro_bias();
  } else if (!resting_) {
    rate.z() = yaw_rate_;
  }
  rate_.follow(rate, smooth, dt);
}

/// Predicts the motion since the readings that the core has used. A positive clock offset means that the wheels are
/// late, a negative one that the gyro is late. A side without a reading in this step is predicted by its speed.
Estimator::Prediction Estimator::prediction() const noexcept {
  if (resting_) return {};
  Prediction ahead;
  if (core_.offset() > 0) {
    const double speed = wheels_.any_lost() ? forward_speed() : wheels_.recent_speed() - slide_.excess_speed();
    ahead.distance = speed * core_.offset();
  } else {
    ahead.turn = -yaw_rate_ * core_.offset();
  }
  ahead.distance += wheels_.unread_distance(kLeft);
  ahead.distance += wheels_.unread_distance(kRight);
  return ahead;
}

double Estimator::forward_speed() const noexcept {
  return resting_ ? 0 : wheels_.speed_at(rate_.rate().z()) - slide_.excess_speed();
}

}  // namespace robot_control

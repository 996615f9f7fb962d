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

void calibrate(const WheelCalibration& known, PlanarCore& core) noexcept {
  core.set_calibration(known.radius_ratio - 1, known.radius_ratio_deviation, known.wheel_base_factor - 1,
                       known.wheel_base_deviation);
}

}  // namespace

Estimator::Estimator(const EstimatorParameters& parameters, const RobotModel& robot, double period)
    : parameters_(checked(parameters, robot, period)),
      period_(period),
      geometry_(robot),
      base_from_imu_(rotation_of(robot.imu_in_base.orientation)),
      encoder_(encoder_deviation(parameters, robot)),
      fresh_core_(core_params(parameters, robot)),
      fresh_tilt_(tilt_params(parameters)),
      fresh_slip_(slip_params(parameters, robot)),
      rate_(parameters.rate_bandwidth, period),
      rate_noise_gain_(rate_.noise_gain()),
      wheel_velocities_(robot, parameters.speed_bandwidth, period),
      sides_{Side{SideEncoder(robot, robot_control::Side::kLeft), SpeedTracker(parameters.speed_bandwidth, period)},
             Side{SideEncoder(robot, robot_control::Side::kRight), SpeedTracker(parameters.speed_bandwidth, period)}},
      watch_(rest_params(parameters, robot)),
      gyro_noise_(parameters.gyro_noise) {
  const Vector3 bias = in_base(parameters.gyro_bias);
  fresh_core_.set_bias(bias[2], parameters.gyro_bias_initial);
  calibrate(parameters.calibration, fresh_core_);
  enter_run();
}

Vector3 Estimator::in_base(const Vector3& imu) const noexcept {
  return array(base_from_imu_ * Eigen::Vector3d(imu.data()));
}

void Estimator::enter_run() noexcept {
  core_ = fresh_core_;
  core_.hold_corrections(true);
  tilt_ = fresh_tilt_;
  slip_ = fresh_slip_;
  slip_.restart();
  slide_.reset();
  watch_.reset();
  gyro_noise_ = GyroNoise(parameters_.gyro_noise);
  imu_.reset();
  const Vector3 bias = in_base(parameters_.gyro_bias);
  gyro_bias_ = {bias[0], bias[1]};
  gyro_variance_.fill(square(parameters_.gyro_bias_initial));
  gyro_learned_ = rested_once_ = moved_ = false;
  for (Side& side : sides_) {
    side.encoder.reset();
    side.speed.reset(0);
    side.turned = side.credited = 0;
  }
  rate_.reset(Eigen::Vector3d::Zero());
  wheel_velocities_.reset();
  height_ = own_yaw_ = 0;
  block_ = {};
  jitter_.reset();
  recent_ = {};
  usual_gap_ = last_sample_ = silence_ = silent_turn_ = turning_ = 0;
  rate_follows_ = false;
  resting_ = true;
  held_ = kept_ = {};
  distrusted_windows_ = 0;
  wheels_ = {};
  distance_ = shortened_ = 0;
  nis_ = {};
  rejected_ = {};
  began_ = restart_pending_ = false;
  pose_pending_.reset();
  placed_.reset();
  cycle_ = skipped_ = 0;
  flags_ = lasting_flags_ = 0;
  place({0, 0, 0});
}

void Estimator::resume(const StateFrame& last) noexcept {
  enter_run();
  if (!continuable(last)) return;
  const Vector3 bias = in_base(last.gyro_bias);
  const Vector3 force = in_base(last.accelerometer_bias);
  const Eigen::Vector3d up = rotation_of(last.attitude).row(2);
  const Eigen::Vector3d deviation(last.gyro_bias_deviation.data());
  const Eigen::Vector3d variance = base_from_imu_.cwiseAbs2() * deviation.cwiseAbs2();
  core_.set_bias(bias[2], std::sqrt(variance[2]));
  gyro_bias_ = {bias[0], bias[1]};
  gyro_variance_ = {variance[0], variance[1]};
  calibrate(last.calibration, core_);
  tilt_.set(array(up), {force[0], force[1]});
  height_ = last.pose_odom.position[2];
  place({last.pose_odom.position[0], last.pose_odom.position[1], yaw_of(last.pose_odom.orientation)});
  core_.set_pose_covariance(of_middle(last));
  const double turn = last.twist_base.angular[2] * geometry_.wheel_base / 2;
  const double speed = last.twist_base.linear[0] - last.twist_base.angular[2] * geometry_.axle_y;
  sides_[kLeft].speed.reset(speed - turn);
  sides_[kRight].speed.reset(speed + turn);
  turning_ = last.twist_base.angular[2];
  wheels_ = last.wheels;
  distance_ = last.distance;
  rejected_ = last.rejected;
  skipped_ = last.skipped;
  cycle_ = last.head.cycle;
  rested_once_ = moved_ = true;
  core_.replace_bias();
  core_.hold_corrections(false);
  began_ = restart_pending_ = true;
  resting_ = false;
  lasting_flags_ = kStateRestarted;
}

void Estimator::place(const Vector3& pose) noexcept {
  const Planar lever = axle(pose[2]);
  const Lead lead = ahead();
  core_.place({pose[0] + lever.x - lead.distance * std::cos(pose[2]),
               pose[1] + lever.y - lead.distance * std::sin(pose[2]), pose[2] - lead.turn});
  block_ = {};
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
    core_.shift(0, 0, square(kRestartPosition) + square(wheel_speed() * dt));
    core_.add_yaw_variance(square(kRestartYaw) + square(wheel_rate() * dt));
  } else if (dt > 0) {
    follow_wheels();
    if (both_read()) {
      const SideEncoder& left = sides_[kLeft].encoder;
      recent_.add((left.travel() + sides_[kRight].encoder.travel()) / 2, left.time(),
                  std::max(std::abs(core_.offset()), left.gap()));
    }
    slide_.age(dt);
    if (resting_) {
      rest(dt);
    } else {
      move(dt);
    }
  }
  follow_rate(dt);
  wheel_velocities_.step(sensors, dt);
  placed_ = std::exchange(pose_pending_, std::nullopt);
  if (placed_) {
    place(*placed_);
    held_ = kept_ = {};
    shortened_ = 0;
    slip_.begin_path();
    slide_.begin_path(slip_);
  }
}

/// rad/s, bias included: in the step that makes up for the time since the last sample, the sample alone.
const Eigen::Vector3d& Estimator::gyro_now() const noexcept {
  return imu_.gyro_catches_up() ? imu_.last_gyro() : *imu_.gyro();
}

/// At rest, in the first step of a motion and without a gyro there is nothing to smooth.
void Estimator::follow_rate(double dt) noexcept {
  const bool follows = !resting_ && imu_.gyro();
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();
  if (follows) {
    rate = gyro_now() - Eigen::Vector3d(gyro_bias_[0], gyro_bias_[1], core_.bias());
  } else if (!resting_) {
    rate.z() = turning_;
  }
  if (follows && rate_follows_ && dt > 0) {
    rate_.step(rate, dt);
  } else if (!(follows && rate_follows_)) {
    rate_.reset(rate);
  }
  rate_follows_ = follows;
}

void Estimator::read(const SensorFrame& sensors, double dt) noexcept {
  imu_.step(sensors, base_from_imu_, dt);
  if (imu_.refused()) flags_ |= kStateBadSample;
  if (!imu_.gyro()) flags_ |= kStateNoGyro;
  if (!imu_.accelerometer()) flags_ |= kStateNoAccelerometer;
  constexpr std::uint64_t kLost[2] = {kStateNoLeftEncoder, kStateNoRightEncoder};
  for (const std::size_t i : {kLeft, kRight}) {
    Side& side = sides_[i];
    const EncoderReading reading = side.encoder.step(sensors, dt);
    if (reading == EncoderReading::kRejected) flags_ |= kStateBadSample;
    if (!side.encoder.received()) flags_ |= kLost[i];
    if (reading == EncoderReading::kTravel && side.encoder.time() > 0) {
      side.speed.step(side.encoder.travel(), side.encoder.time());
    }
    if (reading == EncoderReading::kTravel && i == kLeft) jitter_.add(side.encoder.time());
    if (reading == EncoderReading::kOffset || reading == EncoderReading::kLost) block_ = {};
    if (reading == EncoderReading::kLost) {
      side.credited = 0;
      core_.shift(0, 0, square(kRestartPosition));
      slip_.restart();
      slide_.end();
    }
  }
}

double Estimator::wheel_speed() const noexcept {
  return (sides_[kLeft].speed.speed() + sides_[kRight].speed.speed()) / 2;
}

double Estimator::wheel_rate() const noexcept {
  return geometry_.turn(sides_[kLeft].speed.speed(), sides_[kRight].speed.speed());
}

/// What the wheels rolled since their readings, which are late by the clock offset, and what the robot turned since the
/// gyro's where that is the late one.
Estimator::Lead Estimator::ahead() const noexcept {
  if (resting_) return {};
  Lead lead;
  if (core_.offset() > 0) {
    lead.speed = lost(kLeft) || lost(kRight) ? forward_speed() : recent_.speed() - slide_.excess();
  } else {
    lead.rate = -turning_;
  }
  lead.turn = lead.rate * core_.offset();
  lead.distance = lead.speed * core_.offset();
  for (const std::size_t i : {kLeft, kRight}) {
    const Side& side = sides_[i];
    if (side.encoder.received() || (lost(i) && !lost(1 - i))) continue;  // the other side rolls for it
    lead.distance +=
        side.speed.speed() *
        std::min(side.encoder.waiting(), std::max(side.encoder.gap(), static_cast<double>(kMaxHeld) * period_)) / 2;
  }
  return lead;
}

/// Of the middle of the wheels.
double Estimator::forward_speed() const noexcept {
  if (resting_) return 0;
  if (lost(kLeft) != lost(kRight)) {
    const std::size_t side = lost(kLeft) ? kRight : kLeft;
    return sides_[side].speed.speed() + (side == kLeft ? 1 : -1) * rate_.rate().z() * geometry_.wheel_base / 2;
  }
  return wheel_speed() - slide_.excess();
}

bool Estimator::lost(std::size_t side) const noexcept {
  const SideEncoder& encoder = sides_[side].encoder;
  const double longest = static_cast<double>(kMaxHeld) * period_ * (1 + 1e-9);
  return !encoder.known() || encoder.waiting() > std::max(longest, 2 * encoder.gap());
}

bool Estimator::both_read() const noexcept {
  return sides_[kLeft].encoder.received() && sides_[kRight].encoder.received();
}

/// Raw odometry: the travel of either side since its last reading.
void Estimator::follow_wheels() noexcept {
  const double left = sides_[kLeft].encoder.travel();
  const double right = sides_[kRight].encoder.travel();
  const Motion motion = geometry_.base_motion((left + right) / 2, geometry_.turn(left, right));
  const Chord chord = chord_of(motion, wheels_.yaw);
  wheels_.x += chord.x;
  wheels_.y += chord.y;
  wheels_.yaw = std::remainder(wheels_.yaw + motion.turn, 2 * std::numbers::pi);
  const Motion velocity = geometry_.base_motion(wheel_speed(), wheel_rate());
  wheels_.linear = velocity.forward;
  wheels_.angular = velocity.turn;
}

}  // namespace robot_control

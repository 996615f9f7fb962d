#include "estimation/estimator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "estimation/estimator_setup.h"
#include "estimation/filter/algebra.h"
#include "estimation/filter/placing.h"

namespace robot_control {
namespace {

using namespace algebra;
using Eigen::Vector3d;
using Filter = ErrorStateFilter;

constexpr double kQuietAcceleration = 0.1;  // m/s², mean at rest beside what is expected: sliding slower is no slide
constexpr std::uint64_t kDistrustedWindows = 8;  // then the velocity was wrong, not the window
constexpr double kSpeedDeviation = 0.005;        // m/s, encoder counts behind the tracking loop

}  // namespace

Estimator::Estimator(const EstimatorParameters& parameters, const RobotModel& robot, double period)
    : parameters_(checked(parameters, robot, period)),
      period_(period),
      geometry_(robot),
      base_from_imu_(rotation_of(robot.imu_in_base.orientation)),
      filter_(contact_geometry(geometry_, robot, parameters.tyre_creep), filter_noise(parameters, robot),
              filter_prior(parameters)),
      standstill_(standstill_limits(parameters, robot)),
      rate_(parameters.rate_bandwidth, period),
      rate_noise_gain_(rate_.noise_gain()),
      wheel_velocities_(robot, parameters.speed_bandwidth, period),
      sides_{Side{SideEncoder(robot, robot_control::Side::kLeft), SpeedTracker(parameters.speed_bandwidth, period)},
             Side{SideEncoder(robot, robot_control::Side::kRight), SpeedTracker(parameters.speed_bandwidth, period)}},
      simple_(simple_part(parameters, robot), geometry_) {
  reset();
}

void Estimator::reset() noexcept {
  filter_.reset();
  filter_.radius_ratio = parameters_.calibration.radius_ratio - 1;
  filter_.wheel_base = parameters_.calibration.wheel_base_factor - 1;
  filter_.gyro_bias = base_from_imu_ * vector(parameters_.gyro_bias);
  place({0, 0, 0}, filter_);
  slip_.reset();
  standstill_.reset();
  imu_.reset();
  for (Side& side : sides_) {
    side.encoder.reset();
    side.speed.reset(0);
    side.total = 0;
    side.ahead = 0;
    side.refused = 0;
    side.trusted = true;
  }
  rate_.reset(Eigen::Vector3d::Zero());
  rate_follows_ = false;
  wheel_velocities_.reset();
  simple_.reset();
  supervision_.reset();
  place_simply();
  resting_ = true;
  held_ = {};
  steady_time_ = 0;
  distrusted_windows_ = 0;
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
  continue_from(last, base_from_imu_, filter_);
  if (!parameters_.self_calibration) {
    for (const int held : {Filter::kRadiusRatio, Filter::kWheelBase}) filter_.covariance(held, held) = 0;
  }
  const double turn = last.twist_base.angular[2] * geometry_.wheel_base / 2;
  const double speed = last.twist_base.linear[0] - last.twist_base.angular[2] * geometry_.axle_y;
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
    auto& p = filter_.covariance;
    const double moved = square(kRestartPosition) + square(wheel_speed() * dt);
    p(Filter::kPosition, Filter::kPosition) += moved;
    p(Filter::kPosition + 1, Filter::kPosition + 1) += moved;
    p(Filter::kOrientation + 2, Filter::kOrientation + 2) += square(kRestartYaw) + square(wheel_rate() * dt);
    slip_.begin(filter_);
    place_simply();
  } else if (dt > 0) {
    follow_wheels();
    if (resting_) {
      rest(dt);
    } else {
      move(dt);
    }
    follow_simply(dt);
    if (parameters_.slip_detection) supervise(dt);
  }
  follow_rate(dt);
  wheel_velocities_.step(sensors, dt);
  if (pose_pending_) {
    place(*pose_pending_, filter_);
    held_ = {};
    pose_pending_.reset();
    slip_.renew(filter_);
    place_simply();
  }
}

/// At rest, in the first step of a motion and without a gyro there is nothing to smooth.
void Estimator::follow_rate(double dt) noexcept {
  const bool follows = !resting_ && imu_.gyro();
  if (follows && rate_follows_ && dt > 0) {
    rate_.step(filter_.rate, dt);
  } else if (!(follows && rate_follows_)) {
    rate_.reset(filter_.rate);
  }
  rate_follows_ = follows;
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
    if (!side.encoder.received()) flags_ |= kLost[i];
    side.total += side.encoder.travel();
    if (reading == EncoderReading::kTravel && side.encoder.time() > 0) {
      side.speed.step(side.encoder.travel(), side.encoder.time());
    }
    if (reading == EncoderReading::kOffset) {  // first reading: in mid-run, perhaps
      side.ahead = 0;
      filter_.anchor_travel(i, side.total);
    }
    if (reading == EncoderReading::kLost) {
      side.ahead = 0;
      filter_.anchor_travel(i, side.total);
      filter_.inflate_velocity(0, kRestartPosition / std::max(side.encoder.time(), period_),
                               std::max(side.encoder.time(), period_));
      slip_.begin(filter_);
    }
  }
}

double Estimator::wheel_speed() const noexcept {
  return (sides_[kLeft].speed.speed() + sides_[kRight].speed.speed()) / 2;
}

double Estimator::wheel_rate() const noexcept {
  return geometry_.turn(sides_[kLeft].speed.speed(), sides_[kRight].speed.speed());
}

/// Raw odometry: the travel of either side since its last reading.
void Estimator::follow_wheels() noexcept {
  const double left = sides_[kLeft].encoder.travel();
  const double right = sides_[kRight].encoder.travel();
  const double distance = (left + right) / 2;
  const Motion motion = geometry_.base_motion(distance, geometry_.turn(left, right));
  const Chord chord = chord_of(motion, wheels_.yaw);
  wheels_.x += chord.x;
  wheels_.y += chord.y;
  wheels_.yaw = std::remainder(wheels_.yaw + motion.turn, 2 * std::numbers::pi);
  const Motion velocity = geometry_.base_motion(wheel_speed(), wheel_rate());
  wheels_.linear = velocity.forward;
  wheels_.angular = velocity.turn;
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
  motion.slip_proximity = slip_.slip_proximity();
  motion.sliding = !slip_.trusts(Contact::kLeft) && !slip_.trusts(Contact::kRight);
  motion.left_speed = left_speed;
  motion.right_speed = right_speed;
  filter_.predict(motion);
  if (imu_.gyro_catches_up()) filter_.rate = (1 + filter_.gyro_scale) * (imu_.last_gyro() - filter_.gyro_bias);
  correct(dt);
  distance_ += std::abs(filter_.velocity.x()) * dt;

  constexpr double kSilent = std::numeric_limits<double>::quiet_NaN();
  if (parameters_.slip_detection) {
    const auto received = [&](int side, double travel) {  // a reading that spans more than a window contradicts none
      const bool slow = sides_[static_cast<std::size_t>(side)].encoder.gap() > ImuSamples::kSlow;
      return slow || lost(side) ? kSilent : travel;
    };
    slip_.step({.dt = dt,
                .left = received(kLeft, motion.left_travel),
                .right = received(kRight, motion.right_travel),
                .inertial = motion.gyro.has_value() && motion.accelerometer.has_value()},
               filter_);
  }

  const WindowEnd window = watch_rest(dt, motion.left_travel, motion.right_travel);
  if (lost(kLeft) || lost(kRight)) standstill_.reset();
  if (window == WindowEnd::kBroken || window == WindowEnd::kShaken) steady_time_ = 0;
  if (window != WindowEnd::kQuiet || !(quiet() || bias_changed())) return;
  if (standstill_.accelerometer()) {
    const Vector3d rest = *standstill_.accelerometer() - filter_.accelerometer_bias +
                          filter_.rotation.transpose() * Vector3d(0, 0, -Filter::kGravity);
    const Vector3d deviation = filter_.acceleration_deviation();
    const bool slides = std::abs(rest.x()) > kQuietAcceleration + 3 * deviation.x() ||
                        std::abs(rest.y()) > kQuietAcceleration + 3 * deviation.y();
    if (slides && ++distrusted_windows_ < kDistrustedWindows) return;
  }
  distrusted_windows_ = 0;
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
  if (side.encoder.received()) return side.encoder.travel() - std::exchange(side.ahead, 0);
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
  if (slip_.trusts(Contact::kLateral)) {
    const auto [nis, used] = filter_.correct_lateral(dt);
    note(kLateralContact, nis, dt);
    if (!used) ++rejected_[kLateralContact];
  }
  if (slip_.trusts(Contact::kVertical)) {
    const auto [nis, used] = filter_.correct_vertical(dt);
    note(kVerticalContact, nis, dt);
    if (!used) ++rejected_[kVerticalContact];
  }
  note(kGyro, slip_.turn_nis(), dt);
  note(kAccelerometer, slip_.travel_nis(), dt);
}

void Estimator::correct_side(int index, double dt) noexcept {
  Side& side = sides_[static_cast<std::size_t>(index)];
  const bool trusted = slip_.trusts(index == kLeft ? Contact::kLeft : Contact::kRight);
  if (trusted && !side.trusted) filter_.anchor_travel(index, side.total);
  side.trusted = trusted;
  if (!trusted || !side.encoder.received()) return;
  const auto [nis, used] =
      filter_.correct_travel(index, side.total, slip_.no_recent_slip() ? Filter::Scope::kAll : Filter::Scope::kMotion);
  note(index == kLeft ? kLeftEncoder : kRightEncoder, nis, dt);
  side.refused = used ? 0 : side.refused + 1;
  if (used) return;
  ++rejected_[index == kLeft ? kLeftEncoder : kRightEncoder];
  if (side.refused < kMaxRefused) return;
  side.refused = 0;
  filter_.anchor_travel(index, side.total);
  filter_.inflate_velocity(0, std::abs(side.speed.speed() - filter_.velocity.x()) + kRestSpeed, dt);
}

void Estimator::note(SensorIndex sensor, double nis, double dt) noexcept {
  constexpr double kLargest = 1e6;
  if (std::isnan(nis)) return;  // a sensor it compares is lost
  double& smoothed = nis_[sensor];
  smoothed += dt / (kSmoothing + dt) * (std::min(nis, kLargest) - smoothed);
}

void Estimator::fill(StateFrame& out) const noexcept {
  write_pose(filter_, parameters_.planar, out);
  write_twist(filter_, rate_.rate(), rate_noise(), parameters_.planar, out);
  write_learned(filter_, base_from_imu_, out);
  fill_health(out);
  if (supervision_.degraded()) fill_simply(out);
}

RateNoise Estimator::rate_noise() const noexcept {
  if (!imu_.gyro()) {
    const double slip = square(parameters_.wheel_slip_noise) * parameters_.speed_bandwidth *
                        (std::abs(wheel_speed()) + std::abs(filter_.rate.z()));
    const double variance = 4 / square(geometry_.wheel_base) * (square(kSpeedDeviation) + slip);
    return {.variance = variance, .tracked = variance, .gyro = false};
  }
  if (resting_) return {};
  const double sample = square(parameters_.gyro_noise) / period_;  // the filter's rate is the mean of two
  return {.variance = sample / 2, .tracked = rate_noise_gain_ * sample};
}

void Estimator::fill_health(StateFrame& out) const noexcept {
  out.wheels = wheels_;
  wheel_velocities_.write(out.wheel_velocity);
  out.nis = nis_;
  out.rejected = rejected_;
  out.slip = resting_ ? 0 : slip_.reasons();

  const auto confidence = [&](SensorIndex sensor, bool used) {
    out.confidence[sensor] = used ? 1 / std::max(1.0, out.nis[sensor]) : 0;
  };
  out.confidence = {};
  const bool left = sides_[kLeft].encoder.received();
  const bool right = sides_[kRight].encoder.received();
  confidence(kLeftEncoder, left && slip_.trusts(Contact::kLeft));
  confidence(kRightEncoder, right && slip_.trusts(Contact::kRight));
  confidence(kGyro, imu_.gyro().has_value());
  confidence(kAccelerometer, imu_.accelerometer().has_value());
  confidence(kLateralContact, slip_.trusts(Contact::kLateral));
  confidence(kVerticalContact, slip_.trusts(Contact::kVertical));

  out.flags = flags_;
  const int silent = (lost(kLeft) ? 1 : 0) + (lost(kRight) ? 1 : 0);
  if (silent == 0 || (silent == 1 && imu_.gyro())) out.flags |= kStateValid;
  if (resting_) out.flags |= lasting_flags_ & kStateStandstill;
  if (out.slip != 0) out.flags |= kStateSlip;
  out.degraded = 0;
  out.residual_level = simple_.slip().level();
  out.distance = distance_;
  out.skipped = skipped_;
}

}  // namespace robot_control

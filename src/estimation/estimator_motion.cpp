// The estimator in motion: the gyro turns, the wheels move, slip is watched and the calibration is learned.

#include <algorithm>
#include <cmath>

#include "estimation/estimator.h"
#include "estimation/values.h"
#include "robot/gravity.h"

namespace robot_control {

void Estimator::move(double dt) noexcept {
  const double turned = turn(dt);
  wheels_.turn(turned);
  uncorrected_step_ = {};
  for (const WheelSides::Travel& travel : wheels_.take_travels(core_.ratio())) advance_path(travel);
  if (wheels_.both_received()) core_.shift(0, 0, wheels_.quantum().travel_variance() / 2);
  tilt_.roll(wheels_.turned());
  if (imu_.gyro()) turn_tilt(*imu_.gyro(), dt);
  if (parameters_.slip_detection) watch_slip(dt, turned);
  compare_turns(dt);
  const RestWindow window = watch_rest(dt);
  if (wheels_.any_lost()) {
    watch_.reset();
  } else if (window == RestWindow::kQuiet) {
    begin_rest();
  }
}

/// `gyro` is in rad/s and includes the bias.
void Estimator::turn_tilt(const Eigen::Vector3d& gyro, double dt) noexcept {
  Eigen::Vector3d rate = gyro - gyro_bias();
  if (!bias_measured_) rate.head<2>().setZero();
  tilt_.turn(array(rate), dt, bias_measured_);
}

/// Turns the heading and returns the angle in rad, without the bias.
double Estimator::turn(double dt) noexcept {
  const double before = core_.pose().yaw;
  const double wheel_turn = core_.wheel_turn(wheels_.left(), wheels_.right());
  if (const std::optional<double> angle = gyro_turn_.step(imu_, wheel_turn, core_.bias(), dt)) {
    core_.turn_by_gyro(*angle, dt);
  } else {
    core_.turn_by_wheels(wheels_.left(), wheels_.right());
    comparison_ = {};
  }
  const double turned = core_.pose().yaw - before;
  yaw_rate_ = imu_.gyro() && !gyro_turn_.silent() ? imu_.gyro_rate().z() - core_.bias() : wheels_.rate();
  uncorrected_yaw_ += turned;
  return turned;
}

/// Returns by how much less the robot travels than its treads roll, along and to the left, in m. A tyre under force
/// creeps by tyre_creep times the specific force per distance (H. B. Pacejka, Tire and Vehicle Dynamics, 2012, chapter
/// 3, linear range). Gravity counts only beyond kSignificant deviations of the tilt.
std::array<double, 2> Estimator::tyres_creep(double distance) const noexcept {
  if (!imu_.accelerometer() || parameters_.tyre_creep == 0) return {};
  std::array<double, 2> creep = tilt_.acceleration(array(*imu_.accelerometer()));
  for (const int axis : {0, 1}) {
    const double sine = tilt_.up()[axis];
    const double uncertain = Tuning::kSignificant * std::sqrt(std::max(0.0, tilt_.covariance(axis, axis)));
    creep[axis] += kGravity * std::copysign(std::max(0.0, std::abs(sine) - uncertain), sine);
    creep[axis] = std::clamp(creep[axis], -kGravity, kGravity);  // No tyre holds more.
    creep[axis] *= parameters_.tyre_creep * std::abs(distance);
  }
  return creep;
}

/// Slope and creep shorten the distance, which is laid along the heading that the robot had halfway.
void Estimator::advance_path(const WheelSides::Travel& travel) noexcept {
  const Vector3& up = tilt_.up();
  const double level = travel.distance * std::sqrt(std::max(0.0, 1 - up[0] * up[0]));
  const std::array<double, 2> creep = tyres_creep(travel.distance);
  const double along = level - creep[0];
  const auto path = [&](double yaw) { return rotated({along, -creep[1]}, yaw); };
  const double turned = travel.turn_since + yaw_rate_ * core_.offset();
  const Planar odom = path(core_.pose().yaw - turned);
  core_.roll(odom.x, odom.y, yaw_rate_);
  uncorrected_step_ = uncorrected_step_ + path(uncorrected_yaw_ - turned);
  height_ += travel.distance * up[0];
  distance_ += std::abs(travel.distance);
}

void Estimator::watch_slip(double dt, double turned) noexcept {
  const bool inertial = imu_.gyro() && imu_.accelerometer() && !wheels_.any_lost() && !wheels_.in_a_batch();
  if (!inertial) {
    end_slide();
    return;
  }
  const double left = wheels_.left();
  const double right = wheels_.right();
  const bool point =
      slip_detector_.step({.dt = dt,
                           .acceleration = tilt_.acceleration(array(*imu_.accelerometer())),
                           .up = tilt_.up(),
                           .turned = turned,
                           .yaw = uncorrected_yaw_,
                           .path = uncorrected_step_,
                           .right_minus_left = (right - left + core_.ratio() * (left + right) / 2) / (1 + core_.base()),
                           .distance = (std::abs(left) + std::abs(right)) / 2,
                           .both_sides_read = wheels_.both_received(),
                           .yaw_rate = yaw_rate_});
  if (point && !slip_detector_.difference().empty()) evaluate_slip();
}

void Estimator::end_slide() noexcept {
  slide_.end();
  slip_detector_.restart();
}

void Estimator::evaluate_slip() noexcept {
  const bool learns = !slide_.active();
  if (learns) slip_detector_.set_clock_offset(core_.offset());
  slip_detector_.evaluate({.acceleration_variance = {tilt_.acceleration_variance(0), tilt_.acceleration_variance(1)},
                           .wheel_base = core_.deviation(PlanarCore::kBase),
                           .clock_offset = core_.deviation(PlanarCore::kOffset),
                           .gyro_bias = std::sqrt(core_.bias_variance()),
                           .speed_step = wheels_.quantum().step()},
                          learns);
  smooth_nis(kAccelerometer, slip_detector_.nis(SlipResidual::kAlong), Tuning::kPointInterval);
  smooth_nis(kLateralContact, slip_detector_.nis(SlipResidual::kAcross), Tuning::kPointInterval);
  smooth_nis(kGyro, slip_detector_.nis(SlipResidual::kTurn), Tuning::kPointInterval);
  if (slide_.active()) {
    correct(slide_.step(slip_detector_.difference(), slide_input()));
    if (!slide_.active()) slip_detector_.restart_on_line(slide_.rolling_slope(slip_detector_.difference()));
    return;
  }
  const SlipDetector::GravityError& gravity = slip_detector_.gravity_error();
  if (const double span = slip_detector_.shortest_proven_span(); span > 0) {
    if (drags_wheels_ && !bias_measured_) return;
    if (slip_detector_.proven(SlipResidual::kAcross)) ++rejected_[kLateralContact];
    correct(slide_.begin(slip_detector_.difference(), span, slide_input()));
  } else if (gravity.known) {
    tilt_.correct(gravity.along, gravity.across, gravity.interval, gravity.deviation);
  }
}

WheelSlide::Input Estimator::slide_input() const noexcept {
  const double variance = std::max(tilt_.acceleration_variance(0), tilt_.acceleration_variance(1));
  return {.noise = slip_detector_.acceleration_noise(variance),
          .path_slope_deviation = slip_detector_.slope_deviation(SlipResidual::kAlong),
          .turn_slope_deviation = slip_detector_.slope_deviation(SlipResidual::kTurn),
          .side_speed = {wheels_.side_speed(kLeft), wheels_.side_speed(kRight)},
          .wheel_base = geometry_.wheel_base,
          .sideways = slip_detector_.proven(SlipResidual::kAcross)};
}

/// The axes of the slip detector are turned against the axes of odom.
void Estimator::correct(const WheelSlide::Correction& correction) noexcept {
  const Planar shift = rotated(correction.shift, core_.pose().yaw - uncorrected_yaw_);
  core_.shift(shift.x, shift.y, correction.variance);
  core_.contradict(correction.contradiction, 0);
}

void Estimator::compare_turns(double dt) noexcept {
  comparison_.time += dt;
  comparison_.left += wheels_.left();
  comparison_.right += wheels_.right();
  comparison_.stuck |= imu_.gyro_unchanged() > Tuning::kMaxHoldTime;
  if (slide_.active()) comparison_.open = false;
  if (!wheels_.both_received() || (comparison_.open && comparison_.time < Tuning::kBlock)) return;
  if (!imu_.gyro() || gyro_turn_.silent()) return;
  if (comparison_.open) {
    const auto [nis, used, apart, usual] = core_.end_block(comparison_.left, comparison_.right, rate_.rate().z(),
                                                           comparison_.time, wheels_.stamp_variance());
    for (const SensorIndex sensor : {kLeftEncoder, kRightEncoder}) {
      smooth_nis(sensor, nis, comparison_.time);
      if (!used) ++rejected_[sensor];
    }
    const double explained = comparison_.stuck ? 0 : std::copysign(usual, apart);
    if (!used || comparison_.stuck) {
      core_.contradict(apart - explained, (comparison_.left + comparison_.right) / 2);
    }
  }
  begin_comparison();
}

void Estimator::begin_comparison() noexcept {
  core_.begin_block(rate_.rate().z());
  comparison_ = {.open = true};
}

void Estimator::smooth_nis(SensorIndex sensor, double nis, double dt) noexcept {
  if (!(nis >= 0)) return;  // A sensor of this comparison is lost.
  double& smoothed = nis_[sensor];
  smoothed += dt / (Tuning::kBlock + dt) * (std::min(nis, Tuning::kMaxNis) - smoothed);
}

}  // namespace robot_control

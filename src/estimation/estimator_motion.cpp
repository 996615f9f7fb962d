// The estimator in motion: the gyro turns, the wheels move, slip is watched, calibration is learned.

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimation/estimator.h"
#include "estimation/values.h"
#include "robot/gravity.h"

namespace robot_control {
namespace {

constexpr double kBlock = 1.0;  // s, between two comparisons of wheels and gyro
constexpr double kBatch = 0.3;  // of the usual gap between two readings
constexpr double kCalm = 0.5;   // s after a slide in which nothing is learned

}  // namespace

void Estimator::move(double dt) noexcept {
  const double turned = turn(dt);
  for (Side& side : sides_) side.turned += turned;
  own_way_ = {};
  roll();
  tilt_.roll(geometry_.turn(sides_[kLeft].encoder.travel(), sides_[kRight].encoder.travel()));
  if (imu_.gyro()) turn_tilt(array(*imu_.gyro()), dt);
  if (parameters_.slip_detection) watch_slip(dt, turned);
  compare_turns(dt);
  const RestWindow window = watch_rest(dt);
  if (lost(kLeft) || lost(kRight)) watch_.reset();
  if (window == RestWindow::kQuiet && !lost(kLeft) && !lost(kRight) && !slides_at_rest()) begin_rest();
}

/// `gyro` rad/s, bias included.
void Estimator::turn_tilt(const Vector3& gyro, double dt) noexcept {
  const bool known = gyro_learned_;
  tilt_.turn({known ? gyro[0] - gyro_bias_[0] : 0, known ? gyro[1] - gyro_bias_[1] : 0, gyro[2] - core_.bias()}, dt,
             known);
}

/// The heading; rad, bias removed.
double Estimator::turn(double dt) noexcept {
  const double before = core_.pose().yaw;
  if (const std::optional<double> angle = gyro_turn(dt)) {
    core_.turn_by_gyro(*angle, dt);
  } else {
    core_.turn_by_wheels(sides_[kLeft].encoder.travel(), sides_[kRight].encoder.travel());
    block_ = {};
  }
  const double turned = core_.pose().yaw - before;
  turning_ = imu_.gyro() && silence_ == 0 ? gyro_now().z() - core_.bias() : wheel_rate();
  own_yaw_ += turned;
  return turned;
}

/// By the gyro in this step, bias included; what the wheels seemed to turn meanwhile is replaced, if it was not for
/// long. Empty: by the wheels.
std::optional<double> Estimator::gyro_turn(double dt) noexcept {
  const bool fresh = imu_.new_gyro();
  const double last = std::exchange(last_sample_, fresh ? imu_.last_gyro().z() : last_sample_);
  if (imu_.gyro() && silence_ == 0) return imu_.gyro()->z() * dt;
  silence_ += dt;
  if (!fresh) {
    silent_turn_ += core_.wheel_turn(sides_[kLeft].encoder.travel(), sides_[kRight].encoder.travel());
    return std::nullopt;
  }
  const double silence = std::exchange(silence_, 0);
  const double turned = std::exchange(silent_turn_, 0);
  if (silence >= kLongestGap) return std::nullopt;
  return (last + last_sample_) / 2 * silence - core_.bias() * (silence - dt) - turned;
}

void Estimator::roll() noexcept {
  const bool together = both_read() && sides_[kLeft].credited == 0 && sides_[kRight].credited == 0;
  if (together && sides_[kLeft].turned == sides_[kRight].turned) {
    const double left = sides_[kLeft].encoder.travel();
    const double right = sides_[kRight].encoder.travel();
    go({.distance = (left + right) / 2 + core_.ratio() * (right - left) / 4, .before = sides_[kLeft].turned / 2});
    sides_[kLeft].turned = sides_[kRight].turned = 0;
    return;
  }
  for (const std::size_t i : {kLeft, kRight}) {
    Side& side = sides_[i];
    if (!side.encoder.received()) continue;
    double way = (side.encoder.travel() - std::exchange(side.credited, 0)) / 2;
    if (lost(1 - i)) {  // it rolls for the other
      const double across = (i == kLeft ? 1 : -1) * side.turned * geometry_.wheel_base;
      way = side.encoder.travel() + across / 2;
      sides_[1 - i].credited += side.encoder.travel() + across;
    }
    go({.distance = way, .before = side.turned / 2});
    side.turned = 0;
  }
}

/// m, along and to the left: by how much less the robot goes than its treads roll. A tyre that pulls or holds creeps by
/// tyre_creep times the specific force per way (H. B. Pacejka, Tire and Vehicle Dynamics, 2012, chapter 3, linear
/// range); of gravity only what is beyond three deviations of the tilt.
std::array<double, 2> Estimator::tyres_creep(double distance) const noexcept {
  if (!imu_.accelerometer() || parameters_.tyre_creep == 0) return {};
  std::array<double, 2> force = tilt_.acceleration(array(*imu_.accelerometer()));
  for (const std::size_t axis : {0U, 1U}) {
    const double sine = tilt_.up()[axis];
    const double doubt = 3 * std::sqrt(std::max(0.0, tilt_.covariance(axis, axis)));
    force[axis] += kGravity * std::copysign(std::max(0.0, std::abs(sine) - doubt), sine);
    force[axis] = std::clamp(force[axis], -kGravity, kGravity);  // more no tyre holds
  }
  return {parameters_.tyre_creep * std::abs(distance) * force[0],
          parameters_.tyre_creep * std::abs(distance) * force[1]};
}

void Estimator::go(const Travel& travel) noexcept {
  const Vector3& up = tilt_.up();
  const double level = travel.distance * std::sqrt(std::max(0.0, 1 - up[0] * up[0]));
  const double shortened = shortened_ + std::abs(travel.distance - level);
  core_.shift(0, 0, square(SlipCorrection::kUncertain) * (square(shortened) - square(shortened_)));
  shortened_ = shortened;
  const std::array<double, 2> creep = tyres_creep(travel.distance);
  const double along = level - creep[0];
  const auto turned = [&](double yaw) {
    return Planar{std::cos(yaw) * along + std::sin(yaw) * creep[1], std::sin(yaw) * along - std::cos(yaw) * creep[1]};
  };
  const double before = travel.before + turning_ * core_.offset();
  const Planar odom = turned(core_.pose().yaw - before);
  core_.roll(odom.x, odom.y, turning_);
  const Planar own = turned(own_yaw_ - before);
  own_way_.x += own.x;
  own_way_.y += own.y;
  height_ += travel.distance * up[0];
  distance_ += std::abs(travel.distance);
}

/// Readings that come much closer than usual were held up on their way: their stamps say nothing about the speed.
bool Estimator::in_a_batch() noexcept {
  if (!both_read()) return false;
  const double gap = sides_[kLeft].encoder.time();
  usual_gap_ = usual_gap_ == 0 ? gap : usual_gap_ * (gap > usual_gap_ ? 1.05 : 0.95);
  return gap < kBatch * usual_gap_;
}

void Estimator::watch_slip(double dt, double turned) noexcept {
  const bool inertial = imu_.gyro() && imu_.accelerometer() && !lost(kLeft) && !lost(kRight) && !in_a_batch();
  if (!inertial) {
    slip_.restart();
    slide_.end();
    return;
  }
  const double left = sides_[kLeft].encoder.travel();
  const double right = sides_[kRight].encoder.travel();
  const bool point = slip_.step({.dt = dt,
                                 .acceleration = tilt_.acceleration(array(*imu_.accelerometer())),
                                 .up = tilt_.up(),
                                 .turned = turned,
                                 .yaw = own_yaw_,
                                 .way = own_way_,
                                 .across = (right - left + core_.ratio() * (left + right) / 2) / (1 + core_.base()),
                                 .path = (std::abs(left) + std::abs(right)) / 2,
                                 .read = both_read(),
                                 .rate = turning_});
  if (slide_.active() && both_read()) follow_slide();
  if (point && !slip_.empty()) judge_slip();
}

/// While a slide is going on.
void Estimator::follow_slide() noexcept {
  correct(slide_.step(slip_, known()));
  if (slide_.active()) return;
  if (!slide_.gave_up()) return slip_.restart_on(slide_.line());
  if (slide_.taken_back()) slip_.learn_false();
  slip_.restart();
}

void Estimator::judge_slip() noexcept {
  const bool learns = !slide_.active() && slide_.since_end() > kCalm;
  slip_.judge({.acceleration = {tilt_.acceleration_variance(0), tilt_.acceleration_variance(1)},
               .base = core_.deviation(PlanarCore::kBase),
               .offset = core_.deviation(PlanarCore::kOffset),
               .bias = std::sqrt(core_.bias_variance())},
              learns);
  for (const auto& [sensor, channel] :
       {std::pair{kAccelerometer, SlipStatistic::kAlong}, std::pair{kLateralContact, SlipStatistic::kAcross},
        std::pair{kGyro, SlipStatistic::kTurn}}) {
    note(sensor, slip_.nis(channel), SlipStatistic::kGrid);
  }
  if (slide_.active()) return;
  double span = 0;
  for (const auto channel : {SlipStatistic::kAlong, SlipStatistic::kAcross, SlipStatistic::kTurn}) {
    const double proven = slip_.span(channel);
    if (proven > 0 && (span == 0 || proven < span)) span = proven;
  }
  if (span > 0) {
    if (slip_.proven(SlipStatistic::kAcross)) ++rejected_[kLateralContact];
    correct(slide_.begin(slip_, span, known()));
  } else if (slip_.pull().known) {
    tilt_.pull(slip_.pull().along, slip_.pull().across, slip_.pull().interval, std::sqrt(slip_.pull().variance));
  }
}

SlipCorrection::Known Estimator::known() const noexcept {
  return {.white = slip_.white(),
          .slow = slip_.slow(std::max(tilt_.acceleration_variance(0), tilt_.acceleration_variance(1))),
          .along = slip_.slope_deviation(SlipStatistic::kAlong),
          .turn = slip_.slope_deviation(SlipStatistic::kTurn),
          .speed = wheel_speed(),
          .calm = slip_.calm()};
}

/// The slip statistic's axes are turned against odom's.
void Estimator::correct(const SlipCorrection::Step& correction) noexcept {
  const double turned = core_.pose().yaw - own_yaw_;
  const double c = std::cos(turned);
  const double s = std::sin(turned);
  core_.shift(c * correction.x - s * correction.y, s * correction.x + c * correction.y, correction.variance);
}

void Estimator::compare_turns(double dt) noexcept {
  block_.time += dt;
  block_.left += sides_[kLeft].encoder.travel();
  block_.right += sides_[kRight].encoder.travel();
  if (slide_.active() || (parameters_.slip_detection && slide_.since_end() < kCalm)) block_.open = false;
  if (!both_read() || (block_.open && block_.time < kBlock)) return;
  if (!imu_.gyro() || silence_ > 0) return;
  if (block_.open) {
    const auto [nis, used] =
        core_.end_block(block_.left, block_.right, rate_.rate().z(), block_.time, jitter_.variance());
    for (const SensorIndex sensor : {kLeftEncoder, kRightEncoder}) {
      note(sensor, nis, block_.time);
      if (!used) ++rejected_[sensor];
    }
  }
  core_.begin_block(rate_.rate().z());
  block_ = {.open = true};
}

void Estimator::note(SensorIndex sensor, double nis, double dt) noexcept {
  constexpr double kLargest = 1e6;
  if (!(nis >= 0)) return;  // a sensor it compares is lost
  double& smoothed = nis_[sensor];
  smoothed += dt / (kSmoothing + dt) * (std::min(nis, kLargest) - smoothed);
}

}  // namespace robot_control

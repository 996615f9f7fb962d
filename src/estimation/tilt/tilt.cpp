#include "estimation/tilt/tilt.h"

#include <algorithm>
#include <cmath>

#include "estimation/tuning.h"
#include "estimation/values.h"

namespace robot_control {
namespace {

constexpr std::size_t kAxes[] = {0, 1};

/// (x, y) in axes that have turned by an angle of that cosine and sine.
void turn_axes(double c, double s, double& x, double& y) noexcept {
  const double before = x;
  x = c * before + s * y;
  y = c * y - s * before;
}

}  // namespace

Tilt::Tilt(const TiltParams& params) noexcept : params_(params) {
  for (const std::size_t axis : kAxes) {
    now_.p[axis][axis] = square(Tuning::kInitialTilt);
    now_.p[axis + 2][axis + 2] = square(params.bias / kGravity);
  }
}

void Tilt::Estimate::bound() noexcept {
  const double norm = std::hypot(up[0], up[1], up[2]);
  if (norm > 0.1) {
    for (double& value : up) value /= norm;
  }
  const double flat = std::hypot(up[0], up[1]);
  if (flat <= Tuning::kSteepest && up[2] > 0) return;
  for (const std::size_t axis : kAxes) up[axis] *= Tuning::kSteepest / std::max(flat, Tuning::kSteepest);
  up[2] = std::sqrt(1 - square(up[0]) - square(up[1]));
}

/// Gravity turns against the robot, the bias does not.
void Tilt::Estimate::turn(double angle) noexcept {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  for (std::size_t k = 0; k < 4; ++k) turn_axes(c, s, p[0][k], p[1][k]);
  for (std::size_t k = 0; k < 4; ++k) turn_axes(c, s, p[k][0], p[k][1]);
}

double Tilt::Estimate::variance(std::size_t axis) const noexcept {
  return p[axis][axis] + 2 * p[axis][axis + 2] + p[axis + 2][axis + 2];
}

bool Tilt::Estimate::contradicts(const Plane& sum, double noise) const noexcept {
  return std::ranges::any_of(kAxes, [&](std::size_t axis) {
    return square(off(sum, axis)) > square(Tuning::kSignificant) * (variance(axis) + noise);
  });
}

void Tilt::Estimate::update(const Plane& sum, double noise) noexcept {
  for (const std::size_t axis : kAxes) {
    const double expected = variance(axis) + noise;
    const double innovation = off(sum, axis) / expected;
    std::array<double, 4> ph{};
    for (std::size_t i = 0; i < 4; ++i) ph[i] = p[i][axis] + p[i][axis + 2];
    for (const std::size_t i : kAxes) {
      up[i] += innovation * ph[i];
      bias[i] += innovation * ph[i + 2];
    }
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t k = 0; k < 4; ++k) p[i][k] -= ph[i] * ph[k] / expected;
    }
  }
  up[2] = std::sqrt(std::max(0.1, 1 - square(up[0]) - square(up[1])));
  bound();
}

void Tilt::turn(const Vector3& rate, double dt, bool known) noexcept {
  const auto [x, y, z] = now_.up;
  now_.up = {x + dt * (rate[2] * y - rate[1] * z), y + dt * (rate[0] * z - rate[2] * x),
             z + dt * (rate[1] * x - rate[0] * y)};
  now_.bound();
  doubt_ += std::max(0.0, std::hypot(rate[0], rate[1]) - Tuning::kTipping) * dt;
  stuck_ = known && rate == last_ ? stuck_ + dt : 0;
  if (stuck_ > Tuning::kStuckGyro) doubt_ = std::max(doubt_, Tuning::kUnreliableTurn);
  last_ = rate;
  turned_ += rate[2] * dt;
  walked_ += square(known ? Tuning::kTiltWalk : Tuning::kTiltWalkWithoutGyro) * dt;
  time_ += dt;
}

void Tilt::age() noexcept {
  now_.turn(turned_);
  for (const std::size_t i : kAxes) {
    now_.p[i][i] = std::min(now_.p[i][i] + walked_, square(Tuning::kSteepest));
    now_.p[i + 2][i + 2] += square(params_.bias_walk / kGravity) * time_;
  }
  turned_ = walked_ = time_ = 0;
}

void Tilt::pull(double along, double across, double dt, double deviation) noexcept {
  age();
  const Plane sum{now_.up[0] + now_.bias[0] + along / kGravity, now_.up[1] + now_.bias[1] + across / kGravity};
  now_.update(sum, square(deviation / kGravity) * std::max(1.0, Tuning::kSlowTime / dt));
}

Tilt::Estimate Tilt::on_the_floor() const noexcept {
  Estimate floor = rested_;
  turn_axes(std::cos(rolled_), std::sin(rolled_), floor.up[0], floor.up[1]);
  floor.turn(rolled_);
  for (const std::size_t axis : kAxes) floor.p[axis][axis] += square(Tuning::kFloor);
  return floor;
}

void Tilt::rest(const Vector3& force, double dt) noexcept {
  const double norm = std::hypot(force[0], force[1], force[2]);
  if (!(norm > kGravity / 2 && norm < 2 * kGravity)) return;
  age();
  const Plane sum{force[0] / kGravity, force[1] / kGravity};
  const double noise = (square(params_.accelerometer) / dt + square(Tuning::kAccelerometerAtRest)) / square(kGravity);
  const bool by_gyro = doubt_ < Tuning::kUnreliableTurn && !now_.contradicts(sum, noise);
  if (!by_gyro && known_) now_ = on_the_floor();
  if (now_.contradicts(sum, noise)) {
    for (const std::size_t axis : kAxes) {
      now_.p[axis][axis] += square(now_.off(sum, 0)) + square(now_.off(sum, 1));
    }
  }
  now_.update(sum, noise);
  vertical_ += std::min(1.0, dt) * (norm - kGravity - vertical_);
  rested_ = now_;
  known_ = true;
  rolled_ = doubt_ = 0;
}

void Tilt::set(const Vector3& up, const std::array<double, 2>& bias) noexcept {
  now_.up = up;
  for (const std::size_t axis : kAxes) now_.bias[axis] = bias[axis] / kGravity;
  now_.bound();
}

double Tilt::roll() const noexcept {
  return std::atan2(now_.up[1], now_.up[2]);
}

double Tilt::pitch() const noexcept {
  return std::asin(std::clamp(-now_.up[0], -1.0, 1.0));
}

}  // namespace robot_control

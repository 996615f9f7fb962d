#include "machine/encoders/tracking_loop.h"

#include <algorithm>
#include <cmath>

namespace robot_control {

namespace {

constexpr double kInside = 0.2;                         // largest f_in over the bandwidth
constexpr double kCounts = 40;                          // counts in 1/f_in
constexpr double kMinPart = 0.1;                        // smallest f over the bandwidth
constexpr double kMinQuickSpeed = 1.5;                  // rad/s
constexpr double kUncertainShare = 0.25;                // share of q'
constexpr double kCoarse = 2 * std::numbers::pi / 512;  // rad, size of a count

double pole(double bandwidth, double dt) noexcept {
  return std::exp(-2 * std::numbers::pi * bandwidth * dt);
}

/// Approximates the pole to (2π·bandwidth·dt)³/6 without a function call.
double cheap_pole(double bandwidth, double dt) noexcept {
  const double x = 2 * std::numbers::pi * bandwidth * dt;
  return 1 / (1 + x + 0.5 * x * x);
}

}  // namespace

TrackingLoop::Gains TrackingLoop::gains(double pole, double dt) noexcept {
  const double q = 1 - pole;
  return {
      .position = 1 - pole * pole * pole, .velocity = 1.5 * q * q * (1 + pole) / dt, .residual = q * q * q / (dt * dt)};
}

TrackingLoop::TrackingLoop(double bandwidth, double period) : bandwidth_(bandwidth), period_(period) {
  derive();
}

void TrackingLoop::derive() noexcept {
  nominal_ = gains(pole(bandwidth_, period_), period_);
  const double quantum = quantum_.value();
  uncertainty_ = quantum * std::min(1.0, quantum / kCoarse);
  slowest_ = kCounts * quantum * kInside * bandwidth_;
}

void TrackingLoop::reset() noexcept {
  quantum_ = {};
  derive();
}

void TrackingLoop::restart_from(double position, double velocity) noexcept {
  measured_ = position;
  travelled_ = 0;
  position_ = position;
  velocity_ = velocity;
  residual_ = 0;
  known_ = 0;
}

void TrackingLoop::tune(double bandwidth) noexcept {
  bandwidth_ = bandwidth;
  derive();
}

double TrackingLoop::part_of_bandwidth(double pace, double beyond, double silent) const noexcept {
  const double quantum = quantum_.value();
  const double quick = std::max(kMinQuickSpeed, std::abs(velocity_));  // rad/s
  const double loud = 2 * std::numbers::pi * bandwidth_ * quantum;     // rad/s
  const double limit = loud > quick ? quick / loud : 1;                // m of the header
  const double evidence = beyond < uncertainty_ ? beyond / uncertainty_ : 1;
  return std::max({pace, limit * evidence, silent, kMinPart});
}

void TrackingLoop::step(double position_measured, double known_acceleration, double periods) noexcept {
  const double dt = periods * period_;
  known_ = known_acceleration;
  const double predicted_velocity = velocity_ + acceleration() * dt;
  position_ += 0.5 * (velocity_ + predicted_velocity) * dt;
  velocity_ = predicted_velocity;

  const double turned = position_measured - measured_;
  if (quantum_.refine(turned)) derive();
  travelled_ = turned == 0 ? travelled_ + velocity_ * dt : 0;
  const double half = 0.5 * quantum_.value();
  // If the velocity is wrong, the last cell, moved on, may miss this one. Then only its nearer edge is known.
  const double lower = position_measured - half, upper = position_measured + half;
  const double came_from = measured_ + velocity_ * dt;
  const double low = std::clamp(came_from - half, lower, upper);
  const double high = std::clamp(came_from + half, lower, upper);
  measured_ = position_measured;
  const double inside = std::clamp(position_, low, high);
  const double beyond = inside - position_;
  const double centre = 0.5 * (low + high) - inside;

  // The pace is f_in over its largest value.
  const double pace = std::abs(velocity_) < slowest_ ? std::abs(velocity_) / slowest_ : 1;
  const double silent = pace < 1 ? std::clamp(std::abs(travelled_) / quantum_.value() - 1, 0.0, 1.0) : 0;
  const double part = pace < 1 ? part_of_bandwidth(pace, std::abs(beyond), silent) : 1;
  const double ratio = pace < 1 ? kInside * pace / part : kInside;  // κ
  const Gains gain = part == 1 && periods == 1 ? nominal_ : gains(cheap_pole(part * bandwidth_, dt), dt);
  const double innovation = beyond + ratio * ratio * centre;
  position_ += gain.position * innovation;
  velocity_ += gain.velocity * innovation;
  const double trust = uncertainty_ > 0 ? std::abs(beyond) / (std::abs(beyond) + kUncertainShare * uncertainty_) : 1;
  residual_ += gain.residual * std::max(trust, silent) * beyond;
}

bool EncoderQuantum::refine(double turned) noexcept {
  constexpr double kExact = 1e-4;    // rad
  constexpr double kMinStep = 1e-9;  // rad, below which a difference is rounding
  const double before = value_;
  if (!changed_ && std::abs(turned) > kMinStep) {
    changed_ = true;
    value_ = kCoarsest;  // The value of another wheel's encoder counts no longer.
  }
  for (const double step : {turned, turned - last_}) {
    const double size = std::abs(step);
    if (size > kMinStep && size < value_) value_ = size < kExact ? 0 : size;
  }
  last_ = turned;
  return value_ != before;
}

bool EncoderQuantum::assume(const EncoderQuantum& other) noexcept {
  if (changed_ || other.value_ >= value_) return false;
  value_ = other.value_;
  return true;
}

}  // namespace robot_control

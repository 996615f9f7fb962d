#include "control/wheel_loops/tracking_loop.h"

#include <cmath>
#include <numbers>

namespace robot_control {

namespace {

double pole(double bandwidth, double dt) noexcept {
  return std::exp(-2 * std::numbers::pi * bandwidth * dt);
}

}  // namespace

TrackingLoop::TrackingLoop(double bandwidth, double period)
    : bandwidth_(bandwidth), period_(period), nominal_pole_(pole(bandwidth, period)) {}

void TrackingLoop::restart_from(double position, double velocity) noexcept {
  position_ = position;
  velocity_ = velocity;
  residual_ = 0;
  known_ = 0;
}

void TrackingLoop::tune(double bandwidth, double known_decrease) noexcept {
  bandwidth_ = bandwidth;
  nominal_pole_ = pole(bandwidth, period_);
  residual_ += known_decrease;
}

void TrackingLoop::step(double position_measured, double known_acceleration, double periods) noexcept {
  const double dt = periods * period_;
  const double p = periods == 1 ? nominal_pole_ : pole(bandwidth_, dt);
  const double q = 1 - p;
  known_ = known_acceleration;
  const double predicted_velocity = velocity_ + acceleration() * dt;
  const double predicted_position = position_ + 0.5 * (velocity_ + predicted_velocity) * dt;
  const double innovation = position_measured - predicted_position;
  position_ = predicted_position + (1 - p * p * p) * innovation;
  velocity_ = predicted_velocity + 1.5 * q * q * (1 + p) * innovation / dt;
  residual_ += q * q * q * innovation / (dt * dt);
}

}  // namespace robot_control

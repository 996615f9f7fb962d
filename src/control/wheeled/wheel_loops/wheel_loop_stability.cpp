#include "control/wheeled/wheel_loops/wheel_loop_stability.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace robot_control {

namespace {

/// After these states come the commands under way, in the order in which they act, and the integral.
enum State : Eigen::Index { kOffset, kVelocity, kResidual, kTrueVelocity, kLastEffort, kEffort, kUnderWay };

using Row = Eigen::RowVectorXd;

/// Holds the motion of the wheel within `dt` by a speed of 1 rad/s or a torque of 1 N·m.
struct FreeWheel {
  double speed_kept;       ///< share of the speed
  double angle_of_speed;   ///< s
  double speed_of_effort;  ///< rad/s per N·m
  double angle_of_effort;  ///< rad per N·m
};

FreeWheel free_wheel(const WheelLoad& load, double dt) {
  if (load.damping == 0) return {1, dt, dt / load.inertia, 0.5 * dt * dt / load.inertia};
  const double lost = -std::expm1(-load.damping / load.inertia * dt);
  const double angle = lost * load.inertia / load.damping;
  return {1 - lost, angle, lost / load.damping, (dt - angle) / load.damping};
}

Eigen::MatrixXd transition(const WheelLoopGains& gains, const WheelLoad& load, double dt, double bandwidth,
                           Eigen::Index delay) {
  const double p = std::exp(-2 * std::numbers::pi * bandwidth * dt);
  const double q = 1 - p;
  const Eigen::Index states = kUnderWay + delay + 1;
  const Eigen::Index integral_state = states - 1;
  const auto unit = [&](Eigen::Index state) -> Row { return Row::Unit(states, state); };

  const Row acceleration = unit(kResidual) + unit(kLastEffort) / gains.model_inertia;
  const Row innovation = -(unit(kOffset) + dt * unit(kVelocity) + 0.5 * dt * dt * acceleration);
  const Row offset = -p * p * p * innovation;
  const Row velocity = unit(kVelocity) + dt * acceleration + 1.5 * q * q * (1 + p) / dt * innovation;
  const Row residual = unit(kResidual) + q * q * q / (dt * dt) * innovation;
  const Row measured = residual + unit(kLastEffort) / gains.model_inertia;
  const Row integral = unit(integral_state) - gains.ki * dt * velocity;

  const FreeWheel wheel = free_wheel(load, dt);
  Eigen::MatrixXd a(states, states);
  a.row(kOffset) = offset - wheel.angle_of_speed * unit(kTrueVelocity) - wheel.angle_of_effort * unit(kEffort);
  a.row(kVelocity) = velocity;
  a.row(kResidual) = residual;
  a.row(kTrueVelocity) = wheel.speed_kept * unit(kTrueVelocity) + wheel.speed_of_effort * unit(kEffort);
  a.row(kLastEffort) = unit(kEffort);
  for (Eigen::Index i = 0; i < delay; ++i) a.row(kEffort + i) = unit(kEffort + i + 1);
  a.row(kEffort + delay) = integral - gains.kp * velocity - gains.kd * measured;
  a.row(integral_state) = integral;
  return a;
}

/// Returns λ of all modes.
Eigen::VectorXcd eigenvalues(const WheelLoopGains& gains, const WheelLoad& load, double period, double bandwidth,
                             unsigned delay) {
  const Eigen::MatrixXd a = transition(gains, load, period, bandwidth, delay);
  // Without ki the integral is a constant beside the loop, not a mode of it.
  const Eigen::Index states = gains.ki > 0 ? a.rows() : a.rows() - 1;
  const Eigen::MatrixXd loop = a.topLeftCorner(states, states);
  return Eigen::EigenSolver<Eigen::MatrixXd>(loop, false).eigenvalues();
}

}  // namespace

double wheel_loop_spectral_radius(const WheelLoopGains& gains, const WheelLoad& load, double period, double bandwidth,
                                  unsigned delay) {
  return eigenvalues(gains, load, period, bandwidth, delay).cwiseAbs().maxCoeff();
}

double wheel_loop_damping_ratio(const WheelLoopGains& gains, const WheelLoad& load, double period, double bandwidth) {
  double least = 1;
  for (const std::complex<double>& mode : eigenvalues(gains, load, period, bandwidth, 0)) {
    if (mode == 0.0) continue;  // The mode ends within one cycle.
    const std::complex<double> exponent = std::log(mode);
    if (exponent != 0.0) least = std::min(least, -exponent.real() / std::abs(exponent));
  }
  return least;
}

}  // namespace robot_control

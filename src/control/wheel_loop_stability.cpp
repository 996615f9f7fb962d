#include "control/wheel_loop_stability.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

namespace robot_control {

namespace {

enum State { kOffset, kVelocity, kResidual, kTrueVelocity, kEffort, kLastEffort, kIntegral, kStates };

using Matrix = Eigen::Matrix<double, kStates, kStates>;
using Row = Eigen::Matrix<double, 1, kStates>;

Row unit(State state) {
  return Row::Unit(state);
}

Matrix transition(const WheelLoopGains& gains, double inertia, double dt, double bandwidth) {
  const double p = std::exp(-2 * std::numbers::pi * bandwidth * dt);
  const double q = 1 - p;

  const Row acceleration = unit(kResidual) + unit(kLastEffort) / gains.model_inertia;
  const Row innovation = -(unit(kOffset) + dt * unit(kVelocity) + 0.5 * dt * dt * acceleration);
  const Row offset = -p * p * p * innovation;
  const Row velocity = unit(kVelocity) + dt * acceleration + 1.5 * q * q * (1 + p) / dt * innovation;
  const Row residual = unit(kResidual) + q * q * q / (dt * dt) * innovation;
  const Row measured = residual + unit(kLastEffort) / gains.model_inertia;
  const Row integral = unit(kIntegral) - gains.ki * dt * velocity;

  Matrix a;
  a.row(kOffset) = offset - dt * unit(kTrueVelocity) - 0.5 * dt * dt / inertia * unit(kEffort);
  a.row(kVelocity) = velocity;
  a.row(kResidual) = residual;
  a.row(kTrueVelocity) = unit(kTrueVelocity) + dt / inertia * unit(kEffort);
  a.row(kEffort) = integral - gains.kp * velocity - gains.kd * measured;
  a.row(kLastEffort) = unit(kEffort);
  a.row(kIntegral) = integral;
  return a;
}

}  // namespace

double wheel_loop_spectral_radius(const WheelLoopGains& gains, double inertia, double period, double bandwidth) {
  const Matrix a = transition(gains, inertia, period, bandwidth);
  // Without ki the integral is a constant beside the loop, not a mode of it.
  const Eigen::Index states = gains.ki > 0 ? kStates : kStates - 1;
  const Eigen::MatrixXd loop = a.topLeftCorner(states, states);
  return Eigen::EigenSolver<Eigen::MatrixXd>(loop, false).eigenvalues().cwiseAbs().maxCoeff();
}

double stability_number(const WheelLoopGains& gains, double period) noexcept {
  return gains.kp * period / gains.model_inertia;
}

}  // namespace robot_control

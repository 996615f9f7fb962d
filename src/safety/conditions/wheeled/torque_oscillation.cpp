#include "safety/conditions/wheeled/torque_oscillation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace robot_control {
namespace {

bool latches(const Condition& condition) noexcept {
  return condition.reaction == Reaction::kRamp || condition.reaction == Reaction::kBrake;
}

Condition announced(const Condition& condition) noexcept {
  return {.limit = condition.limit,
          .persistence = TorqueOscillation::kWarned * condition.persistence,
          .reaction = latches(condition) ? Reaction::kWarn : Reaction::kOff};
}

}  // namespace

void TorqueOscillation::Ripple::step(double value, const Weights& weights) noexcept {
  slow += weights.slow * (value - slow);
  const double fast = value - slow;
  square += weights.window * (fast * fast - square);
}

double TorqueOscillation::Ripple::rms() const noexcept {
  return std::sqrt(square);
}

TorqueOscillation::TorqueOscillation(const SafetyParameters& parameters, const DriveTrain& robot,
                                     double period) noexcept
    : period_(period),
      one_cycle_(weights_of(period)),
      warning_(kCauseTorqueOscillation, announced(parameters.torque_oscillation), period),
      watch_(kCauseTorqueOscillation, parameters.torque_oscillation, period),
      count_ripple_(parameters.count_ripple) {
  for (std::size_t i = 0; i < std::min(robot.wheels.size(), kMaxWheels); ++i) {
    inertia_[i] = std::max(straight_inertia(robot, robot.wheels[i]), turning_inertia(robot, robot.wheels[i]));
  }
}

void TorqueOscillation::enter_run() noexcept {
  wheels_ = {};
  commanded_ = {};
  warning_.reset();
  watch_.reset();
}

void TorqueOscillation::step(const WheeledMeasurements& now, ActiveCauses& out) noexcept {
  const ConditionMeasurement measurement = worst_of(now.motion.wheels(), [&](std::size_t i) {
    const double measured = now.input.sensors->joints[i].effort;
    if (now.input.command != nullptr) commanded_[i] = now.input.command->joints[i].effort;
    if (!now.motion.sampled() || !now.targets.has(i) || !std::isfinite(measured) || !std::isfinite(commanded_[i])) {
      wheels_[i] = {};
      return kNothingMeasured;
    }
    follow(i, measured, commanded_[i], now.targets[i], now.dt);
    return measure(i, now);
  });
  out.update(watch_, measurement, now.elapsed);
  warning_.step(measurement, now.elapsed);
  if (!watch_.active()) out.add(warning_);
}

TorqueOscillation::Weights TorqueOscillation::weights_of(double dt) noexcept {
  return {.slow = -std::expm1(-2 * std::numbers::pi * kCutoff * dt), .window = -std::expm1(-dt / kWindow)};
}

void TorqueOscillation::follow(std::size_t wheel, double measured, double commanded, double target,
                               double dt) noexcept {
  const Weights weights = dt == period_ ? one_cycle_ : weights_of(dt);
  Wheel& state = wheels_[wheel];
  if (!state.driven) {
    state.measured.slow = measured;
    state.commanded.slow = commanded;
  } else {
    state.measured.step(measured, weights);
    state.commanded.step(commanded, weights);
    state.planned.step(inertia_[wheel] * (target - state.target) / dt, weights);
  }
  state.driven = true;
  state.target = target;
}

ConditionMeasurement TorqueOscillation::measure(std::size_t wheel, const WheeledMeasurements& now) const noexcept {
  const Wheel& state = wheels_[wheel];
  const double effort_limit = now.wheels[wheel].effort_limit;
  const double explained = 2 * state.planned.rms() + count_ripple_[wheel] * now.motion.quantum(wheel);
  const double ripple = std::min(state.measured.rms(), state.commanded.rms());
  return beyond(wheel, ripple / effort_limit, watch_.limit() + explained / effort_limit);
}

}  // namespace robot_control

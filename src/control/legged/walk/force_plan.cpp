#include "control/legged/walk/force_plan.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "control/legged/posture/ground_slope.h"
#include "control/legged/stand/foot_forces.h"
#include "control/legged/walk/gait.h"
#include "machine/gravity.h"

namespace robot_control {
namespace {

using Effect = Eigen::Matrix<double, 6, 3>;  // Bₐ

/// Returns a speed that turns with its own yaw rate, after `time` s.
PlanVector turned(const PlanVector& speed, double time) noexcept {
  PlanVector result = speed;
  result.segment<2>(3) = Eigen::Rotation2Dd(speed[2] * time) * speed.segment<2>(3);
  return result;
}

double bearing(const std::array<bool, kLegs>& legs) noexcept {
  return static_cast<double>(std::count(legs.begin(), legs.end(), true));
}

}  // namespace

ForcePlanParameters force_plan_parameters(double mass, const Eigen::Matrix3d& inertia, double leg_length) noexcept {
  const double length = leg_length / kReferenceLeg, heaviness = mass / kReferenceMass;
  ForcePlanParameters parameters{.mass = mass, .inertia = inertia, .horizon = 0.3 * std::sqrt(length)};
  const double place = 1 / (length * length), turning = length, moving = 1 / length;
  parameters.place_weight << 4, 4, 10, 6 * place, 6 * place, 50 * place;
  parameters.speed_weight << 0.01 * turning, 0.01 * turning, 0.3 * turning, 0.2 * moving, 0.2 * moving, 0.1 * moving;
  parameters.force_weight = 4e-5 / (heaviness * heaviness);
  parameters.friction = 0.4;
  parameters.smallest = 0.016 * mass * kGravity;
  parameters.largest = 1.45 * mass * kGravity;
  return parameters;
}

ForcePlan::ForcePlan(const ForcePlanParameters& parameters) noexcept
    : parameters_(parameters), inverse_inertia_(parameters.inertia.inverse()) {}

ForcePlanResult ForcePlan::step(const ForcePlanInput& input) noexcept {
  ForcePlanResult result;
  result.steps = choose_variables(input);
  if (count_ == 0) return result;
  set_cost(input, parameters_.horizon / static_cast<double>(input.steps), result.steps);
  set_rows(input.ground);
  result.outcome = qp_.solve(problem_);
  if (result.outcome != QpOutcome::kSolved) return result;
  for (std::size_t i = 0; i < count_ && variables_[i].step == 0; ++i)
    result.forces[variables_[i].leg] = qp_.solution().segment<3>(static_cast<Eigen::Index>(3 * i));
  return result;
}

/// Lists the forces of the horizon. Returns its number of steps.
std::size_t ForcePlan::choose_variables(const ForcePlanInput& input) noexcept {
  count_ = 0;
  for (std::size_t step = 0; step < input.steps; ++step) {
    if (count_ + static_cast<std::size_t>(bearing(input.bears[step])) > variables_.size()) return step;
    for (std::size_t leg = 0; leg < kLegs; ++leg)
      if (input.bears[step][leg]) variables_[count_++] = {step, leg};
  }
  return input.steps;
}

void ForcePlan::set_cost(const ForcePlanInput& input, double step, std::size_t steps) noexcept {
  const auto size = static_cast<Eigen::Index>(3 * count_);
  problem_.hessian.resize(size, size);
  problem_.gradient.resize(size);
  PlanVector gravity = PlanVector::Zero();
  gravity[5] = -kGravity;

  // The target after each step, and its centre of gravity amid the step.
  std::array<PlanVector, kPlanSteps> place, speed;
  std::array<Eigen::Vector3d, kPlanSteps> centre;
  PlanVector target = input.target;
  for (std::size_t i = 0; i < steps; ++i) {
    const PlanVector amid = turned(input.target_speed, (static_cast<double>(i) + 0.5) * step);
    centre[i] = (target + step / 2 * amid - input.target).tail<3>();
    target += step * amid;
    place[i] = target;
    speed[i] = turned(input.target_speed, static_cast<double>(i + 1) * step);
  }

  std::array<Effect, kPlanVariables / 3> effects;
  for (std::size_t i = 0; i < count_; ++i)
    effects[i] << inverse_inertia_ * cross_matrix(input.feet[variables_[i].leg] - centre[variables_[i].step]),
        Eigen::Matrix3d::Identity() / parameters_.mass;

  // They weigh a force of step j beside one of step l, and against the motion without forces.
  std::array<std::array<PlanVector, kPlanSteps>, kPlanSteps> beside;
  std::array<PlanVector, kPlanSteps> against;
  for (std::size_t j = 0; j < steps; ++j) {
    for (std::size_t l = 0; l <= j; ++l) beside[j][l].setZero();
    against[j].setZero();
    for (std::size_t i = j; i < steps; ++i) {
      const double time = static_cast<double>(i + 1) * step;
      const double moved = (static_cast<double>(i - j) + 0.5) * step * step;
      const PlanVector free = input.place + time * input.speed + time * time / 2 * gravity - place[i];
      const PlanVector free_speed = input.speed + time * gravity - speed[i];
      against[j] += moved * parameters_.place_weight.cwiseProduct(free) +
                    step * parameters_.speed_weight.cwiseProduct(free_speed);
      for (std::size_t l = 0; l <= j; ++l) {
        const double other = (static_cast<double>(i - l) + 0.5) * step * step;
        beside[j][l] += moved * other * parameters_.place_weight + step * step * parameters_.speed_weight;
      }
    }
  }
  for (std::size_t row = 0; row < count_; ++row) {
    const std::size_t j = variables_[row].step;
    const auto first = static_cast<Eigen::Index>(3 * row);
    problem_.gradient.segment<3>(first) = effects[row].transpose() * against[j];
    problem_.gradient[first + 2] -= parameters_.force_weight * parameters_.mass * kGravity / bearing(input.bears[j]);
    for (std::size_t column = 0; column <= row; ++column) {  // the solver reads the lower triangle
      const std::size_t l = variables_[column].step;
      problem_.hessian.block<3, 3>(first, static_cast<Eigen::Index>(3 * column)) =
          effects[row].transpose() * beside[j][l].asDiagonal() * effects[column];
    }
    problem_.hessian.diagonal().segment<3>(first).array() += parameters_.force_weight;
  }
}

void ForcePlan::set_rows(const Eigen::Matrix3d& ground) noexcept {
  const auto size = static_cast<Eigen::Index>(3 * count_);
  problem_.rows.setZero(2 * size, size);
  problem_.bounds.setZero(2 * size);
  const double steepness = std::hypot(ground(2, 0), ground(2, 1)) / ground(2, 2);
  const double friction = std::max(parameters_.friction, kSlopeGrip * steepness);
  Eigen::Matrix<double, 6, 3> pyramid;
  pyramid << -1, 0, friction, 1, 0, friction, 0, -1, friction, 0, 1, friction, 0, 0, 1, 0, 0, -1;
  pyramid *= ground.transpose();
  for (Eigen::Index i = 0; i < size; i += 3) {
    problem_.rows.block<6, 3>(2 * i, i) = pyramid;
    problem_.bounds[2 * i + 4] = parameters_.smallest;
    problem_.bounds[2 * i + 5] = -parameters_.largest;
  }
}

}  // namespace robot_control

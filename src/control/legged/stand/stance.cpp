#include "control/legged/stand/stance.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "control/legged/stand/foot_forces.h"
#include "control/legged/stand/nominal_stance.h"
#include "machine/gravity.h"

namespace robot_control {
namespace {

constexpr double kMinBend = 0.3;             // rad, of the knee of a standing leg: a straight one turns without bound
constexpr double kAccelerationTime = 0.005;  // s, low pass of the accelerations
constexpr double kCentroidShare = 0.6;       // of the way from the middle to the centroid of three feet

using Map = Eigen::Map<const Eigen::Vector3d>;
using Efforts = Eigen::Matrix<double, kLeggedDofs, 1>;

Eigen::Matrix3d rotation(const Stance::Pose& pose) noexcept {
  using Axis = Eigen::AngleAxisd;
  return (Axis(pose[Stance::kYaw], Eigen::Vector3d::UnitZ()) * Axis(pose[Stance::kPitch], Eigen::Vector3d::UnitY()) *
          Axis(pose[Stance::kRoll], Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

/// Returns the rate of the reference in the base's axes.
LeggedMotion reference_motion(const Stance::State& state, const Eigen::Matrix3d& turned,
                              const LegsValues& rates) noexcept {
  const std::array<TrackedAxis, 6>& body = state.body;
  LeggedMotion motion{.angles = state.angles, .rates = rates};
  const Eigen::Matrix3d yawed =
      Eigen::AngleAxisd(body[Stance::kYaw].value, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  motion.linear = turned.transpose() * Eigen::Vector3d(body[0].speed, body[1].speed, body[2].speed);
  motion.angular = body[Stance::kRoll].speed * Eigen::Vector3d::UnitX() +
                   turned.transpose() * (body[Stance::kPitch].speed * yawed.col(1) +
                                         body[Stance::kYaw].speed * Eigen::Vector3d::UnitZ());
  motion.gravity = -kGravity * (turned.transpose() * Map(state.up.data()));
  return motion;
}

}  // namespace

Stance::Stance(const LegModel& robot, double period)
    : period_(period),
      legs_(robot.legs),
      tuning_(leg_tuning(robot)),
      ground_(robot.belly),
      nominal_(nominal_height(robot)),
      dynamics_(robot) {
  for (std::size_t i = 0; i < kLegsJoints; ++i) joint_steps_[i] = robot.joints[i].velocity_limit * period;
}

Stance::Pose Stance::pose(const State& state) noexcept {
  Pose result;
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = state.body[i].value;
  return result;
}

Eigen::Vector3d Stance::foot_in_base(const State& state, std::size_t leg, const Pose& pose,
                                     const Eigen::Matrix3d& turned) const noexcept {
  Eigen::Vector3d place = Map(state.places[leg].data());
  for (std::size_t i = 0; i < 3; ++i) {
    if (leg == state.lifted) place[i] += state.foot[i].value;
    place[i] -= pose[i];
  }
  return turned.transpose() * place;
}

double Stance::spare(const State& state, const Pose& pose) const noexcept {
  const Eigen::Matrix3d turned = rotation(pose);
  double result = std::numeric_limits<double>::infinity();
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    if (leg == state.lifted) continue;
    const LegKinematics& kinematics = legs_[leg].kinematics;
    const LegSolution solution = kinematics.inverse(foot_in_base(state, leg, pose, turned));
    if (solution.reach != FootReach::kReached) return -1;
    for (std::size_t i = 0; i < kLegJoints; ++i) {
      const double angle = solution.angles[i];
      const JointRange& range = kinematics.range(i);
      result = std::min({result, angle - range.lower, range.upper - angle});
    }
    const Eigen::Vector3d knee = turned * kinematics.knee(solution.angles);
    const double clear = pose[kZ] + knee.z() - ground_ - legs_[leg].knee_radius;
    result = std::min({result, std::abs(kinematics.bend(solution.angles)) - kMinBend, clear / kinematics.length()});
  }
  return result;
}

void Stance::set_angles(State& state, std::uint64_t& reasons) const noexcept {
  const Pose pose = this->pose(state);
  const Eigen::Matrix3d turned = rotation(pose);
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const LegSolution solution = legs_[leg].kinematics.inverse(foot_in_base(state, leg, pose, turned));
    if (solution.reach != FootReach::kReached) reasons |= kReasonOutOfReach;
    for (std::size_t i = 0; i < kLegJoints; ++i) {
      const std::size_t joint = kLegJoints * leg + i;
      double& angle = state.angles[joint];
      angle = std::clamp(solution.angles[i], angle - joint_steps_[joint], angle + joint_steps_[joint]);
    }
  }
}

Eigen::Vector2d Stance::above_support(const State& state) const noexcept {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero(), three = Eigen::Vector2d::Zero();
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const Eigen::Vector2d place = Map(state.places[leg].data()).head<2>();
    middle += place / kLegs;
    if (leg != state.lifted) three += place / (kLegs - 1);
  }
  if (state.lifted != kLegs) middle += kCentroidShare * (three - middle);
  const double height = nominal_ - ground_ + state.centre[2];  // of the centre of gravity
  return middle - Map(state.centre.data()).head<2>() + height / state.up[2] * Map(state.up.data()).head<2>();
}

void Stance::roll_feet(State& state, const LegsValues& rates) const noexcept {
  const Eigen::Matrix3d turned = rotation(pose(state));
  const Eigen::Vector3d body(state.body[kRoll].speed, state.body[kPitch].speed, state.body[kYaw].speed);
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    if (state.share[leg] == 0) continue;
    const LegGeometry& geometry = legs_[leg].kinematics.geometry();
    const double* rate = &rates[kLegJoints * leg];
    const double first = geometry.sign[0] * state.angles[kLegJoints * leg];
    const double pitching = geometry.sign[1] * rate[1] + geometry.sign[2] * rate[2];
    const Eigen::Vector3d shank =
        turned * Eigen::Vector3d(geometry.sign[0] * rate[0], pitching * std::cos(first), pitching * std::sin(first)) +
        body;
    state.places[leg][0] += shank.y() * legs_[leg].foot_radius * period_;
    state.places[leg][1] -= shank.x() * legs_[leg].foot_radius * period_;
  }
}

/// Filters the acceleration of the reference: Rᵀ p̈, ω̇, q̈.
void Stance::accelerate(State& state, const LeggedMotion& motion) const noexcept {
  std::array<double, kLeggedDofs> velocity{};
  Eigen::Map<Efforts>(velocity.data()) << motion.linear, motion.angular,
      Eigen::Map<const Eigen::Matrix<double, kLegsJoints, 1>>(motion.rates.data());
  for (std::size_t i = 0; i < velocity.size(); ++i) {
    const double change = (velocity[i] - state.velocity[i]) / period_;
    state.acceleration[i] += std::min(1.0, period_ / kAccelerationTime) * (change - state.acceleration[i]);
  }
  state.velocity = velocity;
}

void Stance::command(State& state, const LegsValues& rates, CommandFrame& out) const noexcept {
  roll_feet(state, rates);
  const Pose pose = this->pose(state);
  const Eigen::Matrix3d turned = rotation(pose);
  const LeggedMotion motion = reference_motion(state, turned, rates);
  LeggedEquations equations;
  dynamics_.step(motion, equations);
  Eigen::Map<Eigen::Vector3d>(state.centre.data()) = equations.centre_of_gravity;
  accelerate(state, motion);
  const Efforts efforts = equations.mass * Eigen::Map<const Efforts>(state.acceleration.data()) + equations.bias;
  FootForcesInput load{.share = state.share, .up = turned.row(2)};
  double carried = 0;
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    load.feet[leg] = foot_in_base(state, leg, pose, turned);
    carried += state.share[leg] / (kLegs - 1);
  }
  load.force = std::min(1.0, carried) * efforts.head<3>();
  load.moment = std::min(1.0, carried) * efforts.segment<3>(3);
  std::array<Eigen::Vector3d, kLegs> forces;
  forces.fill(Eigen::Vector3d::Zero());
  if (carried > 0) forces = foot_forces(load);
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const std::size_t first = kLegJoints * leg;
    Eigen::Vector3d foot;
    const Eigen::Matrix3d jacobian = legs_[leg].kinematics.jacobian(LegModel::angles_of(state.angles, leg), foot);
    const Eigen::Vector3d effort = efforts.segment<3>(6 + first) - jacobian.transpose() * forces[leg];
    for (std::size_t i = 0; i < kLegJoints; ++i)
      out.joints[first + i] = tuning_.impedance(state.angles[first + i], rates[first + i], effort[i]);
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    out.twist_limited.linear[axis] = state.body[axis].speed;
    out.twist_limited.angular[axis] = state.body[kRoll + axis].speed;
  }
}

}  // namespace robot_control

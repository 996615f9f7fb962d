/// The commands of each leg of a Walker: stance and swing.

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "control/legged/walk/swing.h"
#include "control/legged/walk/walker.h"

namespace robot_control {
namespace {

constexpr double kReachSpeed = 0.8;  // m/s, from which on a foot that bears is pushed down with less force
constexpr double kMetRiser = 0.03;   // m, by which a foot stays behind its path
constexpr double kHeldShare = 0.25;  // of its path's speed, below which a foot is held
constexpr double kBackOff = 0.02;    // m, from the riser
constexpr double kFirstLift = 0.1;   // of the swing
constexpr double kLastLift = 0.6;    // of the swing

using Map = Eigen::Map<Eigen::Vector3d>;
using ConstMap = Eigen::Map<const Eigen::Vector3d>;

double within(const JointRange& range, double angle) noexcept {
  return std::min(std::max(angle, range.lower + kFromEnd), range.upper - kFromEnd);
}

Eigen::Index joint_row(std::size_t leg) noexcept {
  return 6 + kLegJoints * leg;
}

}  // namespace

void Walker::bear(const State& state, const WalkingBody& body, std::size_t leg, CommandFrame& out) const noexcept {
  const Eigen::Vector3d own = body.equations.bias.segment<3>(joint_row(leg));
  const Eigen::Vector3d load =
      -body.jacobians[leg].transpose() * (body.turned.transpose() * ConstMap(state.forces[leg].data()));
  const Eigen::Map<const Eigen::Vector3d> rates(&body.rates[kLegJoints * leg]);
  const double falls =
      -body.turned.row(2).dot(body.jacobians[leg] * rates) / (kReachSpeed * std::sqrt(length_ / kReferenceLeg));
  if (falls > 1) out.legged.reaches |= 1U << leg;
  double part = std::clamp(2 - falls, 0.0, 1.0);
  for (std::size_t i = 0; i < kLegJoints; ++i) {
    const double room = effort_limits_[kLegJoints * leg + i] - std::copysign(own[i], own[i] * load[i]);
    if (std::abs(load[i]) > room) part = std::min(part, std::max(0.0, room) / std::abs(load[i]));
  }
  for (std::size_t i = 0; i < kLegJoints; ++i) {
    const std::size_t joint = kLegJoints * leg + i;
    const double ahead = body.angles[joint] + tuning_.damping / tuning_.stiffness * body.rates[joint];
    const double stop = tuning_.stiffness * (within(legs_[leg].kinematics.range(i), ahead) - ahead);
    const double limit = effort_limits_[joint];
    out.joints[joint] = {.mode = JointMode::kImpedance,
                         .position = body.angles[joint],
                         .effort = std::clamp(own[i] + part * load[i] + stop, -limit, limit)};
  }
}

SwingPoint Walker::path(const State& state, const WalkInput& input, const WalkingBody& body,
                        std::size_t leg) const noexcept {
  const Gait& gait = this->gait(state);
  const ConstMap from(state.departs[leg].data());
  const Eigen::Vector3d to = landing(state, input, body, leg);
  const double left = 1 - state.departed[leg], part = (gait.swung(leg, state.phase) - state.departed[leg]) / left;
  return swing_point(from, to, std::max(from.z(), to.z()) + gait.lift, part, left * gait.swing_time());
}

/// Begins another path for each foot that has met a riser.
void Walker::lift_again(State& state, const WalkInput& input, const WalkingBody& body) const noexcept {
  const double scale = length_ / kReferenceLeg;
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const double part = gait(state).swung(leg, state.phase);
    if (state.bears[leg] != 0 || part > kLastLift || part - state.departed[leg] < kFirstLift) continue;
    const SwingPoint point = path(state, input, body, leg);
    const Eigen::Vector3d behind = point.place - body.feet[leg];
    if (behind.head<2>().norm() < kMetRiser * scale) continue;
    const Eigen::Map<const Eigen::Vector3d> rates(&body.rates[kLegJoints * leg]);
    const Eigen::Vector3d moves =
        body.velocity + body.rate.cross(body.feet[leg]) + body.turned * body.jacobians[leg] * rates;
    const bool held =
        moves.head<2>().dot(behind.head<2>()) < kHeldShare * point.velocity.head<2>().dot(behind.head<2>());
    if (!held) continue;
    Map(state.departs[leg].data()) =
        body.feet[leg] - kBackOff * scale * Eigen::Vector3d(behind.x(), behind.y(), 0).normalized();
    state.departed[leg] = part;
  }
}

void Walker::swing(const State& state, const WalkInput& input, const WalkingBody& body, std::size_t leg,
                   CommandFrame& out) const noexcept {
  if (state.departed[leg] > kFirstLift) out.legged.risers |= 1U << leg;
  const SwingPoint point = path(state, input, body, leg);
  const LegKinematics& kinematics = legs_[leg].kinematics;
  const Eigen::Matrix3d back = body.turned.transpose();
  const LegSolution solution = kinematics.inverse(back * point.place);
  Eigen::Vector3d foot;
  const Eigen::Matrix3d jacobian = kinematics.jacobian(solution.angles, foot);
  const Eigen::Matrix3d inverse = jacobian.inverse();
  const Eigen::Vector3d rates = inverse * back * (point.velocity - body.velocity - body.rate.cross(point.place));
  const Eigen::Vector3d accelerations = inverse * back * point.acceleration;
  const Eigen::Index row = joint_row(leg);
  const Eigen::Vector3d efforts =
      body.equations.mass.block<3, 3>(row, row) * accelerations + body.equations.bias.segment<3>(row);
  for (std::size_t i = 0; i < kLegJoints; ++i) {
    const std::size_t joint = kLegJoints * leg + i;
    const double limit = effort_limits_[joint];
    const double angle = within(kinematics.range(i), solution.angles[i]);
    const double rate = angle == solution.angles[i] ? rates[i] : 0;
    out.joints[joint] = tuning_.impedance(angle, rate, std::clamp(efforts[i], -limit, limit));
  }
}

}  // namespace robot_control

#include "control/legged/walk/leg_use.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "control/legged/walk/swing.h"
#include "machine/gravity.h"

namespace robot_control {
namespace {

constexpr double kOutOfReach = std::numeric_limits<double>::infinity();
const Eigen::Vector3d kNoForce = Eigen::Vector3d::Zero();

}  // namespace

Eigen::Vector3d velocity_below(const Eigen::Vector3d& foot, const WalkingTwist& twist) noexcept {
  return {twist[2] * foot.y() - twist[0], -twist[2] * foot.x() - twist[1], 0};
}

LegUse::LegUse(const LegModel& robot, const NominalStance& stance) noexcept
    : feet_(stance.feet), centre_(stance.equations.centre_of_gravity), weight_(robot.mass * kGravity) {
  for (std::size_t leg = 0; leg < kLegs; ++leg) legs_[leg] = robot.legs[leg].kinematics;
  for (std::size_t i = 0; i < kLegsJoints; ++i) {
    speeds_[i] = robot.joints[i].velocity_limit;
    efforts_[i] = kEffortShare / kSpeedShare * robot.joints[i].effort_limit;
  }
}

LegUse::Place LegUse::place_of(const CarriedBody& body, const CarriedBody& rates) noexcept {
  if (body == CarriedBody{} && rates == CarriedBody{}) return {};
  using Axis = Eigen::AngleAxisd;
  return {
      .back = (Axis(-body[1], Eigen::Vector3d::UnitX()) * Axis(-body[2], Eigen::Vector3d::UnitY())).toRotationMatrix(),
      .height = body[0],
      .rises = rates[0],
      .turns = {rates[1] * std::cos(body[2]), rates[2], -rates[1] * std::sin(body[2])},
      .from_end = kFromEnd};
}

Eigen::Vector3d LegUse::placed(std::size_t leg, const WalkingTwist& twist, const CarriedBody& body) const noexcept {
  const double outwards = twist[2] * (centre_.z() - feet_[leg].z() + body[0]) / kGravity;
  return feet_[leg] - outwards * Eigen::Vector3d(-twist[1], twist[0], 0);
}

double LegUse::needed_at(std::size_t leg, const Place& body, const Eigen::Vector3d& place,
                         const Eigen::Vector3d& velocity, const Eigen::Vector3d& force) const noexcept {
  const LegKinematics& kinematics = legs_[leg];
  const Eigen::Vector3d turned = (body.back - Eigen::Matrix3d::Identity()) * (place - centre_);
  const std::optional<LegAngles> angles = kinematics.reached(place + turned - body.height * body.back.col(2));
  if (!angles || kinematics.stretch(*angles) > kLengthShare * kinematics.length()) return kOutOfReach;
  Eigen::Vector3d foot;
  const Eigen::Matrix3d jacobian = kinematics.jacobian(*angles, foot);
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d moves = velocity - body.turns.cross(place - centre_ - body.height * up) - body.rises * up;
  const Eigen::Vector3d rates = jacobian.inverse() * (body.back * moves);
  const Eigen::Vector3d efforts = jacobian.transpose() * (body.back * force);
  double part = 0;
  for (std::size_t i = 0; i < kLegJoints; ++i) {
    const std::size_t joint = kLegJoints * leg + i;
    const JointRange& range = kinematics.range(i);
    if ((*angles)[i] < range.lower + body.from_end || (*angles)[i] > range.upper - body.from_end) return kOutOfReach;
    part = std::max({part, std::abs(rates[i]) / speeds_[joint], std::abs(efforts[i]) / efforts_[joint]});
  }
  return part;
}

double LegUse::swinging(const Gait& gait, const WalkingTwist& twist, const CarriedBody& body, int samples,
                        const CarriedBody& rates) const noexcept {
  const Place at = place_of(body, rates);
  const double time = gait.swing_time(), half = gait.stance_time() / 2;
  double part = 0;
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const Eigen::Vector3d foot = placed(leg, twist, body);
    const Eigen::Vector3d velocity = velocity_below(foot, twist);
    const Eigen::Vector3d from = foot + half * velocity, to = foot - (half + time) * velocity;  // over ground
    for (int i = 0; i <= samples; ++i) {
      const double swung = static_cast<double>(i) / samples;
      const SwingPoint point = swing_point(from, to, foot.z() + gait.lift, swung, time);
      part = std::max(part,
                      needed_at(leg, at, point.place + swung * time * velocity, point.velocity + velocity, kNoForce));
    }
  }
  return part;
}

double LegUse::steady(const Gait& gait, const WalkingTwist& twist, const CarriedBody& body, int samples,
                      const CarriedBody& rates) const noexcept {
  const Place at = place_of(body, rates);
  const double half = gait.stance_time() / 2, force = weight_ / static_cast<double>(fewest_feet(gait));
  double part = swinging(gait, twist, body, samples, rates);
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const Eigen::Vector3d foot = placed(leg, twist, body);
    const Eigen::Vector3d velocity = velocity_below(foot, twist);
    const double high = centre_.z() - foot.z() + body[0];
    for (const double stood : {-half, 0.0, half}) {
      const Eigen::Vector3d moved = foot - feet_[leg] - stood * Eigen::Vector3d(twist[0], twist[1], 0);
      const Eigen::Vector3d through_centre = Eigen::Vector3d::UnitZ() - moved / high;
      part = std::max(part, needed_at(leg, at, foot + stood * velocity, velocity, force * through_centre));
    }
  }
  return part;
}

double LegUse::changing(const Gait& last, const Gait& next, const WalkingTwist& twist) const noexcept {
  const double begin = next.begins_after(last);
  double part = 0;
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const double stands = next.bears_for(leg, begin);
    if (stands == 0) continue;
    const double stood = last.period * (std::min(last.leg_phase(leg, 0), last.duty) - last.duty / 2);
    const Eigen::Vector3d velocity = velocity_below(feet_[leg], twist);
    part = std::max(part, needed_at(leg, {}, feet_[leg] + (stood + stands) * velocity, velocity, kNoForce));
  }
  return part;
}

}  // namespace robot_control

#include "machine/legs/lying_posture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "machine/bodies/shape_support.h"

namespace robot_control {
namespace {

constexpr double kScan = 0.01;  // rad
constexpr double kFine = 1e-6;  // rad

/// Returns the lowest point of the body's shapes in m of the base's axes, if the body is at `pose`.
double lowest(const RigidBody& body, const Eigen::Isometry3d& pose) {
  double height = std::numeric_limits<double>::infinity();
  const Eigen::Vector3d down = pose.linear().transpose() * Eigen::Vector3d(0, 0, -1);
  for (const Shape& shape : body.shapes) height = std::min(height, pose.translation().z() - support(shape, down));
  return height;
}

/// Returns the lowest point of thigh and shank.
double lowest(const RigidBodies& robot, const LegGeometry& geometry, const std::array<std::size_t, kLegJoints>& chain,
              const LegAngles& angles) {
  const Eigen::AngleAxisd first(geometry.sign[0] * angles[0], Eigen::Vector3d::UnitX());
  const Eigen::AngleAxisd second(geometry.sign[1] * angles[1], Eigen::Vector3d::UnitY());
  const Eigen::AngleAxisd third(geometry.sign[2] * angles[2], Eigen::Vector3d::UnitY());
  const Eigen::Quaterniond thigh = first * second, shank = thigh * third;
  const Eigen::Vector3d hip = geometry.hip + first * geometry.upper;
  const auto placed = [&](std::size_t index, const Eigen::Quaterniond& turn, const Eigen::Vector3d& origin) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = turn.toRotationMatrix() * robot.bodies[index].in_root.linear();
    pose.translation() = origin;
    return lowest(robot.bodies[index], pose);
  };
  return std::min(placed(chain[1], thigh, hip), placed(chain[2], shank, hip + thigh * geometry.lower));
}

}  // namespace

double belly_height(const RigidBodies& robot, const std::array<std::array<std::size_t, kLegJoints>, 4>& chains) {
  double height = lowest(robot.bodies[0], robot.bodies[0].in_root);
  for (const auto& chain : chains)
    height = std::min(height, lowest(robot.bodies[chain[0]], robot.bodies[chain[0]].in_root));
  return height;
}

LegAngles lying_posture(const RigidBodies& robot, const LegKinematics& kinematics,
                        const std::array<std::size_t, kLegJoints>& chain, double belly) {
  const LegGeometry& geometry = kinematics.geometry();
  LegAngles angles = LegAngles::Zero();
  angles[0] = std::clamp(0.0, geometry.range[0].lower, geometry.range[0].upper);
  // The knee folds towards the end of its range.
  const double straight = kinematics.bend(LegAngles::Zero());  // β at q₃ = 0
  const JointRange& knee = kinematics.range(2);
  const double centre = (knee.lower + knee.upper) / 2;
  const double wanted = geometry.sign[2] * (geometry.bend * kFold - straight);
  const double folded = centre + wrapped(wanted - centre);
  const double margin = std::min(kFromStop, (knee.upper - knee.lower) / 4);
  angles[2] = std::clamp(folded, knee.lower + margin, knee.upper - margin);
  // The thigh hangs down at θ₂ = hanging, and turns towards the side of the knee.
  const double hanging = wrapped(std::numbers::pi - std::atan2(geometry.lower.x(), geometry.lower.z()));
  const JointRange& thigh = kinematics.range(1);
  const double middle = std::isinf(thigh.lower) ? 0 : (thigh.lower + thigh.upper) / 2;
  const auto at = [&](double turn) {
    LegAngles result = angles;
    const double angle = geometry.sign[1] * (hanging - geometry.bend * turn);
    const double near = middle + wrapped(angle - middle);
    result[1] = std::clamp(near, std::isinf(thigh.lower) ? near : thigh.lower + kFromStop,
                           std::isinf(thigh.upper) ? near : thigh.upper - kFromStop);
    return result;
  };
  const auto height = [&](const LegAngles& folded_leg) { return lowest(robot, geometry, chain, folded_leg); };
  LegAngles best = at(0);
  for (double turn = kScan; turn <= std::numbers::pi / 2; turn += kScan) {
    const LegAngles tried = at(turn);
    if (height(tried) > height(best)) best = tried;
  }
  // The leg swings outwards as far as needed.
  const double outwards = geometry.sign[0] * (geometry.upper + geometry.lower + geometry.foot).y() > 0 ? 1 : -1;
  const double end = outwards > 0 ? kinematics.range(0).upper : -kinematics.range(0).lower;
  const auto swung = [&](double swing) {
    LegAngles result = best;
    result[0] = outwards * swing;
    return result;
  };
  const double begin = outwards * best[0];
  const double farthest = std::max(begin, std::min(end - kFromStop, std::numbers::pi / 2));
  double low = begin, high = begin;
  while (height(swung(high)) < belly && high < farthest) {
    low = high;
    high = std::min(farthest, high + kScan);
  }
  while (high - low > kFine) {
    const double half = (low + high) / 2;
    (height(swung(half)) < belly ? low : high) = half;
  }
  return swung(high);
}

}  // namespace robot_control

#include "machine/legs/lying_posture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "machine/bodies/shape_support.h"

namespace robot_control {
namespace {

constexpr double kScan = 0.01;    // rad
constexpr double kFine = 1e-3;    // rad
constexpr double kMaxTilt = 0.3;  // rad
constexpr double kHalfPi = std::numbers::pi / 2;

/// Returns how far the body's shapes reach along `down`, in m from the base, if the body is at `pose`.
double depth(const RigidBody& body, const Eigen::Isometry3d& pose, const Eigen::Vector3d& down) {
  double deepest = -std::numeric_limits<double>::infinity();
  const Eigen::Vector3d direction = pose.linear().transpose() * down;
  for (const Shape& shape : body.shapes)
    deepest = std::max(deepest, down.dot(pose.translation()) + support(shape, direction));
  return deepest;
}

/// Returns the same of the root body and of those that the legs' first joints move, at the zero pose.
double body_depth(const RigidBodies& robot, const LegChains& chains, const Eigen::Vector3d& down) {
  double deepest = depth(robot.bodies[0], robot.bodies[0].in_root, down);
  for (const auto& chain : chains)
    deepest = std::max(deepest, depth(robot.bodies[chain[0]], robot.bodies[chain[0]].in_root, down));
  return deepest;
}

/// Returns how far thigh and shank reach along `down`.
double leg_depth(const RigidBodies& robot, const LegGeometry& geometry,
                 const std::array<std::size_t, kLegJoints>& chain, const LegAngles& angles,
                 const Eigen::Vector3d& down) {
  const Eigen::AngleAxisd first(geometry.sign[0] * angles[0], Eigen::Vector3d::UnitX());
  const Eigen::AngleAxisd second(geometry.sign[1] * angles[1], Eigen::Vector3d::UnitY());
  const Eigen::AngleAxisd third(geometry.sign[2] * angles[2], Eigen::Vector3d::UnitY());
  const Eigen::Quaterniond thigh = first * second, shank = thigh * third;
  const Eigen::Vector3d hip = geometry.hip + first * geometry.upper;
  const auto placed = [&](std::size_t index, const Eigen::Quaterniond& turn, const Eigen::Vector3d& origin) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = turn.toRotationMatrix() * robot.bodies[index].in_root.linear();
    pose.translation() = origin;
    return depth(robot.bodies[index], pose, down);
  };
  return std::max(placed(chain[1], thigh, hip), placed(chain[2], shank, hip + thigh * geometry.lower));
}

/// Returns the angle of a knee that is bent by kFold, or as far as its range allows.
double folded_knee(const LegKinematics& kinematics) {
  const LegGeometry& geometry = kinematics.geometry();
  const double straight = kinematics.bend(LegAngles::Zero());  // β at q₃ = 0
  const JointRange& knee = kinematics.range(2);
  const double centre = (knee.lower + knee.upper) / 2;
  const double wanted = geometry.sign[2] * (geometry.bend * kFold - straight);
  const double folded = centre + wrapped(wanted - centre);  // towards the end of the range
  const double margin = std::min(kFromStop, (knee.upper - knee.lower) / 4);
  return std::clamp(folded, knee.lower + margin, knee.upper - margin);
}

/// Returns the angle of a thigh that hangs down.
double hanging(const LegGeometry& geometry) {
  return geometry.sign[1] * wrapped(std::numbers::pi - std::atan2(geometry.lower.x(), geometry.lower.z()));
}

/// Returns the angle of a thigh that has turned from hanging down towards the side of the knee.
double thigh_at(const LegKinematics& kinematics, double turn) {
  const LegGeometry& geometry = kinematics.geometry();
  const JointRange& thigh = kinematics.range(1);
  const double middle = std::isinf(thigh.lower) ? 0 : (thigh.lower + thigh.upper) / 2;
  const double angle = hanging(geometry) - geometry.sign[1] * geometry.bend * turn;
  const double near = middle + wrapped(angle - middle);
  return std::clamp(near, std::isinf(thigh.lower) ? near : thigh.lower + kFromStop,
                    std::isinf(thigh.upper) ? near : thigh.upper - kFromStop);
}

}  // namespace

Belly belly_of(const RigidBodies& robot, const LegChains& chains) {
  const RigidBody& root = robot.bodies[0];
  const Eigen::Vector3d centre = root.in_root * root.centre_of_gravity;
  const auto tilted = [](double pitch) { return Eigen::Vector3d(std::sin(pitch), 0, -std::cos(pitch)); };
  const auto height = [&](double pitch) {  // of the centre of gravity
    return body_depth(robot, chains, tilted(pitch)) - tilted(pitch).dot(centre);
  };
  double pitch = 0;
  for (const double step : {kFine, -kFine}) {
    while (std::abs(pitch + step) <= kMaxTilt && height(pitch + step) < height(pitch)) pitch += step;
  }
  return {.height = -body_depth(robot, chains, tilted(0)),
          .down = tilted(pitch),
          .depth = body_depth(robot, chains, tilted(pitch))};
}

double knee_radius(const RigidBodies& robot, const LegKinematics& kinematics,
                   const std::array<std::size_t, kLegJoints>& chain) {
  const LegGeometry& geometry = kinematics.geometry();
  const double straight = kinematics.bend(LegAngles::Zero());  // β at q₃ = 0
  const LegAngles angles(0, hanging(geometry), geometry.sign[2] * (geometry.bend * kHalfPi - straight));
  return leg_depth(robot, geometry, chain, angles, -Eigen::Vector3d::UnitZ()) + kinematics.knee(angles).z();
}

LegAngles lying_posture(const RigidBodies& robot, const LegKinematics& kinematics,
                        const std::array<std::size_t, kLegJoints>& chain, const Belly& belly) {
  const LegGeometry& geometry = kinematics.geometry();
  const double outwards = geometry.sign[0] * (geometry.upper + geometry.lower + geometry.foot).y() > 0 ? 1 : -1;
  const double end = outwards > 0 ? kinematics.range(0).upper : -kinematics.range(0).lower;
  const double begin = outwards * std::clamp(0.0, geometry.range[0].lower, geometry.range[0].upper);
  const double farthest = std::max(begin, std::min(end - kFromStop, kHalfPi));
  LegAngles angles(outwards * begin, 0, folded_knee(kinematics));
  const auto height = [&](double turn) {
    angles[1] = thigh_at(kinematics, turn);
    return -leg_depth(robot, geometry, chain, angles, belly.down);
  };

  double turn = 0, highest = height(0);
  for (double tried = kScan; tried <= kHalfPi; tried += kScan) {
    if (const double reached = height(tried); reached > highest) turn = tried, highest = reached;
  }
  for (double swing = begin; swing <= farthest; swing += kScan) {
    angles[0] = outwards * swing;
    highest = height(turn);
    for (const double step : {kScan, -kScan}) {
      for (double tried = turn + step; tried >= 0 && tried <= kHalfPi; tried += step) {
        const double reached = height(tried);
        if (reached <= highest) break;
        turn = tried, highest = reached;
      }
    }
    if (highest >= -belly.depth) break;
  }
  angles[1] = thigh_at(kinematics, turn);
  return angles;
}

}  // namespace robot_control

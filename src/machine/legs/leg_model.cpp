#include "machine/legs/leg_model.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "machine/bodies/posed_bodies.h"
#include "machine/bodies/rigid_bodies.h"
#include "machine/bodies/rolling.h"
#include "machine/bodies/shape_support.h"
#include "machine/description/wording.h"
#include "machine/legs/leg_chains.h"
#include "machine/legs/lying_posture.h"
#include "machine/machine_reading.h"
#include "machine/model_hash.h"
#include "machine/suspicions.h"
#include "signals/formatted_text.h"

namespace robot_control {
namespace {

struct Foot {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< m, base axes at the zero pose
  double radius = 0;                                 ///< m; 0: no ball
};

constexpr double kSameReach = 0.005;  // m by which another shape may reach beyond a ball

/// A ball has its own radius, and so has a cylinder across the leg.
double foot_radius(const RigidBody& body, const Shape& shape) {
  if (shape.type == ShapeType::kSphere) return shape.radius;
  if (shape.type != ShapeType::kCylinder) return 0;
  const Eigen::Vector3d axle = body.in_root.linear() * shape.in_body.linear().col(2);
  return std::abs(axle.y()) >= std::cos(kAxleTolerance) ? shape.radius : 0;
}

/// Returns the foot at the end of the leg whose last body is `body`. Throws RobotError if it has no shape.
Foot foot_of(const RigidBodies& robot, const RigidBody& body) {
  const Shape* ball = nullptr;
  const Shape* farthest = nullptr;
  double ball_reach = 0, reach = -std::numeric_limits<double>::infinity();
  for (const Shape& shape : body.shapes) {
    const Eigen::Vector3d centre = shape.in_body.translation();
    const Eigen::Vector3d out = centre.norm() > 0 ? centre.normalized() : Eigen::Vector3d(0, 0, -1);
    const double reaches = support(shape, out);
    if (reaches > reach) {
      reach = reaches;
      farthest = &shape;
    }
    if (foot_radius(body, shape) > 0 && (ball == nullptr || reaches > ball_reach)) {
      ball_reach = reaches;
      ball = &shape;
    }
  }
  if (farthest == nullptr) {
    refuse(robot.source, link_element(body.name), "the leg that ends here has no shape",
           "Add a <collision> for the foot, best a <sphere>, to this link or to one fixed to it");
  }
  if (ball != nullptr && ball_reach >= reach - kSameReach)
    return {body.in_root * ball->in_body.translation(), foot_radius(body, *ball)};
  const Eigen::Vector3d centre = farthest->in_body.translation();
  const Eigen::Vector3d out = centre.norm() > 0 ? centre.normalized() : Eigen::Vector3d(0, 0, -1);
  return {body.in_root * (reach * out), 0};
}

constexpr double kMinBendBothWays = 0.5;  // rad by which a knee must bend to either side to bend both ways
constexpr double kStanding = 0.7;         // of the leg length, as high as most robots stand (leg_tuning.h)
constexpr double kShortest = 1e-4;        // m, of thigh and shank
constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kTurns = 4 * std::numbers::pi;  // rad, at most either way, of a joint of a leg that has end stops

using Chain = std::array<std::size_t, kLegJoints>;

/// Returns the chains by LegPlace.
std::array<Chain, kLegs> placed(const RigidBodies& robot, const std::vector<BodyChain>& chains,
                                const std::vector<Foot>& feet) {
  double middle = 0;
  for (const BodyChain& chain : chains) middle += robot.bodies[chain.bodies[0]].in_root.translation().x() / kLegs;
  std::array<Chain, kLegs> result{};
  std::array<std::string, kLegs> ends;
  for (std::size_t i = 0; i < kLegs; ++i) {
    const BodyChain& chain = chains[i];
    const bool front = robot.bodies[chain.bodies[0]].in_root.translation().x() > middle;
    const bool left = feet[i].centre.y() > 0;
    const std::size_t place = (front ? 0u : 2u) + (left ? 0u : 1u);
    const std::string& end = robot.bodies[chain.bodies[2]].name;
    if (!ends[place].empty()) {
      refuse(robot.source, link_element(end),
             std::string("this leg and that to ") + ends[place] + " are both " + name_of(static_cast<LegPlace>(place)),
             "Move the joints: each corner has one leg, hips before and behind their mean x, feet left (y > 0) and "
             "right (y < 0)");
    }
    ends[place] = end;
    std::copy_n(chain.bodies.begin(), kLegJoints, result[place].begin());
  }
  return result;
}

std::size_t joints_on_limbs(const RigidBodies& robot) {
  std::size_t joints = 0;
  for (const BodyChain& limb : limbs_of(robot)) joints += limb.bodies.size();
  return joints;
}

JointRange range_of(const BodyJoint& joint) {
  if (!(joint.lower < joint.upper)) return {-kInfinite, kInfinite};
  return {joint.lower, joint.upper};
}

LegGeometry geometry_of(const RigidBodies& robot, const Chain& chain, const Eigen::Vector3d& foot) {
  LegGeometry geometry;
  const auto origin = [&](std::size_t i) -> Eigen::Vector3d { return robot.bodies[chain[i]].in_root.translation(); };
  geometry.hip = origin(0);
  geometry.upper = origin(1) - origin(0);
  geometry.lower = origin(2) - origin(1);
  geometry.foot = foot - origin(2);
  for (std::size_t i = 0; i < kLegJoints; ++i) {
    const RigidBody& body = robot.bodies[chain[i]];
    geometry.sign[i] = axis_in_base(body)[leg_axis(i)] > 0 ? 1 : -1;
    geometry.range[i] = range_of(body.joint);
  }
  for (const auto& [part, body] : {std::pair{geometry.lower, chain[1]}, std::pair{geometry.foot, chain[2]}}) {
    if (std::hypot(part.x(), part.z()) >= kShortest) continue;
    refuse(robot.source, link_element(robot.bodies[body].name),
           "this part of the leg has the length 0 to the next joint, or to the foot",
           "Set the origins of the joints and the position of the foot in m");
  }
  return geometry;
}

LegKinematics bent(LegGeometry geometry, double bend) {
  geometry.bend = bend;
  return LegKinematics(geometry);
}

/// Returns the part of the knee's range that bends it to the side of `bend`, in rad.
double room(const LegGeometry& geometry, double bend) {
  const JointRange range = bent(geometry, bend).range(2);
  return range.upper - range.lower;
}

/// Returns whether the ranges of thigh and knee let the leg stand on a foot below its second joint, bent to this side.
bool stands(const LegGeometry& geometry, double bend) {
  const LegKinematics leg = bent(geometry, bend);
  const Eigen::Vector3d below(0, geometry.lower.y() + geometry.foot.y(), -kStanding * leg.length());
  return leg.reached(geometry.hip + geometry.upper + below).has_value();
}

using Geometries = std::array<LegGeometry, kLegs>;
using Bends = std::array<double, kLegs>;

double towards_the_middle(std::size_t leg) {
  return leg < 2 ? -1 : 1;
}

double derived_bend(const LegGeometry& geometry, double middle) {
  const double forward = room(geometry, 1), backward = room(geometry, -1);
  if (std::min(forward, backward) < kMinBendBothWays) return forward >= backward ? 1 : -1;
  return !stands(geometry, middle) && stands(geometry, -middle) ? -middle : middle;
}

const char* side_of(double bend) {
  return bend > 0 ? "forward" : "backward";
}

const std::string& knee_of(const RigidBodies& robot, const Chain& chain) {
  return robot.bodies[chain[2]].joint.name;
}

/// Both knees of a pair, front or rear, point to one side. If the ranges do not allow that, one of them is mirrored.
Bends paired(const RigidBodies& robot, const Geometries& geometries, const std::array<Chain, kLegs>& places,
             Bends bends) {
  if (bends[0] == bends[1] && bends[2] == bends[3]) return bends;
  const auto allowed = [&](double front, double rear) {
    for (std::size_t leg = 0; leg < kLegs; ++leg) {
      const double bend = leg < 2 ? front : rear;
      if (bend != bends[leg] && room(geometries[leg], bend) < kMinBendBothWays) return false;
    }
    return true;
  };
  for (const auto& [front, rear] : {std::pair{-1.0, 1.0}, {-1.0, -1.0}, {1.0, 1.0}, {1.0, -1.0}}) {
    if (allowed(front, rear)) return {front, front, rear, rear};
  }
  const double majority = bends[0] + bends[1] + bends[2] + bends[3];
  std::size_t odd = bends[0] != bends[1] ? 1 : 3;  // of the pair that differs, and the one that differs from the others
  if (bends[odd] * majority > 0) --odd;
  const std::string others = majority == 0 ? knee_of(robot, places[odd - 1]) + " points " : "the other three point ";
  refuse(robot.source, joint_element(knee_of(robot, places[odd])),
         std::string("the range of this knee allows it to point only ") + side_of(bends[odd]) + ", but " + others +
             side_of(-bends[odd]),
         "Mirror its <limit lower=\"…\" upper=\"…\"/> or its <axis xyz=\"…\">");
}

Bends bends_of(const RigidBodies& robot, const Geometries& geometries, const std::array<Chain, kLegs>& places,
               KneeBend wanted) {
  Bends bends{};
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const double middle = towards_the_middle(leg);
    if (wanted == KneeBend::kDerived) {
      bends[leg] = derived_bend(geometries[leg], middle);
      continue;
    }
    const bool forward = wanted == KneeBend::kForward || wanted == (leg < 2 ? KneeBend::kOutwards : KneeBend::kMiddle);
    bends[leg] = forward ? 1 : -1;
    if (room(geometries[leg], bends[leg]) >= kMinBendBothWays) continue;
    refuse(robot.source, joint_element(knee_of(robot, places[leg])),
           std::string("robot.knee_bend requires this knee to point ") + side_of(bends[leg]) +
               ", but its range does not allow this",
           "Remove robot.knee_bend, or set the other side");
  }
  return wanted == KneeBend::kDerived ? paired(robot, geometries, places, bends) : bends;
}

void require_limits(const RigidBodies& robot, const BodyJoint& joint) {
  if (const double end = std::max(std::abs(joint.lower), std::abs(joint.upper)); end > kTurns && end <= 360) {
    refuse(robot.source, joint_element(joint.name),
           "its range of " + number(joint.lower) + " to " + number(joint.upper) + " rad looks like degrees",
           "Set lower and upper in rad");
  }
  if (joint.effort_limit > 0 && joint.velocity_limit > 0) return;
  refuse(robot.source, joint_element(joint.name),
         std::string("the leg joint has no ") + (joint.effort_limit > 0 ? "velocity" : "effort") + " limit",
         "Set <limit effort=\"…\" velocity=\"…\"/> in N·m and rad/s, from the data sheet of the drive");
}

void refuse_massless_limbs(const RobotDescription& description, const RigidBodies& bodies,
                           const std::vector<BodyChain>& chains) {
  if (chains.size() == kLegs || bodies.massless.empty()) return;
  if (joints_on_limbs(read_moving_bodies(description)) <= joints_on_limbs(bodies)) return;
  refuse(bodies.source, "<robot>",
         "almost a quadruped: these links have no <inertial> and count as fixed: " + list(bodies.massless),
         "Add to each link of a leg its <inertial> with <mass> and <inertia>");
}

}  // namespace

const char* name_of(LegPlace place) noexcept {
  constexpr std::array<const char*, kLegs> kNames{"front_left", "front_right", "rear_left", "rear_right"};
  return kNames[static_cast<std::size_t>(place)];
}

std::string LegModel::parts() const {
  return formatted("four legs of %.4g m", leg_length());
}

double LegModel::leg_length() const noexcept {
  double length = kInfinite;
  for (const Leg& leg : legs) length = std::min(length, leg.kinematics.length());
  return length;
}

double usual_rotor_inertia(double mass, double leg_length) noexcept {
  return 0.01 * mass / kReferenceMass * leg_length * leg_length / (kReferenceLeg * kReferenceLeg);
}

const LegModel& leg_model_of(const MachineModel& machine) {
  const auto* const legged = dynamic_cast<const LegModel*>(&machine);
  if (legged == nullptr) throw RobotError(machine.source + ": this robot has no legs");
  return *legged;
}

LegModel read_legs(const RobotDescription& description, const MachineParameters& parameters,
                   const LegParameters& legs) {
  const auto bodies = std::make_shared<const RigidBodies>(read_rigid_bodies(description));
  refuse_too_many_joints(*bodies);
  const std::vector<BodyChain> chains = leg_chains(*bodies);
  refuse_massless_limbs(description, *bodies, chains);
  refuse_other_chains(*bodies, chains);
  std::vector<Foot> feet;
  for (const BodyChain& chain : chains) feet.push_back(foot_of(*bodies, bodies->bodies[chain.bodies.back()]));
  const std::array<Chain, kLegs> places = placed(*bodies, chains, feet);

  LegModel model;
  static_cast<MachineModel&>(model) = named_machine(description, *bodies);
  ModelHash hash;
  hash.add(description.text);
  hash.add(parameters);
  hash.add(std::optional<double>(static_cast<double>(legs.knee_bend)));
  hash.add(legs.leg_rotor_inertia);
  model.hash = hash.value();
  const Belly belly = belly_of(*bodies, places);
  if (!std::isfinite(belly.height)) {
    refuse(bodies->source, link_element(bodies->bodies[0].name),
           "a robot on legs lies on its body, but this has no shape", "Add a <collision>");
  }
  model.belly = belly.height;
  model.lying_pitch = std::atan2(belly.down.x(), -belly.down.z());
  Geometries geometries;
  for (std::size_t i = 0; i < kLegs; ++i) {
    for (const std::size_t index : places[i]) {
      const RigidBody& body = bodies->bodies[index];
      require_limits(*bodies, body.joint);
      model.joints.push_back(joint_model(*bodies, body, JointRole::kDriven));
    }
    const RigidBody& last = bodies->bodies[places[i][2]];
    const Foot foot = foot_of(*bodies, last);
    geometries[i] = geometry_of(*bodies, places[i], foot.centre);
    model.legs[i].foot_radius = foot.radius;
    model.contacts.push_back(last.name);
  }
  const Bends bends = bends_of(*bodies, geometries, places, legs.knee_bend);
  for (std::size_t i = 0; i < kLegs; ++i) {
    model.legs[i].kinematics = bent(geometries[i], bends[i]);
    model.legs[i].knee_radius = knee_radius(*bodies, model.legs[i].kinematics, places[i]);
    model.legs[i].lying = lying_posture(*bodies, model.legs[i].kinematics, places[i], belly);
    for (std::size_t j = 0; j < kLegJoints; ++j)
      model.joints[kLegJoints * i + j].rest_position = model.legs[i].lying[j];
  }
  read_masses(resting(*bodies, model.joints), parameters, model.leg_length(), model);
  model.rotor_inertia = legs.leg_rotor_inertia.value_or(usual_rotor_inertia(model.mass, model.leg_length()));
  for (JointModel& joint : model.joints) joint.rotor_inertia = model.rotor_inertia;
  read_imu(*bodies, parameters, model.leg_length(), model);
  model.bodies = bodies;
  note_suspicious_bodies(model);
  model.notes = merged(model.notes);
  return model;
}

}  // namespace robot_control

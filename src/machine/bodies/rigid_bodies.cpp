#include "machine/bodies/rigid_bodies.h"

#include <urdf_model/model.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "machine/bodies/body_joint.h"
#include "machine/bodies/gyration.h"
#include "machine/bodies/kdl_tree.h"
#include "machine/bodies/link_inertia.h"
#include "machine/bodies/link_shapes.h"
#include "machine/bodies/rolling.h"
#include "machine/description/urdf_document.h"
#include "machine/description/wording.h"

namespace robot_control {
namespace {

struct LumpedBodies {
  RigidBodies robot;
  std::vector<bool> weighed;  ///< per body: one of its links has an <inertial>
};

Eigen::Matrix3d solid_inertia(const RigidBody& body, const RollingMeasure& measure, double mass) {
  if (!measure.objection.empty()) return 0.4 * mass * kBallRadius * kBallRadius * Eigen::Matrix3d::Identity();
  const double radius = measure.radius;
  const double across = mass * (3 * radius * radius + measure.width * measure.width) / 12;
  const Eigen::Matrix3d along = body.joint.axis * body.joint.axis.transpose();
  return across * (Eigen::Matrix3d::Identity() - along) + mass * radius * radius / 2 * along;
}

/// Returns the joints of massless bodies that carry nothing which rolls.
std::set<std::string> idle_massless_joints(const LumpedBodies& lumped) {
  const std::vector<RigidBody>& bodies = lumped.robot.bodies;
  std::vector<bool> needed(bodies.size(), false);
  for (std::size_t i = bodies.size(); i-- > 1;) {
    needed[i] = needed[i] || measure_wheel(bodies[i]).objection.empty();
    if (needed[i]) needed[bodies[i].parent] = true;
  }
  std::set<std::string> idle;
  for (std::size_t i = 1; i < bodies.size(); ++i) {
    if (!lumped.weighed[i] && !needed[i]) idle.insert(bodies[i].joint.name);
  }
  return idle;
}

/// Gives the other massless bodies their share of the parent's mass; the sum stays. Throws RobotError if a base without
/// mass carries something that moves, or if the <mass> of a moving body is zero.
void assign_massless_inertia(LumpedBodies& lumped) {
  RigidBodies& robot = lumped.robot;
  if (robot.bodies.size() > 1 && !(robot.bodies[0].mass > 0)) {
    refuse(robot.source, link_element(robot.bodies[0].name), "neither it nor any link fixed to it has a mass",
           "Add an <inertial> with <mass> and <inertia>");
  }
  for (std::size_t i = 1; i < robot.bodies.size(); ++i) {
    RigidBody& body = robot.bodies[i];
    if (body.mass > 0) continue;
    if (lumped.weighed[i]) {
      refuse(robot.source, link_element(body.name), "it moves, but its mass is zero",
             "Set <mass value=\"kg\"/> above zero and an <inertia>, or make joint \"" + body.joint.name + "\" fixed");
    }
    RigidBody& parent = robot.bodies[body.parent];
    const RollingMeasure measure = measure_wheel(body);
    body.mass = kMasslessShare * parent.mass;
    body.centre_of_gravity = measure.objection.empty() ? measure.centre_in_body : Eigen::Vector3d::Zero();
    body.inertia = solid_inertia(body, measure, body.mass);
    parent.mass -= body.mass;
    parent.inertia *= 1 - kMasslessShare;
    robot.notes.push_back(
        {RobotNote::Kind::kAssumed, link_element(body.name),
         "it moves, but has no <inertial>: " + number(body.mass) + " kg taken from \"" + parent.name + "\""});
  }
}

constexpr std::size_t kNamed = 3;     // files in a note
constexpr std::size_t kMaxChain = 3;  // number of followers in a chain

class Lumper {
 public:
  /// `largest` (m) bounds the radius of gyration of a link.
  Lumper(const UrdfDocument& document, const RobotDescription& description, double endless,
         const std::set<std::string>& welded, double largest)
      : document_(document),
        description_(description),
        endless_(endless),
        welded_(welded),
        largest_(largest),
        frames_(links_at_zero(kdl_tree(document))) {
    result_.name = document.model->getName();
    result_.source = document.source;
    result_.link_order = document.link_order;
    result_.driven_joints = document.driven;
    result_.unsaid_axes = document.unsaid_axes;
    note_free_root();
    note_turned_origins();
    result_.sideways_names = document.sideways_names;
    result_.sideways_plugins = document.sideways_plugins;
    result_.steering_plugins = document.steering_plugins;
    const auto& links = document.model->links_;
    const auto has_collision = [](const auto& link) { return !link.second->collision_array.empty(); };
    collides_ = std::any_of(links.begin(), links.end(), has_collision);
    if (!collides_)
      add_note(RobotNote::Kind::kAssumed, "<robot>", "no <collision> anywhere: the <visual> shapes are used");
  }

  LumpedBodies lump() {
    add_body(*document_.model->getRoot(), 0, {});
    note_missing_visuals();
    for (std::size_t body = 1; body < result_.bodies.size(); ++body) add_visual_wheel(body);
    for (const std::string& name : document_.joint_order) {
      const RigidBody* moved = result_.moved_by(name);
      result_.joints[name] = moved != nullptr ? moved->joint.type : JointType::kFixed;
      if (moved != nullptr) result_.moving_joints.push_back(name);
    }
    check_mimics();
    return {std::move(result_), std::move(weighed_)};
  }

 private:
  void add_note(RobotNote::Kind kind, const std::string& element, const std::string& text) {
    result_.notes.push_back({kind, element, text});
  }

  void add_body(const urdf::Link& link, std::size_t parent, const BodyJoint& joint) {
    RigidBody body;
    body.name = link.name;
    body.parent = parent;
    body.joint = joint;
    body.in_root = frames_.at(link.name);
    result_.bodies.push_back(body);
    weighed_.push_back(false);
    add_link(link, result_.bodies.size() - 1);
  }

  void add_link(const urdf::Link& link, std::size_t body) {
    const Eigen::Isometry3d in_body = result_.bodies[body].in_root.inverse() * frames_.at(link.name);
    result_.links[link.name] = {body, in_body};
    add_mass(link, body, in_body);
    add_shapes(link, collides_ ? ShapeSource::kCollision : ShapeSource::kVisual, body, in_body);
    for (const std::string& name : document_.joint_order) {
      const urdf::Joint& joint = *document_.model->getJoint(name);
      if (joint.parent_link_name != link.name) continue;
      const urdf::Link& child = *document_.model->getLink(joint.child_link_name);
      if (joint.type == urdf::Joint::FIXED || welded_.contains(name)) {
        add_link(child, body);
      } else {
        BodyJoint moving = read_joint(joint, document_.source, endless_, result_.notes);
        moving.driven = document_.driven.contains(name);
        add_body(child, body, moving);
      }
    }
  }

  void add_mass(const urdf::Link& link, std::size_t body, const Eigen::Isometry3d& in_body) {
    RigidBody& target = result_.bodies[body];
    weighed_[body] = weighed_[body] || link.inertial;
    PointInertia part = inertia_of(link, in_body, document_.source, result_.notes);
    const double gyration = gyration_radius(link);
    if (gyration > largest_) {
      part.inertia *= std::pow(largest_ / gyration, 2);
      add_note(RobotNote::Kind::kRepaired, link_element(link.name),
               "a radius of gyration of " + number(gyration) + " m, but the size of the whole robot is " +
                   number(largest_) + " m: inertia reduced to that size");
    }
    const PointInertia both = sum({target.mass, target.centre_of_gravity, target.inertia}, part);
    target.mass = both.mass;
    target.centre_of_gravity = both.centre;
    target.inertia = both.inertia;
  }

  void add_shapes(const urdf::Link& link, ShapeSource which, std::size_t body, const Eigen::Isometry3d& in_body) {
    // A wheel needs its shape. Other missing shapes are judged when the rest is known (tipping.h).
    const bool needed = which == ShapeSource::kVisual || may_roll(result_.bodies[body]);
    std::vector<Shape> shapes =
        shapes_of(link, which, in_body, description_, result_.notes, needed ? nullptr : &result_.missing_meshes);
    if (which == ShapeSource::kCollision) {
      for (const std::string& file : missing_visuals(link, description_))
        missing_visuals_.emplace_back(link.name, file);
    }
    if (gyration_radius(link) <= largest_) note_gyration(link, shapes, result_.notes);
    std::move(shapes.begin(), shapes.end(), std::back_inserter(result_.bodies[body].shapes));
  }

  static bool may_roll(const RigidBody& body) {
    return body.joint.type == JointType::kContinuous && turns_upright(body);
  }

  void add_visual_wheel(std::size_t index) {
    RigidBody& body = result_.bodies[index];
    if (!body.shapes.empty() || !turns_upright(body)) return;
    try {
      for (const auto& [name, place] : result_.links) {
        if (place.body == index) {
          add_shapes(*document_.model->getLink(name), ShapeSource::kVisual, index, place.in_body);
        }
      }
    } catch (const RobotError& error) {
      add_note(RobotNote::Kind::kIgnored, link_element(body.name),
               std::string("no <collision>, and its <visual> cannot be used: ") + error.what());
      body.shapes.clear();
    }
    if (body.shapes.empty()) return;
    if (measure_wheel(body).objection.empty()) {
      add_note(RobotNote::Kind::kAssumed, link_element(body.name),
               "no <collision>: the <visual> shape of the wheel is used");
    } else {
      body.shapes.clear();
    }
  }

  void note_free_root() {
    const FreeRoot& root = document_.free_root;
    if (root.type.empty()) return;
    add_note(RobotNote::Kind::kIgnored, joint_element(root.joint),
             "type=\"" + root.type + "\" on the empty root link " + root.link +
                 " marks the robot as free: " + root.base + " is its base, and the joint's origin is not used");
  }

  void note_turned_origins() {
    for (const auto& [element, rpy] : document_.turned_origins) {
      add_note(RobotNote::Kind::kSuspicious, element,
               "<origin rpy=\"" + rpy + "\"> is more than a whole turn: is it in degrees? A URDF's angles are radians");
    }
    for (const std::string& name : document_.joint_order) {
      if (document_.turned_origins.contains(joint_element(name))) result_.turned_joints.insert(name);
    }
  }

  /// Notes the missing files that RViz would draw, before wheels are measured, because wheels may use these shapes.
  void note_missing_visuals() {
    if (missing_visuals_.empty()) return;
    std::string files;
    for (std::size_t i = 0; i < std::min(missing_visuals_.size(), kNamed); ++i) {
      files += (i == 0 ? "" : ", ") + missing_visuals_[i].second;
    }
    if (missing_visuals_.size() > kNamed) files += " and " + std::to_string(missing_visuals_.size() - kNamed) + " more";
    add_note(RobotNote::Kind::kSuspicious, link_element(missing_visuals_.front().first),
             "<visual>: file not found, so it is not drawn: " + files);
  }

  void check_mimics() {
    for (std::size_t round = 0; round < kMaxChain; ++round) {
      for (RigidBody& body : result_.bodies) {
        const RigidBody* leader = result_.moved_by(body.joint.mimicked);
        if (leader != nullptr && leader->joint.driven) body.joint.driven = true;
      }
    }
    for (RigidBody& body : result_.bodies) {
      BodyJoint& joint = body.joint;
      if (joint.mimicked.empty()) continue;
      const RigidBody* leader = result_.moved_by(joint.mimicked);
      if (leader != nullptr && leader->joint.mimicked.empty()) continue;
      add_note(
          RobotNote::Kind::kIgnored, joint_element(joint.name),
          "<mimic joint=\"" + joint.mimicked +
              (leader == nullptr ? "\">: no moving joint has this name" : "\">: that joint is itself a mimic joint"));
      joint.mimicked.clear();
    }
  }

  const UrdfDocument& document_;
  const RobotDescription& description_;
  double endless_;
  const std::set<std::string>& welded_;
  double largest_;
  std::map<std::string, Eigen::Isometry3d> frames_;
  bool collides_ = true;
  RigidBodies result_;
  std::vector<bool> weighed_;
  std::vector<std::pair<std::string, std::string>> missing_visuals_;  // link, file
};

template <typename Matrix>
bool of_this_world(const Matrix& m) {
  return (m.array().abs() < kMaxPlausible).all();  // also false for not-a-number
}

bool of_this_world(const RigidBody& body) {
  const auto shape_is = [](const Shape& shape) {
    const Eigen::Vector3d sizes(shape.radius, shape.length, shape.size.norm());
    const auto point_is = [](const Eigen::Vector3d& point) { return of_this_world(point); };
    return of_this_world(shape.in_body.matrix()) && of_this_world(sizes) &&
           std::all_of(shape.points.begin(), shape.points.end(), point_is);
  };
  return std::abs(body.mass) < kMaxPlausible && of_this_world(body.centre_of_gravity) && of_this_world(body.inertia) &&
         of_this_world(body.in_root.matrix()) && std::all_of(body.shapes.begin(), body.shapes.end(), shape_is);
}

}  // namespace

const RigidBody* RigidBodies::moved_by(const std::string& joint) const {
  for (const RigidBody& body : bodies) {
    if (body.joint.type != JointType::kRoot && body.joint.name == joint) return &body;
  }
  return nullptr;
}

double total_mass(const RigidBodies& robot) {
  double mass = 0;
  for (const RigidBody& body : robot.bodies) mass += body.mass;
  return mass;
}

RigidBodies read_moving_bodies(const RobotDescription& description) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return Lumper(parse_urdf(description), description, kInfinity, {}, kInfinity).lump().robot;
}

RigidBodies read_rigid_bodies(const RobotDescription& description, double endless) {
  const UrdfDocument document = parse_urdf(description);
  LumpedBodies lumped = Lumper(document, description, endless, {}, std::numeric_limits<double>::infinity()).lump();
  const std::set<std::string> idle = idle_massless_joints(lumped);
  const double size = robot_size(lumped.robot);
  std::vector<std::string> massless;
  for (const std::string& joint : idle) massless.push_back(lumped.robot.moved_by(joint)->name);
  const auto& links = document.model->links_;
  const auto too_large = [size](const auto& link) { return gyration_radius(*link.second) > size; };
  if (!idle.empty() || std::any_of(links.begin(), links.end(), too_large)) {
    lumped = Lumper(document, description, endless, idle, size).lump();
  }
  for (const std::string& joint : idle) {
    lumped.robot.notes.push_back({RobotNote::Kind::kAssumed, joint_element(joint),
                                  "the link that it moves has no <inertial> and no wheel: assumed fixed"});
  }
  lumped.robot.massless = std::move(massless);
  assign_massless_inertia(lumped);
  for (RigidBody& body : lumped.robot.bodies) {
    if (!of_this_world(body)) {
      refuse(document.source, link_element(body.name),
             "a mass, length or inertia of it, or of a link above it, exceeds 1e9", "Set kg, m and kg·m²");
    }
    if (body.mass > 0) body.inertia = possible_inertia(body.inertia, body.mass);
  }
  return std::move(lumped.robot);
}

}  // namespace robot_control

#include "machine/wheeled/bearing_joints.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "machine/bodies/rigid_bodies.h"
#include "machine/description/wording.h"
#include "machine/gravity.h"
#include "machine/wheeled/ground_points.h"
#include "machine/wheeled/wheels/drive_wheels.h"
#include "machine/wheeled/wheels/swivel.h"

namespace robot_control {
namespace {

constexpr double kMaxDepthShare = 0.5;  // share of the drive wheels' radius
constexpr double kSuspension = 2;       // share of the drive wheels' radius
constexpr double kMinOffset = 0.005;    // m, on either side of a balanced joint's axis
constexpr double kNamedShare = 0.1;     // share of the allowed depth
constexpr int kSteps = 64;              // steps of a turn, to find its highest place

/// Describes a support of the robot, as seen from the body in question.
struct Support {
  std::size_t body = 0;                  ///< body that touches the floor
  Eigen::Vector3d point;                 ///< m, root axes
  double sink = 0;                       ///< m by which the joints below let the body down
  std::vector<std::size_t> joints = {};  ///< these joints, by the bodies that they move
};

Eigen::Vector3d axis_of(const RigidBody& body) {
  return body.in_root.linear() * body.joint.axis;
}

/// Returns the height by which a joint can lift the lowest of the points above its place at zero, m.
double lift(const RigidBody& body, const std::vector<Eigen::Vector3d>& points) {
  const BodyJoint& joint = body.joint;
  const Eigen::Vector3d axis = axis_of(body), at = body.in_root.translation();
  const bool ends = joint.lower < joint.upper;
  if (joint.type == JointType::kPrismatic) {
    if (!ends) return std::abs(axis.z()) > kMaxDepthShare ? std::numeric_limits<double>::infinity() : 0;
    return std::max({0.0, axis.z() * joint.lower, axis.z() * joint.upper});
  }
  const double lower = ends ? std::max(joint.lower, -std::numbers::pi) : -std::numbers::pi;
  const double upper = ends ? std::min(joint.upper, std::numbers::pi) : std::numbers::pi;
  const auto lowest = [&](double angle) {
    double z = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector3d& point : points) z = std::min(z, (Eigen::AngleAxisd(angle, axis) * (point - at)).z());
    return z;
  };
  double highest = lowest(0);
  for (int i = 0; i <= kSteps; ++i) highest = std::max(highest, lowest(lower + (upper - lower) * i / kSteps));
  return highest - lowest(0);
}

class Load {
 public:
  explicit Load(const DriveTrain& robot)
      : robot_(robot), bodies_(robot.bodies->bodies), supports_(bodies_.size()), radius_(robot.wheels.front().radius) {
    double floor = 0;
    for (const WheelModel& wheel : robot.wheels) {
      floor += (wheel.centre_base[2] - wheel.radius) / static_cast<double>(robot.wheels.size());
    }
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const bool rolls = rolling_body(robot, bodies_[i]) != nullptr;
      for (const Eigen::Vector3d& point : ground_points(robot, bodies_[i])) {
        if (point.z() > floor + (rolls ? kCasterTolerance : kFloorTolerance)) continue;
        supports_[i].push_back({.body = i, .point = point});
      }
    }
    standing_ = std::ranges::count_if(supports_, [](const auto& each) { return !each.empty(); });
    for (std::size_t i = bodies_.size() - 1; i > 0; --i) {
      pass_joint(i);
      std::ranges::move(supports_[i], std::back_inserter(supports_[bodies_[i].parent]));
    }
  }

  /// Returns the supports of the root that give way.
  std::vector<Support> sinking() const {
    std::vector<Support> sinking;
    std::ranges::copy_if(supports_[0], std::back_inserter(sinking), [&](const Support& each) { return sinks(each); });
    return sinking;
  }

  /// Returns true if the other supports leave no half-plane empty, as seen from the centre of gravity's foot.
  bool stands_without_them() const {
    std::vector<double> directions;
    for (const Support& support : supports_[0]) {
      if (sinks(support)) continue;
      directions.push_back(std::atan2(support.point.y() - robot_.centre_of_gravity_base[1],
                                      support.point.x() - robot_.centre_of_gravity_base[0]));
    }
    if (directions.empty()) return false;
    std::ranges::sort(directions);
    double gap = directions.front() + 2 * std::numbers::pi - directions.back();
    for (std::size_t i = 1; i < directions.size(); ++i) gap = std::max(gap, directions[i] - directions[i - 1]);
    return gap < std::numbers::pi;
  }

  double allowed() const { return kMaxDepthShare * radius_; }

  /// Returns the joints of these supports that let the body down by a relevant part.
  std::vector<std::string> names(const std::vector<Support>& sinking) const {
    std::set<std::size_t> found;
    for (const Support& support : sinking) found.insert(support.joints.begin(), support.joints.end());
    std::vector<std::string> names;
    for (const std::size_t i : found) names.push_back(bodies_[i].joint.name);
    return names;
  }

 private:
  bool sinks(const Support& support) const { return support.sink > allowed(); }

  bool is_held(const RigidBody& body, double lever) const {
    const auto joint = std::ranges::find(robot_.joints, body.joint.name, &JointModel::name);
    const double weight = robot_.mass * kGravity;
    if (joint != robot_.joints.end() && joint->role == JointRole::kHeld)
      return joint->effort_limit >= weight / static_cast<double>(standing_) * lever;
    return body.joint.friction > 0 && body.joint.friction >= weight * lever;
  }

  void pass_joint(std::size_t index) {
    const RigidBody& body = bodies_[index];
    std::vector<Support>& supports = supports_[index];
    if (supports.empty() || rolling_body(robot_, body) != nullptr) return;
    if (body.joint.type == JointType::kPrismatic) return pass_slide(index);
    if (is_swivel(body)) return;
    const Eigen::Vector3d axis = axis_of(body), at = body.in_root.translation();
    double least = std::numeric_limits<double>::infinity(), largest = -least, reach = 0;
    for (const Support& support : supports) {
      const Eigen::Vector3d arm = support.point - at;
      const double lever = arm.cross(Eigen::Vector3d::UnitZ()).dot(axis);
      least = std::min(least, lever);
      largest = std::max(largest, lever);
      reach = std::max(reach, arm.cross(axis).norm());
    }
    if (is_held(body, reach)) return;
    const bool balanced = least < -kMinOffset && largest > kMinOffset;
    for (Support& support : supports) {
      if (balanced) {
        support.point = at + axis * axis.dot(support.point - at);
      } else {
        give_way(support, index);
      }
    }
  }

  void pass_slide(std::size_t index) {
    const RigidBody& body = bodies_[index];
    const double travel = std::abs(axis_of(body).z()) * (body.joint.upper - body.joint.lower);
    if (is_held(body, 1) || (body.joint.spring_stiffness > 0 && travel <= kSuspension * radius_)) return;
    for (Support& support : supports_[index]) give_way(support, index);
  }

  /// A body that stands on the floor itself comes down on its lowest part, so that a round one stays up.
  void give_way(Support& support, std::size_t index) const {
    const RigidBody& body = bodies_[index];
    const double distance =
        lift(body, support.body == index ? ground_points(robot_, body) : std::vector<Eigen::Vector3d>{support.point});
    support.sink += distance;
    if (distance > kNamedShare * allowed()) support.joints.push_back(index);
  }

  const DriveTrain& robot_;
  const std::vector<RigidBody>& bodies_;
  std::vector<std::vector<Support>> supports_;  // supports of each body
  std::ptrdiff_t standing_ = 0;                 // bodies on the floor
  double radius_;
};

}  // namespace

void refuse_unheld_joints(const DriveTrain& robot) {
  const Load load(robot);
  const std::vector<Support> sinking = load.sinking();
  if (sinking.empty() || load.stands_without_them()) return;
  const std::vector<std::string> names = load.names(sinking);
  const double sink = std::ranges::max(sinking, {}, &Support::sink).sink;
  const std::string depth = std::isfinite(sink) ? "by up to " + number(sink) + " m" : "without limit";
  refuse(robot.source, joint_element(names.front()), "the robot stands on joints without effort limit",
         list(names) + "; the robot would sink " + depth + ", but a suspension may sink at most " +
             number(load.allowed()) + " m, half of a wheel's radius",
         "Set type=\"fixed\" on these joints, in the pose in which the robot drives: only wheels are driven");
}

}  // namespace robot_control

#include "machine/bodies/rolling.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "machine/bodies/shape_support.h"
#include "machine/description/wording.h"

namespace robot_control {
namespace {

constexpr int kDirections = 64;
constexpr double kSameReach = 0.98;
constexpr double kCorners = 0.9;
constexpr double kRim = 0.97;
constexpr double kMaxAxleTilt = 5 * M_PI / 180;

double angle_between_lines(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), std::abs(a.dot(b)));
}

struct Profile {
  std::vector<double> heights;  ///< m, support in each direction across the axle
  double reach = 0;             ///< m, farthest point from the axle
  double radius = 0;            ///< m (rolling.h)
  double first = 0, last = 0;   ///< m along the axle, part that touches the ground
};

bool around(const Shape& shape, const Eigen::Vector3d& axle) {
  const bool upright =
      shape.type == ShapeType::kSphere || (shape.type == ShapeType::kCylinder &&
                                           angle_between_lines(shape.in_body.linear().col(2), axle) <= kAxleTolerance);
  return upright && shape.in_body.translation().cross(axle).norm() <= kAxleTolerance * shape.radius;
}

void measure_rim(const Shape& shape, const Eigen::Vector3d& axle, Profile& profile) {
  profile.reach = 0;
  for (const Eigen::Vector3d& point : shape.points) {
    profile.reach = std::max(profile.reach, (shape.in_body * point).cross(axle).norm());
  }
  profile.first = std::numeric_limits<double>::infinity();
  profile.last = -profile.first;
  for (const Eigen::Vector3d& point : shape.points) {
    const Eigen::Vector3d in_body = shape.in_body * point;
    if (in_body.cross(axle).norm() < kRim * profile.reach) continue;
    profile.first = std::min(profile.first, in_body.dot(axle));
    profile.last = std::max(profile.last, in_body.dot(axle));
  }
}

/// Returns the distance from the axle, in m, of the corner of a mesh that reaches farthest along `u`.
double corner_distance(const Shape& mesh, const Eigen::Vector3d& u, const Eigen::Vector3d& axle) {
  const Eigen::Vector3d local = mesh.in_body.linear().transpose() * u;
  const auto farthest =
      std::max_element(mesh.points.begin(), mesh.points.end(),
                       [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return a.dot(local) < b.dot(local); });
  return farthest == mesh.points.end() ? 0 : (mesh.in_body * *farthest).cross(axle).norm();
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double radius_of(double reach, const std::vector<double>& distances) {
  const double usual = median(distances);
  return reach > (1 + kTrueRunning) * usual ? usual : reach;
}

Profile profile_of(const Shape& shape, const Eigen::Vector3d& axle) {
  Profile profile;
  const Eigen::Vector3d x = axle.unitOrthogonal();
  const Eigen::Vector3d y = axle.cross(x);
  std::vector<double> distances;
  for (int i = 0; i < kDirections; ++i) {
    const double phi = 2 * M_PI * i / kDirections;
    const Eigen::Vector3d u = std::cos(phi) * x + std::sin(phi) * y;
    profile.heights.push_back(support(shape, u));
    if (shape.type == ShapeType::kMesh) distances.push_back(corner_distance(shape, u, axle));
  }
  if (shape.type == ShapeType::kMesh) {
    measure_rim(shape, axle, profile);
    profile.radius = radius_of(profile.reach, distances);
    return profile;
  }
  profile.last = support(shape, axle);
  profile.first = -support(shape, -axle);
  profile.reach = *std::max_element(profile.heights.begin(), profile.heights.end());
  if (around(shape, axle)) {
    profile.reach = shape.radius;
    const double middle = shape.in_body.translation().dot(axle);
    const double half = shape.type == ShapeType::kCylinder ? shape.length / 2 : shape.radius;
    profile.first = middle - half;
    profile.last = middle + half;
  }
  profile.radius = radius_of(profile.reach, profile.heights);
  return profile;
}

bool is_round(const std::vector<const Profile*>& profiles) {
  double least = std::numeric_limits<double>::infinity();
  double largest = 0;
  for (std::size_t i = 0; i < kDirections; ++i) {
    double height = -std::numeric_limits<double>::infinity();
    for (const Profile* profile : profiles) height = std::max(height, profile->heights[i]);
    least = std::min(least, height);
    largest = std::max(largest, height);
  }
  if (!(largest > 0)) return false;
  const double few = std::min(kOutOfRound, kMaxOutOfRound * largest);
  return largest - least <= std::max((1 - kRoundness) * largest, few);
}

/// Returns the profiles that touch the ground; empty if they are not round.
std::vector<const Profile*> tyre_of(const std::vector<Profile>& profiles, double reach) {
  std::vector<const Profile*> tyre;
  const Profile* round = nullptr;
  for (const Profile& profile : profiles) {
    if (profile.reach >= kSameReach * reach) tyre.push_back(&profile);
    const bool farther = round == nullptr || profile.reach > round->reach;
    if (farther && is_round({&profile})) round = &profile;
  }
  if (!tyre.empty() && is_round(tyre)) return tyre;
  if (round != nullptr && round->reach >= kCorners * reach) return {round};
  return {};
}

/// Returns the rpy that a cylinder lacks which would roll with it; "" if none would.
std::string lacking_turn(const RigidBody& body) {
  const Shape* const shape = rolling_shape(body);
  if (shape == nullptr || shape->type != ShapeType::kCylinder) return "";
  if (!shape->in_body.linear().isApprox(Eigen::Matrix3d::Identity())) return "";
  for (const auto& [turned, rpy] :
       {std::pair{Eigen::Vector3d(M_PI / 2, 0, 0), "1.5708 0 0"}, {Eigen::Vector3d(0, M_PI / 2, 0), "0 1.5708 0"}}) {
    Shape lying = *shape;
    lying.in_body.linear() = Eigen::AngleAxisd(turned.norm(), turned.normalized()).toRotationMatrix();
    if (around(lying, body.joint.axis)) return rpy;
  }
  return "";
}

void measure_shapes(const RigidBody& body, RollingMeasure& measure) {
  const Eigen::Vector3d& axle = body.joint.axis;
  std::vector<Profile> profiles;
  for (const Shape& shape : body.shapes) profiles.push_back(profile_of(shape, axle));
  double reach = 0;
  for (const Profile& profile : profiles) reach = std::max(reach, profile.reach);
  const std::vector<const Profile*> tyre = tyre_of(profiles, reach);
  if (!(reach > 0) || tyre.empty()) {
    const std::string turn = lacking_turn(body);
    measure.nearly = !turn.empty();
    measure.objection = measure.nearly
                            ? "its cylinder lies across the axle"
                            : "its shape is not round about the axle: it reaches " + number(reach) + " m from it";
    measure.fix = measure.nearly ? "Set rpy=\"" + turn + "\" in the <origin> of the cylinder" : kRoundShape;
    return;
  }
  reach = 0;
  for (const Profile* profile : tyre) {
    reach = std::max(reach, profile->reach);
    measure.radius = std::max(measure.radius, profile->radius);
  }
  double first = tyre.front()->first, last = tyre.front()->last;
  for (const Profile* profile : tyre) {
    first = std::min(first, profile->first);
    last = std::max(last, profile->last);
  }
  measure.out_of_round = reach - measure.radius;
  measure.width = last - first;
  measure.centre_in_body = axle * (first + last) / 2;
}

}  // namespace

const Shape* rolling_shape(const RigidBody& body) {
  const Shape* farthest = nullptr;
  double reach = 0;
  for (const Shape& shape : body.shapes) {
    const double shape_reach = profile_of(shape, body.joint.axis).reach;
    if (shape_reach <= reach) continue;
    reach = shape_reach;
    farthest = &shape;
  }
  return farthest;
}

bool turns_upright(const RigidBody& body) {
  const bool turns = body.joint.type == JointType::kContinuous || body.joint.type == JointType::kRevolute;
  return turns && std::abs((body.in_root.linear() * body.joint.axis).z()) < std::sin(kMaxAxleTilt);
}

double axle_tilt(const RollingMeasure& measure) {
  return angle_between_lines(measure.axle_in_root, Eigen::Vector3d::UnitY());
}

RollingMeasure measure_wheel(const RigidBody& body) {
  RollingMeasure measure;
  const BodyJoint& joint = body.joint;
  measure.axle_in_root = body.in_root.linear() * joint.axis;
  if (joint.type == JointType::kRevolute && joint.lower < joint.upper) {
    measure.objection = "it turns only from " + number(joint.lower) + " to " + number(joint.upper) + " rad";
    measure.fix = kContinuous;
  } else if (joint.type != JointType::kContinuous && joint.type != JointType::kRevolute) {
    measure.objection = "it is type=\"prismatic\", but a drive wheel needs type=\"continuous\"";
    measure.fix = kContinuous;
  } else if (!turns_upright(body)) {
    measure.objection = "its axis is not horizontal";
    measure.fix = kLateralAxis;
  } else if (body.shapes.empty()) {
    measure.objection = "it has no <collision> shape that gives its radius";
    measure.fix = kRoundShape;
  }
  if (!measure.objection.empty()) return measure;
  measure_shapes(body, measure);

  const Eigen::Vector3d lever = body.centre_of_gravity.cross(joint.axis);
  const Eigen::Vector3d centre_base = body.in_root * measure.centre_in_body;
  measure.centre_base = {centre_base.x(), centre_base.y(), centre_base.z()};
  measure.inertia = joint.axis.dot(body.inertia * joint.axis) + body.mass * lever.squaredNorm();
  return measure;
}

}  // namespace robot_control

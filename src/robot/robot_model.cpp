#include "robot/robot_model.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <fstream>
#include <sstream>

#include "robot/rigid_bodies.h"
#include "robot/urdf_document.h"
#include "robot/wheel.h"
#include "signals/joint.h"

namespace robot_control {
namespace {

// FNV-1a, 64 bit: http://www.isthe.com/chongo/tech/comp/fnv
class Fnv1a {
 public:
  void add(const std::string& text) {
    for (const char c : text) add_byte(static_cast<unsigned char>(c));
    add_byte(0);
  }
  void add(const std::optional<double>& value) {
    add_byte(value.has_value());
    const auto bits = std::bit_cast<std::uint64_t>(value.value_or(0.0));
    for (int shift = 0; shift < 64; shift += 8) add_byte(static_cast<unsigned char>(bits >> shift));
  }
  std::uint64_t value() const { return hash_; }

 private:
  void add_byte(unsigned char byte) { hash_ = (hash_ ^ byte) * 0x100000001B3ULL; }
  std::uint64_t hash_ = 0xCBF29CE484222325ULL;
};

Vector3 plain(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

double checked_override(const RigidBodies& robot, const std::string& name, double value) {
  if (!std::isfinite(value) || value <= 0) {
    refuse(robot.source, "robot/" + name, std::to_string(value) + " m", "Give a length above zero, or none");
  }
  return value;
}

void read_joints(const RigidBodies& robot, const RobotParameters& parameters, RobotModel& model) {
  std::vector<std::string> order{parameters.left_wheel_joint, parameters.right_wheel_joint};
  for (const std::string& name : robot.moving_joints) {
    if (std::find(order.begin(), order.end(), name) == order.end()) order.push_back(name);
  }
  if (order.size() > kMaxJoints) {
    refuse(robot.source, "<robot>", std::to_string(order.size()) + " moving joints",
           "At most " + std::to_string(kMaxJoints) + " are supported; make those that never move type=\"fixed\"");
  }
  for (const std::string& name : order) {
    const RigidBody& body = *robot.moved_by(name);
    model.joints.push_back({name, body.name, body.joint.effort_limit, body.joint.velocity_limit});
  }
}

void read_drive(const RigidBodies& robot, const RobotParameters& parameters, RobotModel& model) {
  if (parameters.left_wheel_joint == parameters.right_wheel_joint) {
    refuse(robot.source, "robot/left_wheel_joint", "\"" + parameters.left_wheel_joint + "\" is the right wheel as well",
           "Name two joints");
  }
  model.left = measure_wheel(robot, parameters.left_wheel_joint);
  model.right = measure_wheel(robot, parameters.right_wheel_joint);
  model.left.joint = 0;
  model.right.joint = 1;
  const double base = model.left.centre_base[1] - model.right.centre_base[1];
  if (base <= 0) {
    refuse(robot.source, "robot/left_wheel_joint",
           "wheel \"" + parameters.left_wheel_joint + "\" is not left of \"" + parameters.right_wheel_joint + "\"",
           "Exchange the two names, or turn the robot: x is forward, y left");
  }
  if (std::abs(model.left.centre_base[0] - model.right.centre_base[0]) > kAxleTolerance * base) {
    refuse(robot.source, "<joint name=\"" + parameters.left_wheel_joint + "\">", "the wheels do not stand on one axle",
           "Give both wheel centres the same x");
  }
  model.wheel_base = base;
  if (parameters.wheel_base) model.wheel_base = checked_override(robot, "wheel_base", *parameters.wheel_base);
  if (parameters.wheel_radius) {
    model.left.radius = model.right.radius = checked_override(robot, "wheel_radius", *parameters.wheel_radius);
  }
}

void read_masses(const RigidBodies& robot, RobotModel& model) {
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  const double axle_x = (model.left.centre_base[0] + model.right.centre_base[0]) / 2;
  const double axle_y = (model.left.centre_base[1] + model.right.centre_base[1]) / 2;
  for (const RigidBody& body : robot.bodies) {
    const Eigen::Vector3d centre = body.in_root * body.centre_of_gravity;
    const Eigen::Vector3d up = body.in_root.linear().transpose() * Eigen::Vector3d::UnitZ();
    model.mass += body.mass;
    moment += body.mass * centre;
    model.yaw_inertia +=
        up.dot(body.inertia * up) + body.mass * (std::pow(centre.x() - axle_x, 2) + std::pow(centre.y() - axle_y, 2));
  }
  model.centre_of_gravity_base = plain(moment / model.mass);
}

void read_imu(const RigidBodies& robot, RobotModel& model) {
  const auto imu = robot.links.find("imu_link");
  if (imu == robot.links.end()) return;
  if (imu->second.body != 0) {
    refuse(robot.source, "<link name=\"imu_link\">", "it moves against " + robot.bodies[0].name,
           "Fix the IMU to the chassis");
  }
  model.imu_link = imu->first;
  const Eigen::Quaterniond rotation(imu->second.in_body.linear());
  model.imu_in_base.position = plain(imu->second.in_body.translation());
  model.imu_in_base.orientation = {rotation.x(), rotation.y(), rotation.z(), rotation.w()};
}

}  // namespace

RobotDescription load_description(const std::string& path) {
  std::ifstream file(path);
  std::ostringstream text;
  if (!file || !(text << file.rdbuf())) {
    refuse(path, "URDF", "it cannot be read or is empty", "Give the path of a URDF file");
  }
  return {text.str(), path};
}

RobotModel read_robot(const RobotDescription& description, const RobotParameters& parameters) {
  const RigidBodies robot = read_rigid_bodies(description);
  RobotModel model;
  model.name = robot.name;
  model.source = description.source;
  model.urdf = description.text;
  model.base_link = robot.bodies[0].name;
  read_drive(robot, parameters, model);
  read_joints(robot, parameters, model);
  read_masses(robot, model);
  read_imu(robot, model);

  Fnv1a hash;
  hash.add(description.text);
  hash.add(parameters.left_wheel_joint);
  hash.add(parameters.right_wheel_joint);
  hash.add(parameters.wheel_base);
  hash.add(parameters.wheel_radius);
  model.hash = hash.value();
  return model;
}

}  // namespace robot_control

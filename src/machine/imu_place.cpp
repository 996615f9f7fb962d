#include "machine/imu_place.h"

#include <algorithm>
#include <cmath>

#include "machine/description/urdf_document.h"
#include "machine/description/wording.h"
#include "machine/overrides.h"

namespace robot_control {
namespace {

bool is_letter(char c) {
  return c >= 'a' && c <= 'z';
}

/// Returns true if a word in `name` begins with `word`; "simulated" contains an "imu", too.
bool begins_word(const std::string& name, const std::string& word) {
  for (std::size_t at = name.find(word); at != std::string::npos; at = name.find(word, at + 1)) {
    if (at == 0 || !is_letter(name[at - 1])) return true;
  }
  return false;
}

bool fixed_to_root(const RigidBodies& robot, const std::string& link) {
  const auto place = robot.links.find(link);
  return place != robot.links.end() && place->second.body == 0;
}

std::string words(const Eigen::Vector3d& v) {
  return list({number(v.x() + 0.0), number(v.y() + 0.0), number(v.z() + 0.0)});  // no "-0"
}

Eigen::Quaterniond rotation_of(const Eigen::Vector3d& rpy) {
  return Eigen::AngleAxisd(rpy.z(), Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX());
}

Eigen::Vector3d rpy_of(const Eigen::Matrix3d& r) {
  return {std::atan2(r(2, 1), r(2, 2)), std::asin(std::clamp(-r(2, 0), -1.0, 1.0)), std::atan2(r(1, 0), r(0, 0))};
}

Eigen::Vector3d finite(const RigidBodies& robot, const std::string& element, const std::string& unit,
                       const Vector3& given) {
  Eigen::Vector3d vector(given[0], given[1], given[2]);
  if (!vector.allFinite()) {
    refuse(robot.source, element, words(vector) + " " + unit, "Give three finite numbers, or none");
  }
  return vector;
}

}  // namespace

std::string imu_link_of(const RigidBodies& robot, const std::string& requested_link, std::vector<RobotNote>& notes) {
  const std::string& base = robot.bodies[0].name;
  if (!requested_link.empty()) {
    if (!robot.links.contains(requested_link)) {
      refuse(robot.source, "robot/imu_link", "there is no link \"" + requested_link + "\"",
             "Name a link of the URDF, or none: then the IMU is found, or sits in " + base);
    }
    if (!fixed_to_root(robot, requested_link)) {
      refuse(robot.source, link_element(requested_link), "it moves against " + base, "Fix the IMU to the chassis");
    }
    return requested_link == base ? "" : requested_link;
  }
  if (fixed_to_root(robot, "imu_link")) return "imu_link";
  for (const std::string& link : robot.link_order) {
    const std::string name = lower_case(link);
    if (!begins_word(name, "imu") && !begins_word(name, "gyro")) continue;
    if (!fixed_to_root(robot, link)) {
      notes.push_back(
          {RobotNote::Kind::kIgnored, link_element(link), "it moves against " + base + ": no place for the IMU"});
      continue;
    }
    notes.push_back({RobotNote::Kind::kAssumed, link_element(link), "the IMU sits here"});
    return link == base ? "" : link;
  }
  notes.push_back({RobotNote::Kind::kAssumed, link_element(base), "no link is named after an IMU: it sits here"});
  return "";
}

Pose imu_pose(const RigidBodies& robot, const std::string& link, const MachineParameters& parameters, double length,
              std::vector<RobotNote>& notes) {
  Eigen::Isometry3d place = link.empty() ? Eigen::Isometry3d::Identity() : robot.links.at(link).in_body;
  Eigen::Quaterniond rotation(place.linear());
  if (parameters.imu_position) {
    const Eigen::Vector3d given = finite(robot, "robot/imu_position", "m", *parameters.imu_position);
    if ((given - place.translation()).norm() > kWorthNoting * length) {
      notes.push_back({RobotNote::Kind::kOverridden, "robot/imu_position",
                       words(given) + " m holds, the URDF says " + words(place.translation()) + " m"});
    }
    place.translation() = given;
  }
  if (parameters.imu_orientation) {
    const Eigen::Vector3d given = finite(robot, "robot/imu_orientation", "rad", *parameters.imu_orientation);
    const Eigen::Quaterniond from_urdf = rotation;
    rotation = rotation_of(given);
    if (rotation.angularDistance(from_urdf) > kWorthNoting) {
      notes.push_back({RobotNote::Kind::kOverridden, "robot/imu_orientation",
                       words(given) + " rad holds, the URDF says " + words(rpy_of(place.linear())) + " rad"});
    }
  }
  const Eigen::Vector3d& position = place.translation();
  return {.position = {position.x(), position.y(), position.z()},
          .orientation = {rotation.x(), rotation.y(), rotation.z(), rotation.w()}};
}

}  // namespace robot_control

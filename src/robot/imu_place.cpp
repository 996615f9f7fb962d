#include "robot/imu_place.h"

#include "description/urdf_document.h"
#include "description/wording.h"

namespace robot_control {
namespace {

bool is_letter(char c) {
  return c >= 'a' && c <= 'z';
}

/// "simulated" has an "imu", too.
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

}  // namespace

std::string imu_link_of(const RigidBodies& robot, const std::string& wished, std::vector<RobotNote>& notes) {
  const std::string& base = robot.bodies[0].name;
  if (!wished.empty()) {
    if (!robot.links.contains(wished)) {
      refuse(robot.source, "robot/imu_link", "there is no link \"" + wished + "\"",
             "Name a link of the URDF, or none: then the IMU is found, or sits in " + base);
    }
    if (!fixed_to_root(robot, wished)) {
      refuse(robot.source, link_element(wished), "it moves against " + base, "Fix the IMU to the chassis");
    }
    return wished == base ? "" : wished;
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

}  // namespace robot_control

#include "ros/startup/description.h"

#include <ros/names.h>
#include <ros/param.h>

#include "machine/bodies/added_laser.h"

namespace robot_control {
namespace {

constexpr const char* kDescription = "robot_description";
constexpr const char* kUrdf = "robot/urdf";

void restore(const char* name, const std::string& before) {
  if (before.empty()) {
    ros::param::del(name);
  } else {
    ros::param::set(name, before);
  }
}

}  // namespace

RobotDescription chosen_description(const Parameters& parameters, bool urdf_requested, const std::string& published,
                                    const std::string& name) {
  const bool laser = parameters.simulated_laser;
  if (urdf_requested || published.empty()) return with_laser(load_description(parameters.urdf), laser);
  const RobotDescription server = with_laser({published, name}, laser);
  try {
    RobotDescription file = with_laser(load_description(parameters.urdf), laser);
    if (file.text == server.text) return file;
  } catch (const RobotError&) {
    // The text on the server is used; the file is not needed.
  }
  return server;
}

std::vector<std::string> missing_description() {
  if (ros::param::has(kDescription)) return {};
  return {ros::names::resolve(kDescription) + ": start the robot"};
}

RobotDescription published_description() {
  RobotDescription description{"", ros::names::resolve(kDescription)};
  ros::param::get(kDescription, description.text);
  return description;
}

void forget_argument() {
  ros::param::del("~urdf");
}

std::string unread_description(const RobotDescription& chosen, const std::string& published, const std::string& name,
                               const std::string& asked_for) {
  if (published.empty() || published == chosen.text) return "";
  return name + " contains another robot and is not used: " + asked_for + " = " + chosen.source +
         " has priority over it, perhaps from an earlier launch: then `rosparam delete " + asked_for + "`";
}

PublishedDescription::PublishedDescription(const MachineModel& robot, const std::string& urdf) {
  ros::param::get(kDescription, description_before_);
  changed_description_ = description_before_ != robot.urdf;
  if (changed_description_) ros::param::set(kDescription, robot.urdf);
  if (!ros::param::has("~urdf")) return;
  ros::param::get(kUrdf, urdf_before_);
  changed_urdf_ = urdf_before_ != urdf;
  if (changed_urdf_) ros::param::set(kUrdf, urdf);
  forget_argument();
}

PublishedDescription::~PublishedDescription() {
  if (changed_description_) restore(kDescription, description_before_);
  if (changed_urdf_) restore(kUrdf, urdf_before_);
}

}  // namespace robot_control

#include "ros/reports/robot_report.h"

#include <sstream>

#include "machine/description/wording.h"

namespace robot_control {
namespace {

std::string names_of_side(const DriveTrain& robot, Side side) {
  std::string names;
  for (const WheelModel& wheel : robot.wheels) {
    if (wheel.side == side) names.append(names.empty() ? "" : ", ").append(robot.joints[wheel.joint].name);
  }
  return names;
}

}  // namespace

std::string summary(const DriveTrain& robot) {
  std::ostringstream text;
  text.precision(4);
  text << "robot '" << robot.name << "' of " << robot.source << ": left wheels " << names_of_side(robot, Side::kLeft)
       << ", right wheels " << names_of_side(robot, Side::kRight) << ", radius " << robot.wheels.front().radius
       << " m, wheel base " << robot.wheel_base << " m";
  if (robot.wheel_base_multiplier != 1) text << " (effective " << robot.effective_wheel_base() << " m)";
  text << ", " << robot.mass << " kg";
  return text.str();
}

std::string summary(const MachineModel& robot) {
  const auto* const legged = dynamic_cast<const LegModel*>(&robot);
  if (legged == nullptr) return summary(drive_train_of(robot));
  std::ostringstream text;
  text.precision(4);
  text << "robot '" << robot.name << "' of " << robot.source << ": four legs of " << legged->leg_length() << " m, "
       << robot.mass << " kg";
  return text.str();
}

std::string sentence(const RobotNote& note) {
  return std::string(name_of(note.kind)).append(": ").append(note.element).append(": ").append(note.text);
}

bool needs_a_look(const RobotNote& note) {
  return note.kind != RobotNote::Kind::kAssumed && note.kind != RobotNote::Kind::kIgnored;
}

}  // namespace robot_control

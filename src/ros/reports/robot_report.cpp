#include "ros/reports/robot_report.h"

#include "signals/formatted_text.h"

namespace robot_control {

std::string summary(const MachineModel& robot) {
  return "robot '" + robot.name + "' of " + robot.source + ": " + robot.parts() + formatted(", %.4g kg", robot.mass);
}

std::string sentence(const RobotNote& note) {
  return std::string(name_of(note.kind)).append(": ").append(note.element).append(": ").append(note.text);
}

bool needs_a_look(const RobotNote& note) {
  return note.kind != RobotNote::Kind::kAssumed && note.kind != RobotNote::Kind::kIgnored;
}

}  // namespace robot_control

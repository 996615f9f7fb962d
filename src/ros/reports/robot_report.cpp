#include "ros/reports/robot_report.h"

#include <sstream>

namespace robot_control {

std::string summary(const MachineModel& robot) {
  std::ostringstream text;
  text.precision(4);
  text << "robot '" << robot.name << "' of " << robot.source << ": " << robot.parts() << ", " << robot.mass << " kg";
  return text.str();
}

std::string sentence(const RobotNote& note) {
  return std::string(name_of(note.kind)).append(": ").append(note.element).append(": ").append(note.text);
}

bool needs_a_look(const RobotNote& note) {
  return note.kind != RobotNote::Kind::kAssumed && note.kind != RobotNote::Kind::kIgnored;
}

}  // namespace robot_control

#include "ros/startup/command_line.h"

#include <ros/init.h>

#include <algorithm>

namespace robot_control {
namespace {

std::string usage(const std::string& program, const std::string& purpose) {
  return "usage: rosrun robot_control " + program + " [NAME:=VALUE ...]\n\n" + purpose +
         "\n\n"
         "  _PARAMETER:=VALUE   a parameter of this node; all of them: docs/parameters.md\n"
         "  _config:=FILE       a file of parameters that lies over config/robot_params.yaml\n"
         "  __ns:=NAMESPACE, __name:=NAME, TOPIC:=OTHER_TOPIC\n"
         "                      as for every node of ROS\n"
         "  -h, --help          prints this text\n\n"
         "Parameters of the whole robot stand on the parameter server: rosparam set /robot/rate 500\n";
}

}  // namespace

std::optional<CommandLineAnswer> answer_command_line(const std::string& program, const std::string& purpose,
                                                     std::vector<std::string> words) {
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  std::vector<std::string> foreign;
  ros::removeROSArgs(static_cast<int>(pointers.size()), pointers.data(), foreign);
  if (foreign.empty()) return std::nullopt;
  if (std::ranges::any_of(foreign, [](const auto& word) { return word == "--help" || word == "-h"; })) {
    return CommandLineAnswer{.refused = false, .text = usage(program, purpose)};
  }
  std::string text = program + ": refused:\n";
  for (const std::string& word : foreign) text += "argument '" + word + "' is unknown; a node takes NAME:=VALUE only\n";
  return CommandLineAnswer{.refused = true, .text = text + "see rosrun robot_control " + program + " --help\n"};
}

}  // namespace robot_control

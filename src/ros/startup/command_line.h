#pragma once
/// The command line of a node accepts remappings and parameters of ROS (NAME:=VALUE) and --help, and nothing else.

#include <optional>
#include <string>
#include <vector>

namespace robot_control {

/// An answer is printed to stdout, or to stderr if it is a refusal; main then returns 0 or 1.
struct CommandLineAnswer {
  bool refused = false;
  std::string text;
};

/// Returns nothing if the node may start. `words` are the arguments behind the name of the program's file, `program`.
/// With --help or -h the answer is the usage and `purpose`, one or more sentences. Otherwise one message refuses all
/// words that are not NAME:=VALUE.
std::optional<CommandLineAnswer> answer_command_line(const std::string& program, const std::string& purpose,
                                                     std::vector<std::string> words);

}  // namespace robot_control

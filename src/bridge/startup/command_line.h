#pragma once
/// The command line of a node: what ROS takes (NAME:=VALUE), --help, and nothing else.

#include <optional>
#include <string>
#include <vector>

namespace robot_control {

/// A line on stdout or stderr, and what main returns.
struct CommandLineAnswer {
  bool refused = false;
  std::string text;
};

/// `words` follow the name of the program's file, `program`. Empty: the node starts. --help or -h anywhere: the usage,
/// with `purpose`, one or more sentences. Otherwise each word that is not NAME:=VALUE is refused, all of them in one
/// message.
std::optional<CommandLineAnswer> answer_command_line(const std::string& program, const std::string& purpose,
                                                     std::vector<std::string> words);

}  // namespace robot_control

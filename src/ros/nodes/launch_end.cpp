#include "ros/nodes/launch_end.h"

#include <signal.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

namespace robot_control {

bool is_roslaunch(const std::string& command_line) {
  constexpr int kProgram = 2;  // roslaunch is the first argument, or the script behind its interpreter
  std::istringstream arguments(command_line);
  std::string argument;
  for (int i = 0; i < kProgram && std::getline(arguments, argument, '\0'); ++i) {
    if (argument.substr(argument.rfind('/') + 1) == "roslaunch") return true;
  }
  return false;
}

bool end_launch() {
  if (std::getenv(kEndsLaunch) == nullptr) return false;
  const pid_t parent = getppid();
  std::ifstream file("/proc/" + std::to_string(parent) + "/cmdline", std::ios::binary);
  std::stringstream command_line;
  command_line << file.rdbuf();
  return is_roslaunch(command_line.str()) && kill(parent, SIGINT) == 0;
}

}  // namespace robot_control

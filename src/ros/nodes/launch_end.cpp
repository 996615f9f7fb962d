#include "ros/nodes/launch_end.h"

#include <signal.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
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

bool launched() {
  if (std::getenv(kEndsLaunch) == nullptr) return false;
  std::ifstream file("/proc/" + std::to_string(getppid()) + "/cmdline", std::ios::binary);
  std::stringstream command_line;
  command_line << file.rdbuf();
  return is_roslaunch(command_line.str());
}

std::string launched_nodes() {
  const std::string parent = std::to_string(getppid());
  std::ifstream file("/proc/" + parent + "/task/" + parent + "/children");
  std::string nodes;
  std::getline(file, nodes);
  return nodes;
}

bool first_to_refuse() {
  // A name in the abstract name space belongs to one socket, and ends with it.
  static const int held = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const std::string name = "robot_control.refused." + std::to_string(getppid());
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::copy(name.begin(), name.end(), address.sun_path + 1);
  const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
  return bind(held, reinterpret_cast<const sockaddr*>(&address), length) == 0 || errno != EADDRINUSE;
}

bool end_launch() {
  return launched() && kill(getppid(), SIGINT) == 0;
}

}  // namespace robot_control

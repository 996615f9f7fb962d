/// Becomes the controller of the robot's kind, diff_drive_controller or leg_controller, in this process.

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "robots/robot_kind.h"
#include "ros/nodes/node.h"
#include "signals/robot_kinds.h"

namespace robot_control {
namespace {

std::vector<std::string> words;  // of the command line, before ROS takes its own away

std::unique_ptr<Node> become_controller(const Setup& setup) {
  const std::string controller(names_of_kind(name_of(kind_of(*setup.machine))).controller);
  const std::string program = std::filesystem::read_symlink("/proc/self/exe").replace_filename(controller);
  words[0] = program;
  std::vector<char*> arguments;
  for (std::string& word : words) {
    if (word.starts_with("__name:=")) word = "__name:=" + controller;
    arguments.push_back(word.data());
  }
  arguments.push_back(nullptr);
  execv(program.c_str(), arguments.data());
  throw std::runtime_error(program + " cannot be started: " + std::strerror(errno));
}

}  // namespace
}  // namespace robot_control

int main(int argc, char** argv) {
  using namespace robot_control;
  words.assign(argv, argv + argc);
  return run_node(argc, argv,
                  {.name = "controller",
                   .purpose = "Becomes the controller of the robot's kind: diff_drive_controller or leg_controller.",
                   .make = become_controller});
}

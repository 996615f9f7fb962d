#include "ros/nodes/service_program.h"

#include <ros/ros.h>

#include <clocale>
#include <cstdio>
#include <exception>
#include <filesystem>

#include "ros/network/loopback.h"
#include "ros/startup/command_line.h"

namespace robot_control {

int run_service(int argc, char** argv, const ServiceProgram& program) {
  const std::string file = std::filesystem::path(argv[0]).filename().string();
  if (const auto answer = answer_command_line(file, program.purpose, {argv + 1, argv + argc})) {
    std::fputs(answer->text.c_str(), answer->refused ? stderr : stdout);
    return answer->refused ? 1 : 0;
  }
  std::setvbuf(stdout, nullptr, _IOLBF, 0);  // as run_node does
  std::setlocale(LC_CTYPE, "C.UTF-8");
  bind_as_ros_is_configured();
  try {
    ros::init(argc, argv, program.name);
    program.spin();
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: refused:\n%s\n", program.name.c_str(), error.what());
    return 1;
  }
}

}  // namespace robot_control

#pragma once
/// A MapService calls a function with the path of a request of robot_control/MapFile. Its text is the answer; what it
/// throws is the reason of the refusal.

#include <robot_control/MapFile.h>
#include <ros/ros.h>

#include <exception>
#include <functional>
#include <string>

namespace robot_control {

class MapService {
 public:
  MapService(ros::NodeHandle& handle, const char* name, std::function<std::string(const std::string&)> use)
      : use_(std::move(use)), server_(handle.advertiseService(name, &MapService::answer, this)) {}

 private:
  bool answer(robot_control::MapFile::Request& request, robot_control::MapFile::Response& response) {
    try {
      response.message = use_(request.path);
      response.success = 1;
    } catch (const std::exception& error) {
      response.message = error.what();
      response.success = 0;
    }
    ROS_INFO("%s", response.message.c_str());
    return true;
  }

  std::function<std::string(const std::string&)> use_;
  ros::ServiceServer server_;
};

}  // namespace robot_control

#pragma once
/// A service of robot_control/MapFile, which calls a function with the path of the request.

#include <robot_control/MapFile.h>
#include <ros/ros.h>

#include <exception>
#include <functional>
#include <string>

#include "ros/messages/service_answer.h"

namespace robot_control::navigation {

/// The text that `use` returns is the answer; what it throws is the reason of the refusal.
inline ros::ServiceServer map_service(ros::NodeHandle& handle, const char* name,
                                      const std::function<std::string(const std::string&)>& use) {
  const boost::function<bool(MapFile::Request&, MapFile::Response&)> serve = [use](MapFile::Request& request,
                                                                                   MapFile::Response& response) {
    try {
      answer(response, true, use(request.path));
    } catch (const std::exception& error) {
      answer(response, false, error.what());
    }
    ROS_INFO("%s", response.message.c_str());
    return true;
  };
  return handle.advertiseService(name, serve);
}

}  // namespace robot_control::navigation

#pragma once
/// The messages of a log as a bag describes them: name, MD5 sum and text of msg/*.msg, taken at build time;
/// and what else the build knows about itself.

#include <string>

namespace robot_control {

struct MessageType {
  std::string name;        ///< "robot_control/Trace"
  std::string md5;         ///< as genmsg computes it
  std::string definition;  ///< the text of the .msg
};

const MessageType& trace_type();
const MessageType& trace_header_type();
const MessageType& snapshot_type();

std::string package_version();
std::string package_build();  ///< compiler, build type, flags

}  // namespace robot_control

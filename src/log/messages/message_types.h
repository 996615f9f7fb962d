#pragma once
/// A bag describes the messages of a log by name, MD5 sum and text of msg/*.msg; the build reads them. It also knows
/// its own version and compiler.

#include <string>

namespace robot_control {

struct MessageType {
  std::string name;        ///< "robot_control/Trace"
  std::string md5;         ///< the MD5 sum that genmsg computes
  std::string definition;  ///< the text of the .msg
};

const MessageType& trace_type();
const MessageType& trace_header_type();
const MessageType& snapshot_type();
const MessageType& trace_summary_type();

std::string package_version();
std::string package_build();  ///< compiler, build type, flags

}  // namespace robot_control

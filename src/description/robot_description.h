#pragma once
/// The text of a robot description, and how what is wrong with one is said.

#include <stdexcept>
#include <string>

namespace robot_control {

/// One message: what is wrong, in which file and element, and what to do about it.
class RobotError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// "<source>: <element>: <what>. <remedy>."
[[noreturn]] void refuse(const std::string& source, const std::string& element, const std::string& what,
                         const std::string& remedy);

/// A URDF text and where it was read, for messages ("urdf/diffbot.urdf", "/robot_description").
struct RobotDescription {
  std::string text;
  std::string source;
};

/// Reads a file; throws RobotError naming it. A name that ends in .xacro is expanded first (xacro.h).
RobotDescription load_description(const std::string& path);

}  // namespace robot_control

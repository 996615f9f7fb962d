#include "description/robot_description.h"

#include <fstream>
#include <sstream>

#include "description/xacro.h"

namespace robot_control {
namespace {

bool ends_with_xacro(const std::string& path) {
  const std::string ending = ".xacro";
  return path.size() >= ending.size() && path.compare(path.size() - ending.size(), ending.size(), ending) == 0;
}

}  // namespace

void refuse(const std::string& source, const std::string& element, const std::string& what, const std::string& remedy) {
  // TinyXML's sentences bring their full stop along.
  const std::string sentence = what.substr(0, what.find_last_not_of('.') + 1);
  throw RobotError(source + ": " + element + ": " + sentence + ". " + remedy + ".");
}

RobotDescription load_description(const std::string& path) {
  if (ends_with_xacro(path)) return {expand_xacro(path), path};
  std::ifstream file(path);
  std::ostringstream text;
  if (!file || !(text << file.rdbuf())) {
    refuse(path, "URDF", "it cannot be read or is empty", "Give the path of a URDF file");
  }
  return {text.str(), path};
}

}  // namespace robot_control

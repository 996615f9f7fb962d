#pragma once
/// The healthy robot, and one change at a time.

#include <stdexcept>
#include <string>

#include "machine/wheeled/drive_train.h"

namespace robot_control {

inline RobotDescription diffbot_urdf() {
  return load_description(PROJECT_DIRECTORY "/urdf/diffbot.urdf");
}

/// `text` with the first `from` after `anchor` replaced; throws if there is none, so that no test passes by accident.
inline std::string replaced(std::string text, const std::string& anchor, const std::string& from,
                            const std::string& to) {
  const std::size_t begin = text.find(anchor);
  const std::size_t at = begin == std::string::npos ? begin : text.find(from, begin);
  if (at == std::string::npos) throw std::logic_error("\"" + from + "\" is not behind \"" + anchor + "\"");
  return text.replace(at, from.size(), to);
}

/// diffbot with one change.
inline RobotDescription diffbot_with(const std::string& anchor, const std::string& from, const std::string& to) {
  RobotDescription description = diffbot_urdf();
  description.text = replaced(description.text, anchor, from, to);
  return description;
}

}  // namespace robot_control

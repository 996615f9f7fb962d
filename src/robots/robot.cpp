#include "robots/robot.h"

namespace robot_control {

std::string sentence(const Retuned& retuned) {
  std::string text = "set " + std::to_string(retuned.count) + ": ";
  for (const LiveValue& value : retuned.values) {
    text +=
        (&value == &retuned.values.front() ? "" : ", ") + value.key + " from " + value.before + " to " + value.after;
  }
  return text;
}

}  // namespace robot_control

#include "robots/robot.h"

#include <cmath>

namespace robot_control {

std::string sentence(const Retuned& retuned) {
  std::string text = "set " + std::to_string(retuned.count) + ": ";
  for (const LiveValue& value : retuned.values) {
    text +=
        (&value == &retuned.values.front() ? "" : ", ") + value.key + " from " + value.before + " to " + value.after;
  }
  return text;
}

std::uint64_t longest_ramp(const SafetyParameters& safety, double period) {
  return static_cast<std::uint64_t>(std::ceil(safety.ramp_time / period - 1e-9)) + safety.loss_cycles;
}

}  // namespace robot_control

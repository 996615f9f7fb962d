#include "ros/navigation/controller_limits.h"

namespace robot_control::navigation {

void take_over(const dynamic_reconfigure::Config& message, DriveControllerParameters& wheels) {
  for (const Key& key : keys(wheels)) {
    for (const auto& entry : message.doubles) {
      if (entry.name != key.name || !key.group.empty() || !(entry.value >= key.min && entry.value <= key.max)) continue;
      if (auto* const* value = std::get_if<double*>(&key.field)) **value = entry.value;
      if (auto* const* value = std::get_if<std::optional<double>*>(&key.field)) **value = entry.value;
    }
  }
}

}  // namespace robot_control::navigation

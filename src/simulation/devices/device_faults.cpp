#include "simulation/devices/device_faults.h"

#include <algorithm>
#include <vector>

namespace robot_control {

std::string inject_device_fault(SimulatedDrives& drives, std::span<const std::string> joints, std::size_t host,
                                std::string_view component, std::string_view kind) {
  const std::vector<Word> words = words_of(DeviceFault());
  const auto word = std::ranges::find(words, kind, &Word::text);
  const auto joint = std::ranges::find(joints, component);
  if (component == "bus" && (kind == "ok" || kind == "off" || kind == "lossy" || kind == "disturbed")) {
    drives.bus().connect(host, kind != "off");
    drives.disturb(kind == "lossy" || kind == "disturbed", kind == "disturbed");
    return "";
  }
  if (joint != joints.end() && word != words.end()) {
    drives.inject(static_cast<std::size_t>(joint - joints.begin()), static_cast<DeviceFault>(word->value));
    return "";
  }
  std::string problem = "component must be bus (with ok, off, lossy or disturbed)";
  for (const std::string& name : joints) problem += ", " + name;
  problem += "; kind";
  for (const Word& each : words) problem += " " + std::string(each.text);
  return problem;
}

}  // namespace robot_control

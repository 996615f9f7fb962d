#include "configuration/rate_notes.h"

namespace robot_control {
namespace {

std::string topics_of(const Block& block, double rate) {
  std::string text;
  for (const Key& key : block.keys) {
    const auto* const* number = std::get_if<double*>(&key.field);
    if (number == nullptr || (key.traits & kPublishRate) == 0 || **number <= rate) continue;
    text += (text.empty() ? "" : ", ") + path_of(block, key) + " (" + shortest(**number) + " Hz)";
  }
  return text;
}

}  // namespace

std::vector<std::string> rate_notes(Parameters parameters, std::string_view block) {
  const LoopParameters loop = parameters.loop;
  const std::string at = "at robot.rate = " + shortest(loop.rate) + " Hz, ";
  std::vector<std::string> notes;
  for (const Block& each : schema(parameters).blocks) {
    if (each.name != block) continue;
    if (const std::string topics = topics_of(each, loop.rate); !topics.empty())
      notes.push_back(at + "a message per cycle is published instead of: " + topics);
  }
  if (block == program_of(Role::kMonitor) && is_slow(loop)) {
    const std::uint64_t cycles = parameters.safety.loss_cycles;
    notes.push_back(at + "the brake follows within " + std::to_string(cycles) + " cycles (loss_cycles), which are " +
                    shortest(static_cast<double>(cycles) / loop.rate) +
                    " s, after a node of the loop has stopped: set lower speed limits or a higher robot.rate");
  }
  return notes;
}

}  // namespace robot_control

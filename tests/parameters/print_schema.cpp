/// Prints a line per parameter for tests/docs/parameters_page.py, with tabs: path, rule, "optional", "live", key whose
/// other name it is. With an argument it prints a line per condition of the safety monitor: name, default limit,
/// persistence and reaction, unit with meaning.

#include <iostream>

#include "configuration/parameters.h"

namespace robot_control {
namespace {

void print_parameters() {
  Parameters parameters;
  for (const Block& block : schema(parameters).blocks) {
    for (const Key& key : block.keys) {
      std::cout << path_of(block, key) << '\t' << rule_of(key) << '\t'
                << ((key.traits & kOptional) != 0 ? "optional" : "") << '\t'
                << ((key.traits & kLive) != 0 ? "live" : "") << '\t' << key.other_name_of << '\n';
    }
  }
}

// clang-format off
void print_conditions() {
#define CAUSE(...)
#define CONDITION(id, name, sentence, remedy, actor, unit, min, max, limit, persistence, reaction, meaning) \
  std::cout << #name "\t" #limit "\t" #persistence "\t" #reaction "\t" unit meaning "\n";
#define CONDITION_WITHOUT_LIMIT(id, name, sentence, remedy, actor, unit, persistence, reaction, meaning) \
  std::cout << #name "\t{}\t" #persistence "\t" #reaction "\t" unit meaning "\n";
#include "signals/stop_causes.def"
}
// clang-format on

}  // namespace
}  // namespace robot_control

int main(int count, char**) {
  if (count > 1) {
    robot_control::print_conditions();
  } else {
    robot_control::print_parameters();
  }
  return 0;
}

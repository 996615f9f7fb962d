/// Prints a line per parameter for tests/docs/parameters_page.py, by tabs: path, rule, "optional", "live", key whose
/// other name it is.

#include <iostream>

#include "parameters/schema.h"

int main() {
  using namespace robot_control;
  for (const Block& block : schema()) {
    for (const Key& key : block.keys) {
      std::cout << path_of(block, key) << '\t' << rule_of(key) << '\t'
                << ((key.traits & kOptional) != 0 ? "optional" : "") << '\t'
                << ((key.traits & kLive) != 0 ? "live" : "") << '\t' << key.other_name_of << '\n';
    }
  }
  return 0;
}

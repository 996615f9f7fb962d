#include "replay/report.h"

#include <algorithm>

namespace robot_control {

std::string_view name_of(LawName law) noexcept {
  return law == LawName::kGate ? "gate" : kLawNodes[static_cast<std::size_t>(law)];
}

bool ReplayReport::exact() const noexcept {
  const bool same = std::ranges::all_of(laws, [](const LawReport& law) { return law.different == 0; });
  return same && std::ranges::any_of(laws, [](const LawReport& law) { return law.compared != 0; });
}

std::string sentence(const ReplayDifference& difference) {
  return std::string(name_of(difference.law)) + ", run " + std::to_string(difference.run) + ", cycle " +
         std::to_string(difference.cycle) + ": " + difference.field + " is " + difference.replayed + ", logged as " +
         difference.logged;
}

std::string sentence(const ReplayGap& gap) {
  return std::string(name_of(gap.law)) + ", run " + std::to_string(gap.run) + ", cycles " + std::to_string(gap.first) +
         " … " + std::to_string(gap.last) + " (" + std::to_string(gap.rows) + " rows): " + gap.reason;
}

}  // namespace robot_control

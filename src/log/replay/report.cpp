#include "log/replay/report.h"

#include <algorithm>

namespace robot_control {

std::string_view name_of(LawName law) noexcept {
  return kLawNames[static_cast<std::size_t>(law)];
}

bool ReplayReport::exact() const noexcept {
  const bool same = std::ranges::all_of(laws, [](const LawReport& law) { return law.different == 0; });
  return same && different_rows == 0 && damaged_snapshots == 0 &&
         std::ranges::any_of(laws, [](const LawReport& law) { return law.compared != 0; });
}

std::string sentence(const ReplayDifference& difference) {
  const std::string_view source = difference.law ? name_of(*difference.law) : "row";
  return std::string(source) + ", run " + std::to_string(difference.run) + ", cycle " +
         std::to_string(difference.cycle) + ": " + difference.field + " is " + difference.replayed + ", logged as " +
         difference.logged;
}

std::string sentence(const ReplayGap& gap) {
  return std::string(name_of(gap.law)) + ", run " + std::to_string(gap.run) + ", cycles " + std::to_string(gap.first) +
         " … " + std::to_string(gap.last) + " (" + std::to_string(gap.rows) + " rows): " + gap.reason;
}

}  // namespace robot_control

#include "log/numbered_name.h"

#include <charconv>
#include <system_error>

namespace robot_control {

std::optional<std::uint64_t> number_in(std::string_view name, std::string_view prefix,
                                       std::string_view suffix) noexcept {
  if (name.size() <= prefix.size() + suffix.size() || !name.starts_with(prefix) || !name.ends_with(suffix)) return {};
  const char* const last = name.data() + name.size() - suffix.size();
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(name.data() + prefix.size(), last, number);
  if (error != std::errc() || end != last) return {};
  return number;
}

}  // namespace robot_control

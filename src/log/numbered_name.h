#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace robot_control {

/// N of the file name PREFIX N SUFFIX ("run.7.csv"); nothing: it is another name.
std::optional<std::uint64_t> number_in(std::string_view name, std::string_view prefix,
                                       std::string_view suffix) noexcept;

}  // namespace robot_control

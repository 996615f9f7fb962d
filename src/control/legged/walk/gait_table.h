#pragma once
/// The gaits of every robot, of legs of kReferenceLeg. A new gait is a new row; everything else reads its name here.

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

#include "control/legged/walk/gait.h"

namespace robot_control {

inline constexpr std::array kGaits{
    Gait{{"stand"}, 0.5, 1, {0, 0, 0, 0}, 0},
    Gait{{"trot"}, 0.38, 0.5, {0.5, 0, 0, 0.5}, 0.08, 0.75},
    Gait{{"walking_trot"}, 0.5, 0.6, {0.5, 0, 0, 0.5}, 0.07, 0.9},
    Gait{{"crawl"}, 1.0, 0.78, {0, 0.5, 0.25, 0.75}, 0.06, 0.75},
};
static_assert(std::ranges::all_of(kGaits, walkable));

/// Returns the index of the row with this name, which must exist.
consteval std::uint64_t gait_named(std::string_view name) {
  std::uint64_t index = 0;
  while (name != kGaits[index].name.data()) ++index;
  return index;
}

inline constexpr std::uint64_t kStandGait = gait_named("stand");  ///< No foot leaves the ground.
// Without another request the speed chooses one of these.
inline constexpr std::uint64_t kSlowGait = gait_named("walking_trot");
inline constexpr std::uint64_t kFastGait = gait_named("trot");  ///< and in place

}  // namespace robot_control

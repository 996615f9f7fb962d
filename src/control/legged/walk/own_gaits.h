#pragma once
/// Gaits that a user describes in the parameters gait_1 … gait_4 of the leg controller, beside those of gait_table.h.
///
/// A gait has all of its members. It is refused where its name is taken, or where a foot swings for less than
/// kMinSwing. It is also refused where fewer than two feet bear at any time. It begins with phase 0. How fast a robot
/// walks with it follows from the robot (walking_speed.h).
///
/// While the two feet of one side bear alone, the body tips away from them, because no law sways it over these feet.
/// The same holds for the two front or rear feet. A gait is refused unless
///
///   T ≤ 0.7 k √(h/g)  ∧  T s ≤ 0.4 k √(h/g)
///
///   T  s, the longest time for which such feet bear alone
///   s  0 … 1, the part of the period in which such feet bear alone
///   h  height of a body on legs of kReferenceLeg, m
///   k  1 of sides, 1.5 of front and rear: a body is longer than wide
///
/// √(h/g) is the time constant with which an inverted pendulum falls. Times and heights of other legs change alike. The
/// factors are measured (docs/evidence/legs.md#gaits-of-ones-own).

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "parameters/block.h"

namespace robot_control {

struct Gait;

/// The members are those of Gait, of a leg of kReferenceLeg.
struct OwnGait {
  std::string name{};            ///< empty: there is none
  std::optional<double> period;  ///< s
  std::optional<double> duty;
  std::optional<NumberList<4>> phases;  ///< by LegPlace
  std::optional<double> lift;           ///< m
};

inline constexpr std::array<std::string_view, 4> kOwnGaits{"gait_1", "gait_2", "gait_3", "gait_4"};  ///< names of keys
using OwnGaits = std::array<OwnGait, kOwnGaits.size()>;

Keys keys(OwnGaits& gaits);
void check(const OwnGaits& gaits, const std::string& block, GivenValues& given);

/// Returns the gaits of gait_table.h, and those that were given.
std::vector<Gait> all_gaits(const OwnGaits& own);

/// Returns the words of set_gait: auto, and the names of these gaits but stand.
std::vector<std::string> gait_words(const std::vector<Gait>& gaits);

}  // namespace robot_control

#pragma once
/// A gait as data: when each foot bears, and how high it swings.
///
/// The phase of the gait grows from 0 to 1 within `period` and wraps. A leg's own phase is that of the gait plus its
/// offset, within 0 … 1. The foot bears while this phase is below `duty`, and swings for the rest of the period.
///
/// Periods and lifts are those of a leg of kReferenceLeg. They change with √l and l (R. McN. Alexander, A. S. Jayes,
/// J. Zool. 201 (1983) 135: legged machines of equal Froude number move alike).
///
/// Offsets are in the order of LegPlace. A gait begins where the phase of the last one wraps: with its `begin` if it
/// follows or is a crawl, else with 0. A crawl keeps three feet on the ground, with a duty of kMinCrawlDuty or more. It
/// begins with the feet at which a trot ends its stance: they are behind, and the body lies over the others. It ends
/// while the body crosses the line between two feet, at twice its mean speed. These feet alone would let it fall on, so
/// a trot after a crawl begins with all feet on the ground, for 0.1 s.

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <vector>

#include "machine/legs/leg_model.h"

namespace robot_control {

inline constexpr std::size_t kMaxGaitName = 16;  ///< bytes
inline constexpr double kMinCrawlDuty = 0.75;    ///< duty of a gait in which three feet bear

struct Gait {
  std::array<char, kMaxGaitName + 1> name;  ///< ends with 0
  double period;                            ///< s
  double duty;                              ///< 0 … 1; 1: no foot leaves the ground
  std::array<double, kLegs> phase;          ///< 0 … 1, offsets of the legs
  double lift;                              ///< m, of the foot's centre in the middle of its swing
  double begin = 0;                         ///< 0 … 1, the phase with which it begins after a crawl, or as one

  /// Returns the phase of a leg within 0 … 1.
  double leg_phase(std::size_t leg, double gait_phase) const noexcept {
    const double sum = gait_phase + phase[leg];
    return sum - std::floor(sum);
  }

  bool bears(std::size_t leg, double gait_phase) const noexcept {
    return duty >= 1 || leg_phase(leg, gait_phase) < duty;
  }

  /// Returns how much of its swing a foot has done, 0 … 1; 0 while it bears.
  double swung(std::size_t leg, double gait_phase) const noexcept {
    return bears(leg, gait_phase) ? 0 : (leg_phase(leg, gait_phase) - duty) / (1 - duty);
  }

  /// Returns for how many s a foot that bears still does, until its next swing. It has landed early if the clock lets
  /// it swing; where its swing begins it is 0.
  double bears_for(std::size_t leg, double gait_phase) const noexcept {
    const double own = leg_phase(leg, gait_phase);
    return own == duty ? 0 : period * (duty - own + (own < duty ? 0 : 1));
  }

  /// Returns whether a foot swings that stood where this gait began `lasted` s ago. A swing that would have begun
  /// before does not begin.
  bool swings_since(std::size_t leg, double gait_phase, double lasted) const noexcept {
    return !bears(leg, gait_phase) && swung(leg, gait_phase) * swing_time() <= lasted;
  }

  bool crawls() const noexcept { return duty >= kMinCrawlDuty && duty < 1; }

  /// Returns the phase with which this gait begins after `last`.
  double begins_after(const Gait& last) const noexcept { return crawls() || last.crawls() ? begin : 0; }

  double stance_time() const noexcept { return period * duty; }
  double swing_time() const noexcept { return period * (1 - duty); }

  /// Returns this gait of a robot with legs of `length` m.
  Gait scaled(double length) const noexcept {
    Gait gait = *this;
    gait.period *= std::sqrt(length / kReferenceLeg);
    gait.lift *= length / kReferenceLeg;
    return gait;
  }
};

/// The gaits of a robot: those of gait_table.h, then those of its user. A gait is named by its index in this list.
using Gaits = std::vector<Gait>;

inline constexpr double kMinSwing = 0.05;  ///< s, of a foot

/// Returns true if a robot can walk with this gait. Each foot has to bear for a part of the period, to swing for long
/// enough, and to be lifted.
constexpr bool walkable(const Gait& gait) noexcept {
  if (!(gait.duty > 0 && gait.duty <= 1 && gait.lift >= 0 && gait.period > 0 && gait.begin >= 0 && gait.begin < 1))
    return false;
  for (const double offset : gait.phase)
    if (!(offset >= 0 && offset < 1)) return false;
  return gait.duty == 1 || (gait.lift > 0 && gait.period * (1 - gait.duty) >= kMinSwing);
}

/// Calls `each` with each part of the period in which the same feet bear, and with these feet by LegPlace. Other feet
/// bear where a leg's phase passes 0 or the duty; gaps of rounding errors between these are left out.
template <class Each>
void for_each_support(const Gait& gait, const Each& each) {
  constexpr double kMinInterval = 1e-9;
  std::array<double, 2 * kLegs + 1> changes{};
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    changes[2 * leg] = 1 - gait.leg_phase(leg, 0);
    changes[2 * leg + 1] = 1 - gait.leg_phase(leg, 1 - gait.duty);
  }
  std::sort(changes.begin(), changes.end() - 1);
  changes.back() = changes.front() + 1;
  for (std::size_t i = 0; i + 1 < changes.size(); ++i) {
    if (changes[i + 1] - changes[i] < kMinInterval) continue;
    std::bitset<kLegs> feet;
    for (std::size_t leg = 0; leg < kLegs; ++leg) feet[leg] = gait.bears(leg, (changes[i] + changes[i + 1]) / 2);
    each(changes[i + 1] - changes[i], feet);
  }
}

/// Returns how many feet bear at the same time at least.
inline std::size_t fewest_feet(const Gait& gait) noexcept {
  std::size_t fewest = kLegs;
  for_each_support(gait, [&](double, const std::bitset<kLegs>& feet) { fewest = std::min(fewest, feet.count()); });
  return fewest;
}

}  // namespace robot_control

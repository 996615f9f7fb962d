#pragma once
/// Whether map, place and laser can all be true: the scans are compared with the map (Agreement in costmap.h).
///
/// A scan is bad if more than kContradicting of its rays pass walls of the map, or less than kExplainedLeast end at
/// them. The map is contradicted from kBadScans more bad scans than good ones on, until as many good ones
/// have followed.
///
/// A house that is much like the map contradicts it less, and still shuts ways that the map has open. The reason of a
/// failure says how much, if less than kAgreeing of the rays agree.

#include <string>

#include "navigation/costmap.h"

namespace robot_control::navigation {

inline constexpr int kBadScans = 5;             ///< scans; what stands wrong for half a second is no noise
inline constexpr double kContradicting = 0.15;  ///< 2° and 5 cm at 4 m make 3 to 5 %, at door posts
inline constexpr double kExplainedLeast = 0.2;  ///< boxes all around leave a third
inline constexpr double kAgreeing = 0.85;       ///< in the house of the map 89 to 99 % do
inline constexpr int kMinRays = 20;             ///< scans of fewer hits are not judged

/// The agreement of the last scans with the map.
class MapConsistency {
 public:
  void update(const Agreement& seen);

  /// Returns the contradiction as a sentence; "" without one.
  const std::string& problem() const noexcept { return contradicts_ ? text_ : none_; }

  /// Returns what to add to the reason of a failure; "" if scans and map agree on the mean, or problem()
  /// says it.
  std::string explanation() const;

 private:
  int bad_ = 0;
  double agreeing_ = 1;  // part of the rays
  bool contradicts_ = false;
  std::string text_, none_;
};

}  // namespace robot_control::navigation

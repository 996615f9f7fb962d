#pragma once
/// Checks whether map, pose and laser can all be true: the scans are compared with the map (Agreement in costmap.h).
///
/// A scan is bad if more than kMaxContradicting of its rays pass walls of the map, or less than kMinExplained end at
/// them. The map is contradicted from kBadScans more bad scans than good ones on, until as many good ones
/// have followed.
///
/// A house that is similar to the map contradicts it less, and may still block passages that are open in the map. The
/// reason of a failure states the share of contradicting rays if less than kMinAgreement of the rays agree.

#include <string>

#include "navigation/costmap.h"

namespace robot_control::navigation {

inline constexpr int kBadScans = 5;                ///< scans; a contradiction that lasts half a second is not noise
inline constexpr double kMaxContradicting = 0.15;  ///< 2° and 5 cm at 4 m make 3 to 5 %, at door posts
inline constexpr double kMinExplained = 0.2;       ///< boxes all around leave a third
inline constexpr double kMinAgreement = 0.85;      ///< in the house of the map 89 to 99 % do
inline constexpr int kMinRays = 20;                ///< scans of fewer hits are not judged

/// The agreement of the last scans with the map.
class MapConsistency {
 public:
  void update(const Agreement& seen);

  /// Returns the contradiction as a sentence; "" without one.
  const std::string& problem() const noexcept { return contradicts_ ? text_ : none_; }

  /// Returns what to add to the reason of a failure; "" if scans and map agree on average, or if problem() is the
  /// reason.
  std::string explanation() const;

 private:
  int bad_ = 0;
  double agreeing_ = 1;  // part of the rays
  bool contradicts_ = false;
  std::string text_, none_;
};

}  // namespace robot_control::navigation

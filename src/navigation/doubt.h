#pragma once
/// Whether map, place and laser can all be true: the scans are compared with the map (Agreement in costmap.h).
///
/// A scan is bad if more than kContradicting of its rays pass walls of the map, or less than kExplainedLeast end at
/// them. The doubt begins with kDoubtful more bad scans than good ones. It ends when as many good ones have followed.

#include <string>

#include "navigation/costmap.h"

namespace robot_control {

inline constexpr int kDoubtful = 5;             ///< scans; what stands wrong for half a second is no noise
inline constexpr double kContradicting = 0.15;  ///< 2° and 5 cm at 4 m make 3 to 5 %, at door posts
inline constexpr double kExplainedLeast = 0.2;  ///< boxes all around leave a third
inline constexpr int kFewRays = 20;             ///< scans of fewer hits are not judged

class Doubt {
 public:
  void update(const Agreement& seen);

  /// Returns the doubt as a sentence; "" without one.
  const std::string& problem() const noexcept { return doubtful_ ? text_ : none_; }

 private:
  int bad_ = 0;
  bool doubtful_ = false;
  std::string text_, none_;
};

}  // namespace robot_control

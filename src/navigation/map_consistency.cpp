#include "navigation/map_consistency.h"

#include <algorithm>
#include <cmath>

namespace robot_control::navigation {
namespace {

constexpr double kShare = 0.2;  // of the newest scan in the mean

}  // namespace

void MapConsistency::update(const Agreement& seen) {
  if (seen.rays < kMinRays) return;
  const int agreeing = seen.rays - seen.contradicting - seen.unexpected;
  agreeing_ += kShare * (static_cast<double>(agreeing) / seen.rays - agreeing_);
  const bool bad = seen.contradicting > kMaxContradicting * seen.rays || seen.explained < kMinExplained * seen.rays;
  bad_ = std::clamp(bad_ + (bad ? 1 : -1), 0, kBadScans);
  contradicts_ = bad_ == kBadScans || (contradicts_ && bad_ > 0);
  if (bad) {
    text_ = "the scan contradicts the map: of " + std::to_string(seen.rays) + " rays " +
            std::to_string(seen.contradicting) + " pass its walls and " + std::to_string(seen.explained) +
            " end at them. Is this the map of this place, and the robot where it is taken to be?";
  }
}

std::string MapConsistency::explanation() const {
  if (contradicts_ || agreeing_ >= kMinAgreement) return "";
  return "; the scan contradicts the map in " + std::to_string(std::lround(100 * (1 - agreeing_))) +
         " % of its rays: they pass through walls or end in free space";
}

}  // namespace robot_control::navigation

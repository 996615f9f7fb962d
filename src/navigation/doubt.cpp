#include "navigation/doubt.h"

#include <algorithm>

namespace robot_control {

void Doubt::update(const Agreement& seen) {
  if (seen.rays < kFewRays) return;
  const bool bad = seen.contradicting > kContradicting * seen.rays || seen.explained < kExplainedLeast * seen.rays;
  bad_ = std::clamp(bad_ + (bad ? 1 : -1), 0, kDoubtful);
  doubtful_ = bad_ == kDoubtful || (doubtful_ && bad_ > 0);
  if (bad) {
    text_ = "the scan contradicts the map: of " + std::to_string(seen.rays) + " rays " +
            std::to_string(seen.contradicting) + " pass its walls and " + std::to_string(seen.explained) +
            " end at them. Is this the map of this place, and the robot where it is taken to be?";
  }
}

}  // namespace robot_control

#include <gtest/gtest.h>

#include "log/black_box/black_box_keeper.h"

namespace robot_control::tests {

/// A robot drives, nothing is latched.
struct AnIncidentWatch : testing::Test {
  static constexpr std::int64_t kSecond = 1'000'000'000;
  AnIncidentWatch() { watch.update(0, 0); }
  IncidentWatch watch;
};

TEST_F(AnIncidentWatch, IsDueFiveSecondsAfterAStopAndOnceOnly) {
  watch.update(4, 7 * kSecond);
  watch.update(4 | 8, 8 * kSecond);
  EXPECT_FALSE(watch.due(12 * kSecond - 1));
  EXPECT_TRUE(watch.due(12 * kSecond));
  EXPECT_EQ(watch.clear(), 4u | 8u) << "with what came after it";
  EXPECT_FALSE(watch.pending());
  watch.update(4 | 8, 13 * kSecond);
  EXPECT_FALSE(watch.pending()) << "it is the same stop until it is released";
}

TEST_F(AnIncidentWatch, TakesAStopThatIsLatchedAtFirstSightForOneOfBefore) {
  IncidentWatch started_now;
  EXPECT_FALSE(started_now.update(4, 0));
  EXPECT_FALSE(started_now.pending());
  started_now.update(0, kSecond);
  EXPECT_TRUE(started_now.update(4, 2 * kSecond));
}

TEST_F(AnIncidentWatch, SavesStopsThatFollowEachOtherTogetherButWithinHalfAMinute) {
  for (int second = 0; second < 60 && !watch.due(second * kSecond); second += 2) {
    watch.update(4, second * kSecond);
    watch.update(0, (second + 1) * kSecond);
  }
  EXPECT_TRUE(watch.due(30 * kSecond));
  EXPECT_FALSE(watch.due(30 * kSecond - 1));
}

}  // namespace robot_control::tests

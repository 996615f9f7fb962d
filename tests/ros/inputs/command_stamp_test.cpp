#include <gtest/gtest.h>

#include "ros/inputs/command_input.h"
#include "ros/nanoseconds.h"

namespace robot_control::tests {

constexpr std::int64_t kTimeout = 1'250'000'000;
constexpr std::int64_t kNow = 1'700'000'000 * kSecond;

JudgedStamp aged(std::int64_t age_ns, std::int64_t timeout_ns = kTimeout) {
  return judge_stamp(kNow - age_ns, kNow, timeout_ns);
}

TEST(CommandStamp, OfZeroIsNone) {
  EXPECT_EQ(judge_stamp(0, kNow, kTimeout).verdict, StampVerdict::kUsable);
  EXPECT_EQ(judge_stamp(0, kNow, kTimeout).age_ns, 0);
}

TEST(CommandStamp, GivesTheAgeAtArrival) {
  EXPECT_EQ(aged(0).age_ns, 0);
  EXPECT_EQ(aged(30'000'000).age_ns, 30'000'000);
  EXPECT_EQ(aged(30'000'000).verdict, StampVerdict::kUsable);
}

TEST(CommandStamp, IsTooOldBeyondTheTimeoutAndNotAtIt) {
  EXPECT_EQ(aged(kTimeout).verdict, StampVerdict::kUsable);
  EXPECT_EQ(aged(kTimeout + 1).verdict, StampVerdict::kTooOld);
  EXPECT_EQ(aged(kHour).verdict, StampVerdict::kTooOld);
  EXPECT_EQ(aged(kHour).age_ns, kHour) << "for the message";
}

TEST(CommandStamp, OfTheFutureCountsAsNewWithinWhatClocksDiffer) {
  EXPECT_EQ(aged(-kClockSkew).verdict, StampVerdict::kUsable);
  EXPECT_EQ(aged(-kClockSkew).age_ns, 0) << "no command outlives the timeout";
  EXPECT_EQ(aged(-kClockSkew - 1).verdict, StampVerdict::kFuture);
  EXPECT_EQ(aged(-kHour).verdict, StampVerdict::kFuture);
}

TEST(CommandStamp, IsNotLookedAtWithoutATimeout) {
  for (const std::int64_t age : {-kHour, kHour}) {
    EXPECT_EQ(aged(age, 0).verdict, StampVerdict::kUsable);
    EXPECT_EQ(aged(age, 0).age_ns, 0);
  }
}

TEST(CommandStamp, FarthestOfTheWireOverflowsNothing) {
  // time of ROS 1: 32 bits of seconds and 32 of nanoseconds.
  constexpr std::int64_t kFarthest = 0xffffffff * kSecond + 0xffffffff;
  EXPECT_EQ(judge_stamp(kFarthest, 0, kTimeout).verdict, StampVerdict::kFuture);
  EXPECT_EQ(judge_stamp(1, kFarthest, kTimeout).verdict, StampVerdict::kTooOld);
}

}  // namespace robot_control::tests

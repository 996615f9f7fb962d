#include "ros/inputs/clearance_stream.h"

#include <gtest/gtest.h>

namespace robot_control::tests {

constexpr std::int64_t kPeriodOfScans = kStreamSilence / 5;
constexpr double kFree = std::numeric_limits<double>::infinity();

TEST(ClearanceStreamTest, AStreamThatPausesFallsSilentOnce) {
  ClearanceStream stream;
  for (std::int64_t at = 0; at <= 4 * kPeriodOfScans; at += kPeriodOfScans) stream.receive(1, at);
  EXPECT_FALSE(stream.falls_silent(4 * kPeriodOfScans + kStreamSilence - 1));
  EXPECT_TRUE(stream.falls_silent(4 * kPeriodOfScans + kStreamSilence));
  EXPECT_FALSE(stream.falls_silent(9 * kStreamSilence));
}

TEST(ClearanceStreamTest, ASingleValueAndSlowOnesHold) {
  ClearanceStream stream;
  stream.receive(1, 0);
  EXPECT_FALSE(stream.falls_silent(10 * kStreamSilence));
  stream.receive(1, 10 * kStreamSilence);
  stream.receive(1, 11 * kStreamSilence);
  EXPECT_FALSE(stream.falls_silent(20 * kStreamSilence));
}

TEST(ClearanceStreamTest, InfinityEndsAStream) {
  ClearanceStream stream;
  stream.receive(1, 0);
  stream.receive(1, 1);
  stream.receive(kFree, 2);
  EXPECT_FALSE(stream.falls_silent(10 * kStreamSilence));
}

TEST(ClearanceStreamTest, AStreamBeginsAgainAfterItsSilence) {
  ClearanceStream stream;
  stream.receive(1, 0);
  stream.receive(1, 1);
  EXPECT_TRUE(stream.falls_silent(2 * kStreamSilence));
  stream.receive(1, 3 * kStreamSilence);
  stream.receive(1, 3 * kStreamSilence + 1);
  EXPECT_TRUE(stream.falls_silent(5 * kStreamSilence));
}

}  // namespace robot_control::tests

#include "ros/reports/pacer.h"

#include <gtest/gtest.h>

namespace robot_control::tests {

constexpr std::int64_t kMillisecond = 1'000'000;

/// Messages of a topic of `rate` Hz in one second, checked every `step_ns`.
int sent_in_a_second(double rate, std::int64_t step_ns) {
  Pacer pacer(rate);
  int sent = 0;
  for (std::int64_t stamp = 0; stamp < 1000 * kMillisecond; stamp += step_ns) sent += pacer.due(1, stamp) ? 1 : 0;
  return sent;
}

TEST(Pacer, KeepsItsRateOnAverageWhateverTheStep) {
  EXPECT_EQ(sent_in_a_second(100, kMillisecond), 100);
  EXPECT_EQ(sent_in_a_second(100, 3 * kMillisecond), 100);
  EXPECT_EQ(sent_in_a_second(50, 2 * kMillisecond), 50);
}

TEST(Pacer, NeverSendsTheSameStampTwice) {
  Pacer pacer(1000);
  EXPECT_TRUE(pacer.due(1, 5 * kMillisecond));
  EXPECT_FALSE(pacer.due(1, 5 * kMillisecond));
}

TEST(Pacer, DoesNotMakeUpForAGap) {
  Pacer pacer(100);
  EXPECT_TRUE(pacer.due(1, 0));
  EXPECT_TRUE(pacer.due(1, 500 * kMillisecond));
  EXPECT_FALSE(pacer.due(1, 501 * kMillisecond));
}

TEST(Pacer, RestartsWithARun) {
  Pacer pacer(1);
  EXPECT_TRUE(pacer.due(1, 0));
  EXPECT_FALSE(pacer.due(1, kMillisecond));
  EXPECT_TRUE(pacer.due(2, 2 * kMillisecond));
}

}  // namespace robot_control::tests

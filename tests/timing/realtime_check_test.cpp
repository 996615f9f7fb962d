#include "timing/realtime_check.h"

#include <gtest/gtest.h>

namespace robot_control::tests {

constexpr std::int64_t kInterval = 1'000'000'000;

/// A thread that waits 1000 times per second and does nothing else that blocks.
struct RealtimeCheckTest : testing::Test {
  RealtimeReading reading{.counters = {.page_faults = 40, .run_queue_ns = 0}};
  RealtimeCheck check;

  void run(int seconds) {
    for (int i = 0; i < seconds; ++i) {
      check.add(reading);
      reading.time_ns += kInterval;
      reading.waits_before += 1000;
      reading.waits_after = reading.waits_before;
      reading.counters.voluntary_switches += 1000;
      *reading.counters.run_queue_ns += 50'000;
      reading.machine.total += 200;
      reading.machine.stolen += 1;
    }
  }
};

TEST_F(RealtimeCheckTest, AThreadThatOnlyWaitsHasNoViolation) {
  run(30);
  EXPECT_EQ(check.total().page_faults + check.total().blocks, 0u);
  EXPECT_EQ(check.recent().voluntary_switches, 10'000u);
  EXPECT_EQ(check.recent().run_queue_ns, 500'000u);
  EXPECT_DOUBLE_EQ(check.recent().stolen, 1.0 / 200);
}

TEST_F(RealtimeCheckTest, AWaitThatBeganBeforeAReadingMaySwitchAfterIt) {
  run(10);
  ++reading.counters.voluntary_switches;
  run(5);
  EXPECT_EQ(check.total().blocks, 0u);
}

TEST_F(RealtimeCheckTest, MoreSwitchesThanWaitsAreAViolation) {
  run(10);
  reading.counters.voluntary_switches += 2;
  run(5);
  EXPECT_EQ(check.total().blocks, 1u);
  EXPECT_EQ(check.recent().blocks, 1u);
  run(20);
  EXPECT_EQ(check.total().blocks, 1u);
  EXPECT_EQ(check.recent().blocks, 0u);
}

TEST_F(RealtimeCheckTest, APageFaultIsAViolation) {
  run(10);
  reading.counters.page_faults += 3;
  run(5);
  EXPECT_EQ(check.total().page_faults, 3u);
}

TEST_F(RealtimeCheckTest, TheFirstTwoSecondsDoNotCount) {
  check.add(reading);
  reading.time_ns += kInterval;
  reading.counters.page_faults += 5;
  check.add(reading);
  reading.time_ns += kInterval;
  run(5);
  EXPECT_EQ(check.total().page_faults + check.total().blocks, 0u);
}

TEST_F(RealtimeCheckTest, AWaitBetweenTheTwoReadsOfOneReadingIsNoViolation) {
  run(10);
  reading.waits_after += 1;  // the thread waited while its counters were read
  reading.counters.voluntary_switches += 1;
  check.add(reading);
  reading.waits_before += 1;
  EXPECT_EQ(check.total().blocks, 0u);
}

TEST_F(RealtimeCheckTest, WhatTheKernelDoesNotCountIsNotReported) {
  reading.counters.run_queue_ns.reset();
  for (int i = 0; i < 5; ++i, reading.time_ns += kInterval) check.add(reading);
  EXPECT_FALSE(check.recent().run_queue_ns.has_value());
}

}  // namespace robot_control::tests

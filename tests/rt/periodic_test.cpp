#include "rt/periodic.h"

#include <gtest/gtest.h>

namespace robot_control::tests {

constexpr std::int64_t kStart = 5'000'000'000;
constexpr std::int64_t kPeriod = 1'000'000;

struct PeriodicTest : testing::Test {
  Periodic schedule_{kStart, kPeriod};
};

TEST_F(PeriodicTest, TheFirstDeadlineIsTheStart) {
  EXPECT_EQ(schedule_.deadline_ns(), kStart);
}

TEST_F(PeriodicTest, WakeUpLatencyDoesNotAddUp) {
  for (int k = 0; k < 1000; ++k) {
    EXPECT_EQ(schedule_.begin(schedule_.deadline_ns() + 60'000), 0);
    EXPECT_TRUE(schedule_.end(schedule_.deadline_ns() + 500'000));
  }
  EXPECT_EQ(schedule_.deadline_ns(), kStart + 1000 * kPeriod);
  EXPECT_EQ(schedule_.slipped_ns(), 0);
  EXPECT_EQ(schedule_.overruns(), 0u);
}

TEST_F(PeriodicTest, AnEarlyWakeUpIsNotLate) {
  EXPECT_EQ(schedule_.begin(kStart - 10), 0);
  EXPECT_EQ(schedule_.slipped_ns(), 0);
}

TEST_F(PeriodicTest, LatenessBelowAPeriodKeepsTheGrid) {
  schedule_.begin(kStart + kPeriod - 1);
  schedule_.end(kStart + kPeriod - 1);
  EXPECT_EQ(schedule_.deadline_ns(), kStart + kPeriod);
  EXPECT_EQ(schedule_.slipped_ns(), 0);
}

TEST_F(PeriodicTest, ATickThatEndsAfterTheNextDeadlineIsAnOverrun) {
  schedule_.begin(kStart);
  EXPECT_TRUE(schedule_.end(kStart + kPeriod));
  schedule_.begin(kStart + kPeriod);
  EXPECT_FALSE(schedule_.end(kStart + 2 * kPeriod + 1));
  EXPECT_EQ(schedule_.overruns(), 1u);
}

TEST_F(PeriodicTest, AStallSlipsTheGridInsteadOfABurst) {
  const std::int64_t woke = kStart + 7 * kPeriod + 300;
  EXPECT_EQ(schedule_.begin(woke), 0);  // k stays consecutive
  EXPECT_EQ(schedule_.slipped_ns(), 7 * kPeriod + 300);
  EXPECT_TRUE(schedule_.end(woke + 100));
  EXPECT_EQ(schedule_.deadline_ns(), woke + kPeriod);  // a full period later, not at once
}

// A machine needs 1.5 periods per tick: 2 periods of plant time take 3 of wall time.
TEST_F(PeriodicTest, ATooSlowMachineSlipsByWhatItLacksAndNeverRunsTwoTicksInOnePeriod) {
  std::int64_t now = kStart;
  std::vector<std::int64_t> begins;
  for (int k = 0; k < 100; ++k) {
    now = std::max(now, schedule_.deadline_ns());
    begins.push_back(now);
    schedule_.begin(now);
    now += kPeriod * 3 / 2;
    schedule_.end(now);
  }
  const std::int64_t lacking = 100 * (kPeriod * 3 / 2) - 100 * kPeriod;
  EXPECT_NEAR(static_cast<double>(schedule_.slipped_ns()), static_cast<double>(lacking),
              static_cast<double>(kPeriod));  // the last lateness below a period is not slip yet
  for (std::size_t i = 1; i < begins.size(); ++i) EXPECT_GE(begins[i] - begins[i - 1], kPeriod);
  EXPECT_EQ(schedule_.overruns(), 100u);
}

TEST_F(PeriodicTest, TheDeadlineIsStartPlusCyclesPlusSlip) {
  std::uint64_t random = 1;
  for (int k = 0; k < 10'000; ++k) {
    random = random * 6364136223846793005ULL + 1442695040888963407ULL;
    const auto late = static_cast<std::int64_t>(random >> 42);  // 0 … 4.2 periods
    schedule_.begin(schedule_.deadline_ns() + late);
    ASSERT_EQ(schedule_.deadline_ns(), kStart + k * kPeriod + schedule_.slipped_ns());
    schedule_.end(schedule_.deadline_ns());
  }
}

TEST_F(PeriodicTest, TheGridStaysOnHardwareAndTheCycleJumps) {
  Periodic hardware(kStart, kPeriod, WhenLate::kSkip);
  EXPECT_EQ(hardware.begin(kStart + 7 * kPeriod + 300), 7);
  EXPECT_EQ(hardware.missed(), 7);
  EXPECT_EQ(hardware.slipped_ns(), 0);
  hardware.end(kStart + 7 * kPeriod + 400);
  EXPECT_EQ(hardware.deadline_ns(), kStart + 8 * kPeriod);
  EXPECT_EQ(hardware.begin(kStart + 8 * kPeriod), 0);
}

}  // namespace robot_control::tests

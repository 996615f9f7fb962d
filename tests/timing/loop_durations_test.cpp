#include "timing/loop_durations.h"

#include <gtest/gtest.h>

namespace robot_control::tests {

constexpr std::int64_t kPeriod = 1'000'000;  // ns
constexpr std::int64_t kStart = 5'000'000'000;

/// A loop whose threads wake up and publish at the same times in each cycle, ns after it was due.
CycleTimes punctual(std::uint64_t cycle) {
  CycleTimes times;
  times.driver = {.run = 7, .cycle = cycle, .due_ns = kStart + static_cast<std::int64_t>(cycle) * kPeriod};
  times.driver.timing = {.woke_ns = 20, .published_ns = 30};
  if (cycle > 0) times.driver.command_cycle = cycle - 1;
  times.timing = {times.driver.timing, CycleTiming{35, 50}, CycleTiming{54, 70}, CycleTiming{40, 60}};
  return times;
}

struct LoopDurationsTest : testing::Test {
  LoopDurations all{{Role::kDriver, Role::kEstimator, Role::kController, Role::kMonitor}};

  void add(std::uint64_t first, std::uint64_t last) {
    for (std::uint64_t cycle = first; cycle <= last; ++cycle) all.add(punctual(cycle));
  }

  DurationFigures of(Role role, Quantity quantity) const {
    for (const auto& entry : all.entries()) {
      if (entry.role == role && entry.quantity == quantity) return entry.durations.total();
    }
    return {};
  }

  void expect(Role role, Quantity quantity, std::int64_t duration, std::uint64_t samples) const {
    const DurationFigures figures = of(role, quantity);
    EXPECT_EQ(figures.min, duration) << name_of(quantity);
    EXPECT_EQ(figures.max, duration) << name_of(quantity);
    EXPECT_EQ(figures.samples, samples) << name_of(quantity);
  }
};

TEST_F(LoopDurationsTest, MeasuresEachRoleOfAPunctualLoop) {
  add(0, 99);
  for (const Role role : {Role::kDriver, Role::kEstimator, Role::kController, Role::kMonitor}) {
    expect(role, Quantity::kCyclePeriod, kPeriod, 99);
  }
  expect(Role::kDriver, Quantity::kWakeUp, 20, 100);
  expect(Role::kEstimator, Quantity::kWakeUp, 5, 100);   // after the sensors
  expect(Role::kController, Quantity::kWakeUp, 4, 100);  // after the state
  expect(Role::kMonitor, Quantity::kWakeUp, 10, 100);
  expect(Role::kEstimator, Quantity::kExecution, 15, 100);
  expect(Role::kController, Quantity::kSensorToCommand, 50, 100);
  expect(Role::kDriver, Quantity::kSensorToTorque, kPeriod + 10, 99);
}

TEST_F(LoopDurationsTest, AHeldCommandHasTheAgeOfItsSensors) {
  add(0, 5);
  CycleTimes late = punctual(6);
  late.driver.command_cycle = 4;
  all.add(late);
  EXPECT_EQ(of(Role::kDriver, Quantity::kSensorToTorque).max, 2 * kPeriod + 10);
}

TEST_F(LoopDurationsTest, ATickThatBrakesHasNoTorque) {
  add(0, 5);
  CycleTimes brakes = punctual(6);
  brakes.driver.command_cycle.reset();
  all.add(brakes);
  EXPECT_EQ(of(Role::kDriver, Quantity::kSensorToTorque).samples, 5u);
}

TEST_F(LoopDurationsTest, ATickThatSlipsWasLateByWhatSlipped) {
  add(0, 5);
  CycleTimes late = punctual(6);
  late.driver.slipped_ns = 3 * kPeriod;
  late.driver.due_ns += 3 * kPeriod;
  all.add(late);
  EXPECT_EQ(of(Role::kDriver, Quantity::kWakeUp).max, 3 * kPeriod + 20);
  EXPECT_EQ(of(Role::kDriver, Quantity::kCyclePeriod).max, 4 * kPeriod);
}

TEST_F(LoopDurationsTest, APauseIsNeitherAPeriodNorOnTheWayToTheTorque) {
  add(0, 5);
  for (std::uint64_t cycle = 6; cycle <= 8; ++cycle) {
    CycleTimes resumed = punctual(cycle);
    resumed.driver.held_ns = 5 * kPeriod;
    resumed.driver.due_ns += 5 * kPeriod;
    all.add(resumed);
  }
  expect(Role::kDriver, Quantity::kCyclePeriod, kPeriod, 7);
  expect(Role::kDriver, Quantity::kSensorToTorque, kPeriod + 10, 7);
}

TEST_F(LoopDurationsTest, ASkippedCycleIsCountedAndNoPeriod) {
  add(0, 5);
  CycleTimes absent = punctual(6);
  absent.timing[1].reset();
  all.add(absent);
  add(7, 7);
  EXPECT_EQ(all.skipped(Role::kEstimator), 1u);
  EXPECT_EQ(all.skipped(Role::kDriver), 0u);
  EXPECT_EQ(of(Role::kEstimator, Quantity::kCyclePeriod).samples, 5u);
}

TEST_F(LoopDurationsTest, ARunThatBeginsIsNeitherAPeriodNorASkip) {
  add(0, 5);
  CycleTimes other = punctual(0);
  other.driver.run = 8;
  all.add(other);
  EXPECT_EQ(of(Role::kDriver, Quantity::kCyclePeriod).max, kPeriod);
  EXPECT_EQ(all.skipped(Role::kDriver), 0u);
}

TEST_F(LoopDurationsTest, ARoleThatAnswersACycleAgainDoesNotCount) {
  add(0, 5);
  CycleTimes again = punctual(5);
  again.timing[3] = CycleTiming{9 * kPeriod, 9 * kPeriod};
  all.add(again);
  EXPECT_EQ(of(Role::kMonitor, Quantity::kWakeUp).max, 10);
}

TEST_F(LoopDurationsTest, OverrunsOfAllRunsAreAdded) {
  CycleTimes times = punctual(0);
  times.driver.overruns = 2;
  all.add(times);
  times = punctual(1);
  times.driver.overruns = 3;
  all.add(times);
  times = punctual(0);
  times.driver.run = 8;
  times.driver.overruns = 1;
  all.add(times);
  EXPECT_EQ(all.overruns(), 4u);
}

}  // namespace robot_control::tests

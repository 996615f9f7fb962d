// Positions and velocities of a drive whose frames are late by random times.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "drivers/drive/late_position.h"
#include "drivers/position_difference.h"

namespace robot_control::tests {

constexpr std::int64_t kPeriodNs = 1'000'000;
constexpr double kPeriod = 1.0e-9 * kPeriodNs;  // s
constexpr std::int64_t kSettled = 4 * LatePosition::kFrames;

struct Sample {
  double true_position = 0;  // at `now_ns`
  double position = 0;       // at the time of sampling
  double velocity = 0;
  std::int64_t now_ns = 0;
};

/// `position` of the time in s is sampled each period and arrives up to `latest_ns` later.
template <class Position>
std::vector<Sample> samples(const Position& position, std::int64_t latest_ns, std::int64_t count) {
  std::mt19937_64 generator(1);
  std::uniform_int_distribution<std::int64_t> late(0, latest_ns);
  std::vector<Sample> out;
  std::int64_t arrival_ns = -1;
  for (std::int64_t i = 0; i < count; ++i) {
    const double sampled = kPeriod * static_cast<double>(i);
    arrival_ns = std::max(arrival_ns + 1, i * kPeriodNs + late(generator));
    out.push_back({.true_position = position(1.0e-9 * static_cast<double>(arrival_ns)),
                   .position = position(sampled),
                   .velocity = (position(sampled + 1.0e-4) - position(sampled - 1.0e-4)) / 2.0e-4,
                   .now_ns = arrival_ns});
  }
  return out;
}

/// RMS about the mean of what the position is off, after kSettled samples.
template <class Take>
double noise(const std::vector<Sample>& all, const Take& take) {
  double sum = 0, squares = 0, count = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double off = take(all[i]) - all[i].true_position;
    if (i < static_cast<std::size_t>(kSettled)) continue;
    sum += off;
    squares += off * off;
    ++count;
  }
  return std::sqrt(squares / count - sum * sum / (count * count));
}

constexpr auto kTurning = [](double time) { return 5 * time; };

TEST(LatePosition, LateFramesDoNotMoveATurningJoint) {
  const auto all = samples(kTurning, kPeriodNs, 4 * kSettled);
  LatePosition late(kPeriodNs);
  const double raw = noise(all, [](const Sample& each) { return each.position; });
  const double filtered =
      noise(all, [&late](const Sample& each) { return late.step(each.position, each.velocity, each.now_ns); });
  EXPECT_GT(raw, 5 * kPeriod / 4);
  EXPECT_LT(filtered, raw / 100);
}

TEST(LatePosition, TakesThePositionAsItIsOnABusInTime) {
  LatePosition late(kPeriodNs);
  for (const Sample& each : samples([](double time) { return std::sin(20 * time); }, 0, 1000)) {
    EXPECT_EQ(late.step(each.position, each.velocity, each.now_ns), each.position);
  }
}

TEST(LatePosition, TakesThePositionAsItIsAtRest) {
  LatePosition late(kPeriodNs);
  for (const Sample& each : samples(kTurning, kPeriodNs, kSettled)) {
    late.step(each.position, each.velocity, each.now_ns);
  }
  EXPECT_EQ(late.step(7, 0, (kSettled + 1) * kPeriodNs), 7);
}

TEST(LatePosition, IsOffByAtMostTheWayOfTwoPeriodsOfAnAcceleratedJoint) {
  const auto all = samples([](double time) { return 5 * std::sin(2 * time); }, kPeriodNs, 4 * kSettled);
  LatePosition late(kPeriodNs);
  for (const Sample& each : all) {
    const double position = late.step(each.position, each.velocity, each.now_ns);
    EXPECT_LE(std::abs(position - each.true_position), 2 * 10 * kPeriod + 1.0e-9);
  }
}

TEST(LatePosition, ForgetsThatFramesWereLate) {
  LatePosition late(kPeriodNs);
  for (const Sample& each : samples(kTurning, kPeriodNs, kSettled)) late.step(each.position, 5, each.now_ns);
  EXPECT_GT(late.lateness_ns(), kPeriodNs);
  EXPECT_LE(late.lateness_ns(), 2 * kPeriodNs);
  for (std::int64_t i = 2 * kSettled; i < 3 * kSettled; ++i) late.step(0, 0, i * kPeriodNs);
  EXPECT_EQ(late.lateness_ns(), 0);
}

TEST(PositionDifference, IsTheMeanOverItsSamples) {
  PositionDifference difference;
  for (std::int64_t i = 0; i < 20; ++i) {
    difference.add(0.02 * static_cast<double>(i), kPeriodNs * i);
    EXPECT_NEAR(difference.velocity(), i > 0 ? 20 : 0, 1.0e-9);
  }
}

}  // namespace robot_control::tests

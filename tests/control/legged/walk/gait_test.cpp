#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "control/legged/walk/gait_table.h"

namespace robot_control::tests {

constexpr int kParts = 1000;  // of a period

std::array<bool, kLegs> bearing(const Gait& gait, double phase) {
  std::array<bool, kLegs> bears{};
  for (std::size_t leg = 0; leg < kLegs; ++leg) bears[leg] = gait.bears(leg, phase);
  return bears;
}

TEST(Gait, RefusesTablesWithWhichNoRobotWalks) {
  const Gait trot = kGaits[gait_named("trot")];
  EXPECT_TRUE(walkable(trot));
  const auto with = [&](auto change) {
    Gait gait = trot;
    change(gait);
    return walkable(gait);
  };
  EXPECT_FALSE(with([](Gait& gait) { gait.duty = 0; }));
  EXPECT_FALSE(with([](Gait& gait) { gait.period = 0.001; }));
  EXPECT_FALSE(with([](Gait& gait) { gait.duty = 1.01; }));
  EXPECT_FALSE(with([](Gait& gait) { gait.lift = -0.01; }));
  EXPECT_FALSE(with([](Gait& gait) { gait.lift = 0; }));
  EXPECT_FALSE(with([](Gait& gait) { gait.period = 0.099; })) << "a swing of 0.0495 s";
  EXPECT_TRUE(with([](Gait& gait) { gait.period = 0.1; }));
  EXPECT_FALSE(with([](Gait& gait) { gait.phase[0] = -0.01; }));
  EXPECT_FALSE(with([](Gait& gait) { gait.phase[2] = 1; }));
  EXPECT_FALSE(with([](Gait& gait) { gait.period = std::nan(""); }));
}

TEST(Gait, EachFootBearsForItsDutyAndSwingsOncePerPeriod) {
  for (const Gait& gait : kGaits) {
    for (std::size_t leg = 0; leg < kLegs; ++leg) {
      int bears = 0, landings = 0;
      for (int i = 0; i < kParts; ++i) {
        const double phase = (i + 0.5) / kParts;
        bears += gait.bears(leg, phase);
        landings += gait.bears(leg, phase) && !gait.bears(leg, phase - 1.0 / kParts);
      }
      EXPECT_NEAR(bears, gait.duty * kParts, 1) << gait.name.data();
      EXPECT_EQ(landings, gait.duty < 1 ? 1 : 0) << gait.name.data();
    }
  }
}

TEST(Gait, NoGaitLeavesFewerThanTwoFeet) {
  for (const Gait& gait : kGaits) EXPECT_GE(fewest_feet(gait), 2u) << gait.name.data();
}

TEST(Gait, TheFewestFeetAreThoseOfAnyPartOfThePeriod) {
  std::mt19937 random(7);
  std::uniform_int_distribution<int> hundredth(0, 99);
  std::array<int, kLegs + 1> found{};
  for (int k = 0; k < 1000; ++k) {
    Gait gait = kGaits[gait_named("crawl")];
    gait.duty = 0.01 * (1 + hundredth(random));
    for (double& offset : gait.phase) offset = 0.01 * hundredth(random);
    std::size_t fewest = kLegs;
    for (int i = 0; i < kParts; ++i) {
      const auto bears = bearing(gait, (i + 0.5) / kParts);
      fewest = std::min<std::size_t>(fewest, std::count(bears.begin(), bears.end(), true));
    }
    EXPECT_EQ(fewest_feet(gait), fewest) << k;
    ++found[fewest];
  }
  for (const int count : found) EXPECT_GT(count, 0);
}

TEST(Gait, ATrotMovesTheDiagonalFeetTogether) {
  for (const std::uint64_t gait : {gait_named("trot"), gait_named("walking_trot")}) {
    for (int i = 0; i < kParts; ++i) {
      const auto bears = bearing(kGaits[gait], (i + 0.5) / kParts);
      EXPECT_EQ(bears[0], bears[3]);
      EXPECT_EQ(bears[1], bears[2]);
    }
  }
}

/// A foot whose swing would have begun before the gait stands until its next one.
TEST(Gait, ATrotAfterACrawlBeginsWithAllFeetOnTheGround) {
  const Gait &stand = kGaits[kStandGait], &crawl = kGaits[gait_named("crawl")];
  const Gait &trot = kGaits[gait_named("trot")], &walking = kGaits[gait_named("walking_trot")];
  for (const auto& [last, next] : {std::pair(crawl, trot), std::pair(crawl, walking)}) {
    const double begin = next.begins_after(last);
    double until = next.period;
    for (std::size_t leg = 0; leg < kLegs; ++leg) {
      const double left = next.duty - next.leg_phase(leg, begin);
      until = std::min(until, next.period * (left < 0 ? left + 1 : left));
    }
    EXPECT_NEAR(until, 0.1, 0.01) << next.name.data();
  }
  for (const auto& [last, next] : {std::pair(walking, trot), std::pair(trot, walking), std::pair(stand, trot)})
    EXPECT_EQ(next.begins_after(last), 0) << next.name.data();
  for (const Gait& last : {stand, trot}) EXPECT_EQ(crawl.begins_after(last), 0.75) << last.name.data();
}

TEST(Gait, ACrawlLiftsOneFootAtATimeInTheOrderOfAWalk) {
  const Gait& crawl = kGaits[gait_named("crawl")];
  std::vector<std::size_t> order;
  for (int i = 0; i < kParts; ++i) {
    const auto bears = bearing(crawl, (i + 0.5) / kParts);
    EXPECT_GE(std::count(bears.begin(), bears.end(), true), 3);
    for (std::size_t leg = 0; leg < kLegs; ++leg)
      if (!bears[leg] && (order.empty() || order.back() != leg)) order.push_back(leg);
  }
  // Each front foot follows the rear foot of its side (R. B. McGhee, A. A. Frank, Math. Biosci. 3 (1968) 331).
  const auto next = [&](LegPlace place) {
    const auto at = std::find(order.begin(), order.end(), static_cast<std::size_t>(place));
    return static_cast<LegPlace>(at + 1 == order.end() ? order.front() : *(at + 1));
  };
  EXPECT_EQ(next(LegPlace::kRearLeft), LegPlace::kFrontLeft);
  EXPECT_EQ(next(LegPlace::kRearRight), LegPlace::kFrontRight);
}

TEST(Gait, TheSwingGrowsFromZeroToOne) {
  const Gait& trot = kGaits[gait_named("trot")];
  EXPECT_EQ(trot.swung(1, 0.25), 0);
  EXPECT_NEAR(trot.swung(1, 0.5), 0, 1e-12);
  EXPECT_NEAR(trot.swung(1, 0.75), 0.5, 1e-12);
  EXPECT_NEAR(trot.swung(0, 0.25), 0.5, 1e-12);
}

TEST(Gait, AFootBearsUntilItsNextSwing) {
  const Gait gait{.name = {}, .period = 0.4, .duty = 0.75, .phase = {0, 0.5}, .lift = 0};
  EXPECT_NEAR(gait.bears_for(0, 0.25), 0.2, 1e-12);
  EXPECT_NEAR(gait.bears_for(1, 0), 0.1, 1e-12);
  EXPECT_EQ(gait.bears_for(0, 0.75), 0) << "it swings";
  EXPECT_NEAR(gait.bears_for(0, 0.875), 0.35, 1e-12) << "it has landed early";
}

TEST(Gait, StanceAndSwingShareThePeriodByTheDuty) {
  const Gait gait{.name = {}, .period = 0.4, .duty = 0.75, .phase = {}, .lift = 0};
  EXPECT_NEAR(gait.stance_time(), 0.3, 1e-12);
  EXPECT_NEAR(gait.swing_time(), 0.1, 1e-12);
}

TEST(Gait, TimesGrowWithTheRootOfTheLegAndLengthsWithTheLeg) {
  const Gait& trot = kGaits[gait_named("trot")];
  const Gait larger = trot.scaled(4 * 0.426);
  EXPECT_NEAR(larger.period, 2 * trot.period, 1e-12);
  EXPECT_NEAR(larger.lift, 4 * trot.lift, 1e-12);
  EXPECT_EQ(larger.duty, trot.duty);
}

}  // namespace robot_control::tests

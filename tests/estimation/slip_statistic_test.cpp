// The statistic that proves slip: E is a straight line without slip, and the levels are those of floor and robot.

#include "estimation/slip_fixture.h"
#include "support/constants.h"

namespace robot_control {
namespace {

constexpr double kShortest = SlipStatistic::kSpans[0];
constexpr double kNext = SlipStatistic::kSpans[1];

class SlipLine : public testing::TestWithParam<double> {};

// Accelerating, braking and turning, from any speed on: E's slope is that speed, and W is constant. What is left are
// the steps of 5 ms, of third order.
TEST_P(SlipLine, IsStraightWithoutSlip) {
  SlidingBody body;
  body.speed = GetParam();
  for (int i = 0; i < 1000; ++i) {
    body.step(i < 200 ? 1.0 : i < 400 ? -0.5 : 0, 0, i < 300 ? 0.5 : i < 600 ? -0.5 : 0);
    const SlipStatistic::Point& now = body.statistic.now();
    ASSERT_NEAR(now.e.x, GetParam() * now.time, 1e-4) << now.time;
    ASSERT_NEAR(now.e.y, 0, 1e-4) << now.time;
    ASSERT_NEAR(now.w, 0, 1e-12) << now.time;
  }
}

INSTANTIATE_TEST_SUITE_P(Speeds, SlipLine, testing::Values(0.0, 0.5, -1.0, 4.0));

// The IMU swings about the middle of the wheels: its lever is taken off.
TEST(SlipLineOfAFarImu, IsStraightWithoutSlip) {
  SlidingBody body({.ahead = 0.4, .aside = -0.2});
  for (int i = 0; i < 1000; ++i) {
    body.step(i < 100 ? 1.0 : 0, 0, i < 200 ? 1.0 : i < 400 ? -1.0 : 0);
    const Planar& e = body.statistic.now().e;
    ASSERT_NEAR(e.x, 0.4, 2e-3) << i;  // constant
    ASSERT_NEAR(e.y, -0.2, 2e-3) << i;
  }
}

class SlipOfAFarImu : public SlipFixture {
 protected:
  SlipOfAFarImu() : SlipFixture({.ahead = 0.4, .aside = -0.2}) {}
};

// E continues the line of rest: the lever of the IMU is none of its steps.
TEST_F(SlipOfAFarImu, BehindARestTheLeverIsNoSlip) {
  EXPECT_EQ(drive(2, 0.3), 0);
}

class SlipStatisticTest : public SlipFixture {
 protected:
  SlipStatisticTest() { learn(); }
};

// 0.5 m/s beyond the ground are 12 mm within half of the shortest span.
TEST_F(SlipStatisticTest, ASpinOfBothWheelsIsProvenWithinTheNextSpan) {
  body_.left = body_.right = 0.5;
  EXPECT_LE(time_to_proof(SlipStatistic::kAlong, 1), kNext);
}

TEST_F(SlipStatisticTest, LockedWheelsOfARobotThatSlidesOnAreProvenWithinTheNextSpan) {
  body_.left = body_.right = -body_.speed;
  EXPECT_LE(time_to_proof(SlipStatistic::kAlong, 1), kNext);
}

TEST_F(SlipStatisticTest, ASpinOfOneWheelIsProvenByTheGyro) {
  body_.left = 0.3;
  EXPECT_LE(time_to_proof(SlipStatistic::kTurn, 1), kNext);
}

// Pushed with 1 m/s²: 0.1 m in the next but one span.
TEST_F(SlipStatisticTest, SlidingSidewaysIsProven) {
  EXPECT_LE(time_to_proof(SlipStatistic::kAcross, 2, 0, 1.0), SlipStatistic::kSpans[2]);
}

TEST_F(SlipStatisticTest, TheShortestSpanThatProvesItIsPublished) {
  body_.left = body_.right = 0.5;
  time_to_proof(SlipStatistic::kAlong, 1);
  EXPECT_GE(body_.statistic.span(SlipStatistic::kAlong), 0.8 * kShortest);
  EXPECT_LE(body_.statistic.span(SlipStatistic::kAlong), 1.6 * kNext);
}

// Wheels at 20 Hz: two readings in the shortest span.
TEST_F(SlipStatisticTest, SlowWheelsProveItAsWell) {
  body_.gap = 10;
  drive(10);
  body_.left = body_.right = 0.5;
  EXPECT_LE(time_to_proof(SlipStatistic::kAlong, 1), 2 * kNext);
}

// One reading at 0.5 m/s that comes 5 ms late: as large in every span.
TEST_F(SlipStatisticTest, ALateReadingIsNoSlip) {
  body_.left = body_.right = -0.5;
  double proven = drive(SlidingBody::kStep);
  body_.left = body_.right = 0.5;
  proven += drive(SlidingBody::kStep);
  body_.left = body_.right = 0;
  EXPECT_EQ(proven + drive(2), 0);
}

// A tilt that is wrong by e accelerates it by g e, which D shows.
TEST_F(SlipStatisticTest, TheAccelerometersSlowErrorIsThePull) {
  body_.error = 0.03;
  drive(5);
  double sum = 0;
  int count = 0;
  for (int i = 0; i < 4000; ++i) {
    if (!body_.step()) continue;
    judge(true);
    if (!body_.statistic.pull().known) continue;
    sum += body_.statistic.pull().along;
    ++count;
  }
  ASSERT_GT(count, 20);
  EXPECT_NEAR(sum / count, 0.03, 0.01);
}

TEST_F(SlipStatisticTest, SensorsOfTheDataSheetAreCalm) {
  EXPECT_TRUE(body_.statistic.calm());
  EXPECT_GE(body_.statistic.level(), 1);
  EXPECT_LT(body_.statistic.white(), 3 * SlipStatisticParams{}.accelerometer);
}

// Vibration that grows with the speed: levels that were learned at 0.5 m/s hold at four times that speed.
TEST_F(SlipFixture, FasterDrivingThanUsualShakesMore) {
  body_.noise = 30 * SlipStatisticParams{}.accelerometer;
  drive(0.5, 1.0);
  drive(60);
  const double before = body_.statistic.white();
  drive(1.5, 1.0);
  body_.noise *= 4;
  EXPECT_EQ(drive(0.8), 0);
  EXPECT_GT(body_.statistic.white(), 3 * before);
}

TEST_F(SlipStatisticTest, WhatWasNoSlipRaisesTheLevels) {
  const double before = body_.statistic.level();
  body_.left = body_.right = 0.5;
  ASSERT_LT(time_to_proof(SlipStatistic::kAlong, 1), 1);
  body_.statistic.learn_false();
  EXPECT_GT(body_.statistic.level(), 2 * before);
}

TEST_F(SlipStatisticTest, ARestartProvesNothing) {
  body_.left = body_.right = 0.5;
  time_to_proof(SlipStatistic::kAlong, 1);
  body_.statistic.restart();
  EXPECT_FALSE(any_proven());
  EXPECT_TRUE(body_.statistic.empty());
}

// Before anything is learned it shakes as real floors do.
TEST_F(SlipFixture, BeginsPessimistic) {
  EXPECT_EQ(body_.statistic.level(), 0);
  EXPECT_FALSE(body_.statistic.calm());
  EXPECT_GT(body_.statistic.white(), 30 * SlipStatisticParams{}.accelerometer);
}

/// Times the data sheet.
class SlipNoise : public SlipFixture, public testing::WithParamInterface<double> {
 protected:
  SlipNoise() { body_.noise = GetParam() * SlipStatisticParams{}.accelerometer; }
};

// 20 minutes, the pessimistic start included; at most a point or two.
TEST_P(SlipNoise, OfTheAccelerometerIsNoSlip) {
  double proven = drive(0.5, 1.0);
  proven += drive(1200);
  EXPECT_LE(proven, 1e-4 * 1200);
}

INSTANTIATE_TEST_SUITE_P(Factors, SlipNoise, testing::Values(1.0, 3.0, 10.0, 30.0, 100.0));

// Where it shakes: a tenth of the differences exceeds the 90 % quantile. The steps of the level scatter it.
TEST_F(SlipFixture, TheLevelIsTheQuantileOfTheResiduals) {
  body_.noise = 100 * SlipStatisticParams{}.accelerometer;
  drive(0.5, 1.0);
  drive(60);
  EXPECT_GT(body_.statistic.level(), 5);
  EXPECT_FALSE(body_.statistic.calm());
  int beyond = 0;
  int count = 0;
  for (int i = 0; i < 200000; ++i) {
    if (!body_.step()) continue;
    judge(true);
    ++count;
    beyond += body_.statistic.nis(SlipStatistic::kAlong) > 1.645 * 1.645 ? 1 : 0;
  }
  EXPECT_NEAR(beyond / static_cast<double>(count), 0.1, 0.04);
}

// Anything finite.
TEST(SlipStatistic, GarbageLeavesItFinite) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    std::mt19937 random(seed);
    const double garbage[] = {0, 1, -1, 1e-300, 1e3, -1e3, 1e6, 9.8};
    const auto pick = [&] { return garbage[random() % std::size(garbage)]; };
    SlipStatistic statistic{SlipStatisticParams{}};
    statistic.restart();
    for (int i = 0; i < 20000; ++i) {
      if (random() % 500 == 0) statistic.restart_on({pick(), pick()});
      if (random() % 500 == 0) statistic.stand(pick(), {0.1, 0, 0.99});
      if (random() % 500 == 0) statistic.learn_false();
      const SlipStatistic::Sample sample{.dt = random() % 2 == 0 ? 0.005 : 0.2,
                                         .acceleration = {pick(), pick()},
                                         .up = {0.1, 0, 0.99},
                                         .turned = pick(),
                                         .yaw = pick(),
                                         .way = {pick(), pick()},
                                         .across = pick(),
                                         .path = std::abs(pick()),
                                         .read = random() % 2 == 0,
                                         .rate = pick()};
      if (statistic.step(sample)) statistic.judge({.acceleration = {1e-3, 1e-3}}, random() % 2 == 0);
      for (const auto channel : {SlipStatistic::kAlong, SlipStatistic::kAcross, SlipStatistic::kTurn}) {
        ASSERT_TRUE(std::isfinite(statistic.nis(channel))) << seed << ' ' << i;
        ASSERT_TRUE(std::isfinite(statistic.slope_deviation(channel))) << seed << ' ' << i;
        ASSERT_TRUE(std::isfinite(statistic.span(channel))) << seed << ' ' << i;
      }
      ASSERT_TRUE(std::isfinite(statistic.now().e.x) && std::isfinite(statistic.level())) << seed << ' ' << i;
      ASSERT_TRUE(std::isfinite(statistic.pull().along) && std::isfinite(statistic.pull().variance));
      ASSERT_TRUE(std::isfinite(statistic.white()) && std::isfinite(statistic.slow(1e-4)));
    }
  }
}

}  // namespace
}  // namespace robot_control

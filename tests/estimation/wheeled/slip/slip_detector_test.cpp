// Tests the detector of slip: E is a straight line without slip, and the levels follow floor and robot.

#include "estimation/wheeled/slip/slip_fixture.h"
#include "support/constants.h"

namespace robot_control::tests {

constexpr double kMinSpan = Tuning::kResidualSpans[0];
constexpr double kNext = Tuning::kResidualSpans[1];

class SlipLine : public testing::TestWithParam<double> {};

// The robot accelerates, brakes and turns from any speed: E's slope is that speed, and W is constant. The rest comes
// from the steps of 5 ms, of third order.
TEST_P(SlipLine, IsStraightWithoutSlip) {
  SlidingBody body;
  body.speed = GetParam();
  for (int i = 0; i < 1000; ++i) {
    body.step(i < 200 ? 1.0 : i < 400 ? -0.5 : 0, 0, i < 300 ? 0.5 : i < 600 ? -0.5 : 0);
    const MotionDifference::Point& now = body.detector.difference().last();
    ASSERT_NEAR(now.path_difference.x, GetParam() * now.time, 1e-4) << now.time;
    ASSERT_NEAR(now.path_difference.y, 0, 1e-4) << now.time;
    ASSERT_NEAR(now.turn_difference, 0, 1e-12) << now.time;
  }
}

INSTANTIATE_TEST_SUITE_P(Speeds, SlipLine, testing::Values(0.0, 0.5, -1.0, 4.0));

// The IMU swings about the middle of the wheels: its lever is compensated.
TEST(SlipLineOfAFarImu, IsStraightWithoutSlip) {
  SlidingBody body({.imu_x = 0.4, .imu_y = -0.2});
  for (int i = 0; i < 1000; ++i) {
    body.step(i < 100 ? 1.0 : 0, 0, i < 200 ? 1.0 : i < 400 ? -1.0 : 0);
    const Planar& e = body.detector.difference().last().path_difference;
    ASSERT_NEAR(e.x, 0.4, 2e-3) << i;  // constant
    ASSERT_NEAR(e.y, -0.2, 2e-3) << i;
  }
}

/// Steps by which the wheels' stamps are late; negative values: early.
struct SlipOfOtherClocks : SlipFixture, testing::WithParamInterface<int> {
  SlipOfOtherClocks() {
    body_.late = GetParam();
    body_.detector.set_clock_offset(GetParam() * SlidingBody::kStep);
  }
  /// Duration of proven slip, s, in 30 starts and stops with turns.
  double start_and_stop() {
    double proven = 0;
    for (int i = 0; i < 30; ++i) {
      proven += drive(0.5, 1.0, 0, 0.5) + drive(1) + drive(0.5, -1.0, 0, -0.5) + drive(1);
    }
    return proven;
  }
  /// m: what the cubics between points leave where an acceleration begins.
  static constexpr double kCubics = 2e-4;
};

// Both motions are compared at the same moment. At the same stamp E would leave its line by up to τ Δv: 0.17 m.
TEST_P(SlipOfOtherClocks, TheLineIsStraight) {
  body_.noise = 0;
  for (int i = 0; i < 1000; ++i) {
    body_.step(i < 200 ? 1.0 : i < 400 ? -0.5 : 0, 0, i < 300 ? 0.5 : i < 600 ? -0.5 : 0);
    const MotionDifference::Point now = body_.detector.difference().last();
    ASSERT_NEAR(now.path_difference.x, 0, kCubics) << now.time;
    ASSERT_NEAR(now.path_difference.y, 0, kCubics) << now.time;
    ASSERT_NEAR(now.turn_difference, 0, kCubics) << now.time;
  }
}

TEST_P(SlipOfOtherClocks, AnAccelerationIsNoSlip) {
  EXPECT_EQ(start_and_stop(), 0);
}

// Earlier points are compared by the present offset.
TEST_P(SlipOfOtherClocks, AnOffsetThatIsLearnedIsNoSlip) {
  body_.detector.set_clock_offset(0);
  drive(0.5, 1.0);
  drive(20);
  body_.detector.set_clock_offset(GetParam() * SlidingBody::kStep);
  EXPECT_EQ(drive(5), 0);
}

// A slide ends while the robot brakes: earlier samples of the IMU are compared with later ones of the wheels.
TEST_P(SlipOfOtherClocks, TheLineIsStraightBehindASlide) {
  body_.noise = 0;
  drive(1, 1.0);
  for (int i = 0; i < 60; ++i) body_.step(-1.0);
  const MotionDifference::Point end = body_.detector.difference().last();
  body_.detector.restart_on_line({0.1, 0});
  for (int i = 0; i < 100; ++i) {
    body_.step(-1.0);
    const MotionDifference::Point now = body_.detector.difference().last();
    ASSERT_NEAR(now.path_difference.x - end.path_difference.x, 0, kCubics) << now.time;
    ASSERT_NEAR(now.path_difference.y - end.path_difference.y, 0, kCubics) << now.time;
    const MotionDifference::Point past = body_.detector.difference().before(end.time - 0.3);
    ASSERT_NEAR(past.path_difference.x - end.path_difference.x, 0.1 * (past.time - end.time), kCubics);
  }
}

// The wheels' slip is known with their readings, and compared with those of the IMU.
TEST_P(SlipOfOtherClocks, ASpinIsProvenWithinTheNextSpan) {
  learn();
  body_.left = body_.right = 0.5;
  const double later = std::abs(GetParam()) * SlidingBody::kStep;
  EXPECT_LE(time_to_proof(SlipResidual::kAlong, 1), kNext + later);
}

INSTANTIATE_TEST_SUITE_P(Steps, SlipOfOtherClocks, testing::Values(-20, -7, -1, 0, 3, 14, 34));

struct SlipOfAFarImu : SlipFixture {
  SlipOfAFarImu() : SlipFixture({.imu_x = 0.4, .imu_y = -0.2}) {}
};

// E continues the line of rest: the lever of the IMU does not step it.
TEST_F(SlipOfAFarImu, TheLeverIsNoSlipBehindARest) {
  EXPECT_EQ(drive(2, 0.3), 0);
}

struct SlipDetectorTest : SlipFixture {
  SlipDetectorTest() { learn(); }
};

// 0.5 m/s beyond the ground are 12 mm within half of the shortest span.
TEST_F(SlipDetectorTest, ASpinOfBothWheelsIsProvenWithinTheNextSpan) {
  body_.left = body_.right = 0.5;
  EXPECT_LE(time_to_proof(SlipResidual::kAlong, 1), kNext);
}

TEST_F(SlipDetectorTest, LockedWheelsOfARobotThatSlidesOnAreProvenWithinTheNextSpan) {
  body_.left = body_.right = -body_.speed;
  EXPECT_LE(time_to_proof(SlipResidual::kAlong, 1), kNext);
}

TEST_F(SlipDetectorTest, ASpinOfOneWheelIsProvenByTheGyro) {
  body_.left = 0.3;
  EXPECT_LE(time_to_proof(SlipResidual::kTurn, 1), kNext);
}

// The push is 1 m/s²: 0.1 m in the next but one span.
TEST_F(SlipDetectorTest, SlidingSidewaysIsProven) {
  EXPECT_LE(time_to_proof(SlipResidual::kAcross, 2, 0, 1.0), Tuning::kResidualSpans[2]);
}

TEST_F(SlipDetectorTest, TheShortestSpanProvesIt) {
  body_.left = body_.right = 0.5;
  time_to_proof(SlipResidual::kAlong, 1);
  EXPECT_GE(body_.detector.shortest_proven_span(), 0.8 * kMinSpan);
  EXPECT_LE(body_.detector.shortest_proven_span(), 1.6 * kNext);
}

// The wheels come at 20 Hz: two readings in the shortest span.
TEST_F(SlipDetectorTest, SlowWheelsProveItAsWell) {
  body_.gap = 10;
  drive(10);
  body_.left = body_.right = 0.5;
  EXPECT_LE(time_to_proof(SlipResidual::kAlong, 1), 2 * kNext);
}

// One reading at 0.5 m/s comes 5 ms late: it is as large in every span.
TEST_F(SlipDetectorTest, ALateReadingIsNoSlip) {
  body_.left = body_.right = -0.5;
  double proven = drive(SlidingBody::kStep);
  body_.left = body_.right = 0.5;
  proven += drive(SlidingBody::kStep);
  body_.left = body_.right = 0;
  EXPECT_EQ(proven + drive(2), 0);
}

// The drives of both sides send by clocks of their own, and for seconds never in the same cycle.
TEST_F(SlipDetectorTest, PointsThatAreMissingInterruptIt) {
  EXPECT_FALSE(body_.detector.difference().interrupted());
  body_.gap = 1'000'000;
  drive(Tuning::kResidualSpans[1]);
  EXPECT_FALSE(body_.detector.difference().interrupted());
  drive(2 * SlidingBody::kStep);
  EXPECT_TRUE(body_.detector.difference().interrupted());
  body_.detector.restart();
  EXPECT_FALSE(body_.detector.difference().interrupted());
}

// A tilt with the error e accelerates it by g e, which D shows.
TEST_F(SlipDetectorTest, TheAccelerometersSlowErrorIsTheGravityError) {
  body_.error = 0.03;
  drive(5);
  double sum = 0;
  int count = 0;
  for (int i = 0; i < 4000; ++i) {
    if (!body_.step()) continue;
    evaluate(true);
    if (!body_.detector.gravity_error().known) continue;
    sum += body_.detector.gravity_error().along;
    ++count;
  }
  ASSERT_GT(count, 20);
  EXPECT_NEAR(sum / count, 0.03, 0.01);
}

TEST_F(SlipDetectorTest, SensorsOfTheDataSheetAreAsSpecified) {
  EXPECT_GE(body_.detector.level(), 1);
  EXPECT_LT(body_.detector.acceleration_noise().white, 3 * SlipParams{}.accelerometer);
}

// Vibration that grows with the speed: levels that were learned at 0.5 m/s hold at four times that speed.
TEST_F(SlipFixture, FasterDrivingThanUsualShakesMore) {
  body_.noise = 30 * SlipParams{}.accelerometer;
  drive(0.5, 1.0);
  drive(60);
  const double before = body_.detector.acceleration_noise().white;
  drive(1.5, 1.0);
  body_.noise *= 4;
  EXPECT_EQ(drive(0.8), 0);
  EXPECT_GT(body_.detector.acceleration_noise().white, 3 * before);
}

TEST_F(SlipDetectorTest, ARestartProvesNothing) {
  body_.left = body_.right = 0.5;
  time_to_proof(SlipResidual::kAlong, 1);
  body_.detector.restart();
  EXPECT_FALSE(any_proven());
  EXPECT_TRUE(body_.detector.difference().empty());
}

// Before anything is learned the levels are those of real floors.
TEST_F(SlipFixture, BeginsPessimistic) {
  EXPECT_EQ(body_.detector.level(), 0);
  EXPECT_DOUBLE_EQ(body_.detector.acceleration_noise().white, Tuning::kFirstLevel * SlipParams{}.accelerometer);
}

/// Factor on the noise of the data sheet.
struct SlipNoise : SlipFixture, testing::WithParamInterface<double> {
  SlipNoise() { body_.noise = GetParam() * SlipParams{}.accelerometer; }
};

// A level that is low by chance would prove slip once in two hours at the largest factor.
TEST_P(SlipNoise, IsNoSlip) {
  double proven = drive(0.5, 1.0);
  proven += drive(7200);
  EXPECT_EQ(proven, 0);
}

INSTANTIATE_TEST_SUITE_P(Factors, SlipNoise, testing::Values(1.0, 3.0, 10.0, 30.0, 100.0));

// On a shaking floor a twentieth of the differences exceeds the 90 % quantile: the larger of two levels is in use.
TEST_F(SlipFixture, TheLevelIsTheQuantileOfTheResiduals) {
  body_.noise = 100 * SlipParams{}.accelerometer;
  drive(0.5, 1.0);
  drive(60);
  EXPECT_GT(body_.detector.level(), 5);
  int beyond = 0;
  int count = 0;
  for (int i = 0; i < 200000; ++i) {
    if (!body_.step()) continue;
    evaluate(true);
    ++count;
    beyond += body_.detector.nis(SlipResidual::kAlong) > 1.645 * 1.645 ? 1 : 0;
  }
  EXPECT_NEAR(beyond / static_cast<double>(count), 0.05, 0.02);
}

// The input is anything finite.
TEST(SlipDetector, GarbageLeavesItFinite) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    std::mt19937 random(seed);
    const double garbage[] = {0, 1, -1, 1e-300, 1e3, -1e3, 1e6, 9.8};
    const auto pick = [&] { return garbage[random() % std::size(garbage)]; };
    SlipDetector detector{SlipParams{}};
    for (int i = 0; i < 20000; ++i) {
      if (random() % 500 == 0) detector.restart_on_line({pick(), pick()});
      if (random() % 500 == 0) detector.restart_at_rest(pick(), {0.1, 0, 0.99}, {pick(), pick()});
      const MotionDifference::Sample sample{.dt = random() % 2 == 0 ? 0.005 : 0.2,
                                            .acceleration = {pick(), pick()},
                                            .up = {0.1, 0, 0.99},
                                            .turned = pick(),
                                            .yaw = pick(),
                                            .path = {pick(), pick()},
                                            .right_minus_left = pick(),
                                            .distance = std::abs(pick()),
                                            .both_sides_read = random() % 2 == 0,
                                            .yaw_rate = pick()};
      if (detector.step(sample)) detector.evaluate({.acceleration_variance = {1e-3, 1e-3}}, random() % 2 == 0);
      for (const auto channel : SlipResidual::kEach) {
        ASSERT_TRUE(std::isfinite(detector.nis(channel))) << seed << ' ' << i;
        ASSERT_TRUE(std::isfinite(detector.slope_deviation(channel))) << seed << ' ' << i;
      }
      ASSERT_TRUE(std::isfinite(detector.shortest_proven_span())) << seed << ' ' << i;
      const MotionDifference& difference = detector.difference();
      ASSERT_TRUE(difference.empty() || std::isfinite(difference.last().path_difference.x)) << seed << ' ' << i;
      ASSERT_TRUE(std::isfinite(detector.level())) << seed << ' ' << i;
      ASSERT_TRUE(std::isfinite(detector.gravity_error().along) && std::isfinite(detector.gravity_error().deviation));
      ASSERT_TRUE(std::isfinite(detector.acceleration_noise().white) &&
                  std::isfinite(detector.acceleration_noise().slow));
    }
  }
}

}  // namespace robot_control::tests

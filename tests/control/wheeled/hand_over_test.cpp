/// Checks the hand-over from the brake to the wheel loops and back, on a slope.

#include <gtest/gtest.h>

#include <cmath>

#include "control/wheeled/control_bench.h"

namespace robot_control::tests {

constexpr double kSlope = 5 * std::numbers::pi / 180;
// m·g·sin(slope)·r/2 per wheel
const double kLoad = 0.5 * 12 * 9.81 * std::sin(kSlope) * 0.1;

struct HandOver : testing::Test {
  void SetUp() override { bench.plant.slope = kSlope; }

  /// m, lowest position while it drives up at 5 mm/s, too slowly for feed-forward to hide the hand-over.
  double lowest_while_creeping() {
    bench.send(0.005, 0);
    double lowest = 0;
    for (int k = 0; k < 500; ++k) {
      bench.step();
      lowest = std::fmin(lowest, bench.plant.distance);
    }
    return lowest;
  }

  ControlBench bench{make_test_robot(), straight_ramps()};
};

TEST_F(HandOver, BeginsWithTheTorqueThatTheBrakeWasHolding) {
  bench.run(0.4);
  ASSERT_TRUE(bench.command.reasons & kReasonHolding);
  bench.send(0.5, 0);
  bench.step();
  EXPECT_FALSE(bench.command.reasons & kReasonHolding);
  for (const JointCommand& joint : {bench.command.joints[0], bench.command.joints[1]}) {
    EXPECT_EQ(joint.mode, JointMode::kEffort);
    EXPECT_NEAR(joint.effort, kLoad, 0.01 * kLoad) << "a mean, whose first sample was 0";
  }
}

TEST_F(HandOver, TakesNoTremblingOfTheBrakeForALoad) {
  // The body swings as after a hard stop: ±8 mm/s at 6 Hz, held by springs of the brake.
  for (int phase = 0; phase < 160; phase += 20) {
    ControlBench level{make_test_robot(), straight_ramps()};
    level.spoil = [&](SensorFrame& sensors) {
      const double angle = 2 * std::numbers::pi * 6 * 1e-3 * static_cast<double>(level.cycle);
      for (std::size_t i = 0; i < 2; ++i) {
        sensors.joints[i].position = 0.0021 * std::sin(angle);
        sensors.joints[i].effort = -0.2 * std::sin(angle);
      }
    };
    level.permit.action = PermitAction::kBrake;
    level.run(0.4 + 1e-3 * phase);
    level.permit.action = PermitAction::kDrive;
    level.send(0.1, 0);
    level.step();
    EXPECT_EQ(level.command.joints[0].mode, JointMode::kEffort);
    EXPECT_LT(std::abs(level.command.joints[0].effort), 0.1) << phase;
  }
}

TEST_F(HandOver, DoesNotSagOnTheSlope) {
  bench.run(0.4);
  EXPECT_GT(lowest_while_creeping(), -1e-7);
  EXPECT_NEAR(bench.plant.distance, 0.005 * 0.5, 1e-4);
}

TEST_F(HandOver, HoldsThoughAnEncoderJumpsWhileNobodyAsksForAMotion) {
  bench.run(0.4);
  ASSERT_TRUE(bench.command.reasons & kReasonHolding);
  double jump = 0;
  bench.spoil = [&jump](SensorFrame& sensors) { sensors.joints[0].position += jump; };
  jump = 0.3;  // rad, slower than kFastestWheel
  for (int k = 0; k < 100; ++k) {
    bench.step();
    EXPECT_TRUE(bench.command.reasons & kReasonHolding) << k;
  }
}

TEST_F(HandOver, BeginsAtRestThoughTheLastCountFlickers) {
  constexpr double kCount = 2 * std::numbers::pi / 4096;
  bench.spoil = [&](SensorFrame& sensors) {
    sensors.joints[0].position += bench.cycle / 3 % 2 == 0 ? 0 : kCount;
    sensors.joints[1].position -= bench.cycle / 5 % 2 == 0 ? 0 : kCount;
  };
  for (int k = 0; k < 20; ++k) {  // one begins in each phase of the counts
    bench.send(0, 0);
    bench.run(0.4 + 1e-3 * k);
    ASSERT_TRUE(bench.command.reasons & kReasonHolding);
    bench.send(0.5, 0.2);
    bench.step();
    EXPECT_EQ(bench.command.twist_limited.linear[0], 0) << k;
    EXPECT_EQ(bench.command.twist_limited.angular[2], 0) << k;
    bench.run(0.01);
    EXPECT_LT(bench.command.twist_limited.linear[0], 0.0101) << "1 m/s² from zero";
    bench.send(0, 0);
    bench.run(1);
  }
}

TEST_F(HandOver, SagsWithoutTheLoadInTheIntegrator) {
  // This shows that the test above can fail, with a driver that reports no effort.
  bench.spoil = [](SensorFrame& sensors) {
    for (JointSample& joint : sensors.joints) joint.effort = 0;
  };
  bench.run(0.4);
  EXPECT_LT(lowest_while_creeping(), -1e-4);
}

TEST_F(HandOver, MovesLessThanAMillimetreFromStandstillToHolding) {
  bench.plant.counts = 4096;
  bench.plant.viscous_friction = 0.02;
  bench.run(0.4);
  bench.send(0.5, 0);
  bench.run(1.0);
  bench.send(0, 0);
  while (bench.plant.twist.linear > 2e-3) bench.step();
  const double standstill = bench.plant.distance;
  double largest = 0;
  for (int k = 0; k < 3000; ++k) {
    bench.step();
    largest = std::fmax(largest, std::abs(bench.plant.distance - standstill));
  }
  EXPECT_LT(largest, 1e-3);
  EXPECT_TRUE(bench.command.reasons & kReasonHolding);
}

TEST_F(HandOver, StaysOnTheBrakeWhenReleasedWithoutAWish) {
  bench.permit.action = PermitAction::kBrake;
  bench.run(0.5);
  bench.permit.action = PermitAction::kDrive;
  for (int k = 0; k < 100; ++k) {
    bench.step();
    ASSERT_EQ(bench.command.joints[0].mode, JointMode::kBrake);
    ASSERT_TRUE(bench.command.reasons & kReasonHolding);
  }
}

TEST_F(HandOver, ContinuesFromTheMeasuredSpeedAfterAShortBrake) {
  bench.plant.slope = 0;
  bench.run(0.4);
  bench.send(1, 0);
  bench.run(1.2);
  bench.permit.action = PermitAction::kBrake;
  bench.run(0.1);
  bench.send(1, 0);
  bench.permit.action = PermitAction::kDrive;
  bench.step();
  const double speed = bench.plant.twist.linear;
  ASSERT_GT(speed, 0.05);
  ASSERT_LT(speed, 0.9);
  // There is no jump. The plan starts at the measured speed, within the tracking loop's lag under hard braking. The
  // first torque is small, unlike the brake's.
  EXPECT_NEAR(bench.command.twist_limited.linear[0], speed, 0.1);
  EXPECT_LT(std::abs(bench.command.joints[0].effort), 0.1);
  double slowest = speed;
  for (int k = 0; k < 1200; ++k) {
    bench.step();
    slowest = std::fmin(slowest, bench.plant.twist.linear);
    ASSERT_LT(bench.plant.twist.linear, 1.01);
  }
  EXPECT_GT(slowest, speed - 0.1);
  EXPECT_NEAR(bench.plant.twist.linear, 1, 0.01);
}

}  // namespace robot_control::tests

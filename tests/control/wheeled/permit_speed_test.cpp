/// The permit limits the speed: no rim over the ground is faster, and a curve keeps its radius.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "control/wheeled/control_bench.h"

namespace robot_control::tests {

constexpr double kPermitRounding = 1e-14;  // a few operations on numbers of order one
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

double fastest_rim(const DriveKinematics& kinematics, const PlanarTwist& twist) {
  const SidePair rim = kinematics.rim_speeds(twist);
  return std::fmax(std::abs(rim.left), std::abs(rim.right));
}

// v + ω·b/2 = 0.5 + 2·0.25 = 1 m/s; powers of two are exact.
TEST(RimSpeedScale, IsTheLimitOverTheFastestRim) {
  const DriveKinematics kinematics(make_test_robot());
  EXPECT_EQ(kinematics.rim_speed_scale({0.5, 2}, 0.25), 0.25);
  EXPECT_EQ(kinematics.rim_speed_scale({-0.5, 2}, 0.25), 0.25);
  EXPECT_EQ(kinematics.rim_speed_scale({0.5, -2}, 0.25), 0.25);
  EXPECT_EQ(kinematics.rim_speed_scale({-0.5, -2}, 0.25), 0.25);
}

TEST(RimSpeedScale, LeavesAloneWhatIsSlowEnough) {
  const DriveKinematics kinematics(make_test_robot());
  EXPECT_EQ(kinematics.rim_speed_scale({0.5, 2}, 1), 1);
  EXPECT_EQ(kinematics.rim_speed_scale({0, 0}, 0), 1);
}

TEST(RimSpeedScale, WheelsBehindEachOtherCountWithTheirEffectiveWheelBase) {
  EXPECT_NEAR(DriveKinematics(make_skid_steer()).rim_speed_scale({0, 1}, 0.205), 0.5, kPermitRounding);  // 0.41 m/s
}

TEST(RimSpeedScale, ALimitThatIsNoSpeedLetsNothingMove) {
  const DriveKinematics kinematics(make_test_robot());
  for (const double limit : {0.0, -1.0, kNaN, -std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(kinematics.rim_speed_scale({0.5, 2}, limit), 0) << limit;
    EXPECT_EQ(kinematics.rim_speed_scale({0, 0}, limit), 1) << limit;
  }
}

TEST(RimSpeedScale, NoRimOfAnyRobotExceedsIt) {
  for (const DriveTrain& robot : {make_test_robot(), make_skid_steer()}) {
    const DriveKinematics kinematics(robot);
    for (unsigned seed = 0; seed < 1000; ++seed) {
      std::mt19937 random(seed);
      std::uniform_real_distribution<double> any(-4, 4);
      const PlanarTwist twist{any(random), any(random)};
      const double limit = std::abs(any(random));
      const double scale = kinematics.rim_speed_scale(twist, limit);
      ASSERT_LE(fastest_rim(kinematics, {scale * twist.linear, scale * twist.angular}), limit + kPermitRounding)
          << "seed " << seed;
      if (scale < 1) {
        ASSERT_NEAR(scale * fastest_rim(kinematics, twist), limit, kPermitRounding) << "seed " << seed;
      }
    }
  }
}

/// The healthy case is a curve of 1 m radius at 0.8 m/s, its outer rim at 1 m/s, driven until it is steady.
struct PermitSpeed : testing::Test {
  PermitSpeed() {
    bench.send(0.8, 0.8);
    bench.run(1.2);
  }
  static DriveControllerParameters patient() {
    DriveControllerParameters parameters = straight_ramps();
    parameters.cmd_vel_timeout = 0;
    return parameters;
  }
  PlanarTwist limited() const {
    return {bench.command.twist_limited.linear[0], bench.command.twist_limited.angular[2]};
  }
  double rim() const { return fastest_rim(DriveKinematics(bench.robot), limited()); }
  bool slowed() const { return (bench.command.reasons & kReasonPermitSlow) != 0; }

  ControlBench bench{make_test_robot(), patient()};
};

TEST_F(PermitSpeed, DoesNothingWithoutALimit) {
  EXPECT_EQ(limited().linear, 0.8);
  EXPECT_FALSE(slowed());
}

TEST_F(PermitSpeed, DoesNothingAboveTheFastestRim) {
  bench.permit.speed_limit = 1.0 + kPermitRounding;
  bench.step();
  EXPECT_EQ(limited().linear, 0.8);
  EXPECT_FALSE(slowed());
}

// The outer rim is 1.25·v, slowed to 0.25 m/s: v = 0.2 m/s.
TEST_F(PermitSpeed, EndsAtTheLimitOnTheSameCurve) {
  bench.permit.speed_limit = 0.25;
  bench.run(1.0);
  EXPECT_NEAR(rim(), 0.25, kPermitRounding);
  EXPECT_NEAR(limited().linear, 0.2, kPermitRounding);
  EXPECT_NEAR(limited().angular / limited().linear, 1, kPermitRounding);
  EXPECT_TRUE(slowed());
  EXPECT_EQ(bench.command.requested.twist.linear[0], 0.8);
}

// 1 m/s² is the stricter of the two: 4 rad/s² on the curve would be 4 m/s².
TEST_F(PermitSpeed, SlowsDownAlongTheCurveAtTheAccelerationLimit) {
  bench.permit.speed_limit = 0.25;
  for (int k = 0; k < 600; ++k) {
    const double before = limited().linear;
    bench.step();
    ASSERT_LE(before - limited().linear, 1e-3 + kPermitRounding) << "cycle " << k;
    ASSERT_NEAR(limited().angular / limited().linear, 1, 1e-12) << "cycle " << k;  // 600 roundings
  }
  EXPECT_NEAR(limited().linear, 0.2, kPermitRounding);
}

TEST_F(PermitSpeed, LetsGoAgainAtTheAccelerationLimit) {
  bench.permit.speed_limit = 0.25;
  bench.run(1.0);
  bench.permit.speed_limit = kNoSpeedLimit;
  bench.step();
  EXPECT_NEAR(limited().linear, 0.201, kPermitRounding);
  EXPECT_FALSE(slowed());
  bench.run(1.0);
  EXPECT_EQ(limited().linear, 0.8);
}

TEST_F(PermitSpeed, ZeroRampsToAStandAndHolds) {
  for (const double nothing : {0.0, -1.0, kNaN}) {
    bench.permit.speed_limit = nothing;
    bench.run(2.0);
    EXPECT_EQ(limited().linear, 0) << nothing;
    EXPECT_TRUE(slowed()) << nothing;
    EXPECT_NE(bench.command.reasons & kReasonHolding, 0u) << nothing;
    EXPECT_NEAR(bench.plant.twist.linear, 0, 1e-3) << nothing;
  }
}

TEST_F(PermitSpeed, IsNoReasonWhereNothingIsAsked) {
  bench.send(0, 0);
  bench.permit.speed_limit = 0;
  bench.run(2.0);
  EXPECT_FALSE(slowed());
}

TEST_F(PermitSpeed, IsNoReasonUnderABrakeOrARamp) {
  bench.permit.speed_limit = 0;
  bench.permit.action = PermitAction::kRamp;
  bench.permit.ramp_until = bench.cycle + 10;
  bench.step();
  EXPECT_FALSE(slowed());
  bench.permit.action = PermitAction::kBrake;
  bench.step();
  EXPECT_FALSE(slowed());
}

}  // namespace robot_control::tests

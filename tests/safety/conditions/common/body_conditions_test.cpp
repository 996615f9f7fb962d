/// Tests conditions of the body at 1 kHz. The healthy case is a robot of 10 kg on two wheels of 0.1 m, 0.4 m apart,
/// with its IMU in the middle. It is upright and rolls straight at 0.5 m/s; the last bits of every sample differ.

#include "safety/conditions/common/body_conditions.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>

#include "machine/gravity.h"
#include "safety/conditions/wheeled/wheeled_observer.h"
#include "support/allocation_guard.h"
#include "support/constants.h"
#include "support/measured_contacts.h"

namespace robot_control::tests {

using Eigen::Vector3d;

Vector3 plain(const Vector3d& vector) {
  return {vector.x(), vector.y(), vector.z()};
}

struct BodyConditionsTest : testing::Test {
  BodyConditionsTest() {
    robot_.mass = 10;
    robot_.joints.resize(2);
    robot_.wheels.resize(2);
    robot_.contacts = {"left_wheel", "right_wheel"};
    for (std::size_t i = 0; i < 2; ++i) {
      robot_.wheels[i].joint = i;
      robot_.wheels[i].radius = 0.1;
      robot_.wheels[i].centre_base = {0, i == 0 ? 0.2 : -0.2, 0};
    }
    set_joints_valid(sensors_, kValidMotion);
    sensors_.valid = kValidGyro | kValidAccelerometer;
    sensors_.joint_count = 2;
    for (std::size_t i = 0; i < 2; ++i) sensors_.joints[i].velocity = 5;
    begin();
  }

  /// Restarts with the present parameters and robot; it is healthy for 10 cycles.
  void begin() {
    facts_ = made();
    steps(10);
  }

  /// Body and conditions with the present parameters and robot.
  struct Monitored {
    BodyMotion body;
    BodyConditions conditions;

    void enter_run() {
      body.enter_run();
      conditions.enter_run();
    }
  };
  Monitored made() const {
    return {.body = {robot_, middle_of_axles(robot_), kPeriod}, .conditions = {parameters_, robot_, kPeriod}};
  }

  void step() {
    jitter_ = -jitter_;
    sensors_.imu.angular_velocity = plain(rate_ + jitter_ * Vector3d::Ones());
    sensors_.imu.linear_acceleration = plain(force_ + jitter_ * Vector3d::Ones());
    check();
  }
  /// Checks the present frame.
  void check(std::uint64_t elapsed = 1) {
    out_.clear();
    facts_.body.step(sensors_, elapsed, RimSpeed(robot_).value(sensors_), wheels_turn_);
    const MonitorInput input{.sensors = &sensors_};
    facts_.conditions.step(BodyMeasurements{input, elapsed, static_cast<double>(elapsed) * kPeriod, facts_.body,
                                            facts_.body.attitude().vertical()},
                           out_);
  }
  void steps(int count) {
    for (int i = 0; i < count; ++i) step();
  }

  /// Cycles until this cause alone is active; −1: not within `limit`.
  int cycles_until(StopCause cause, int limit = 2000) {
    for (int i = 1; i <= limit; ++i) {
      step();
      if (out_.stopping() == 0 && out_.with(Reaction::kSlow) == 0) continue;
      EXPECT_EQ(out_.stopping() | out_.with(Reaction::kSlow), cause);
      return i;
    }
    return -1;
  }
  static int cycles(const Condition& condition) {
    return std::max(1, static_cast<int>(std::lround(condition.persistence / kPeriod)));
  }
  bool quiet() const { return out_.measurements().empty(); }

  /// Leans by `angle` about x from now on, like a robot that is set on a ramp.
  void lean(double angle) { force_ = kGravity * Vector3d(0, std::sin(angle), std::cos(angle)); }

  SafetyParameters parameters_;
  DriveTrain robot_;
  SensorFrame sensors_;
  Monitored facts_ = made();
  ActiveCauses out_;
  Vector3d rate_ = Vector3d::Zero();
  Vector3d force_{0, 0, kGravity};
  bool wheels_turn_ = true;
  double jitter_ = 1e-12;
};

TEST_F(BodyConditionsTest, FindNothingOnAHealthyRobot) {
  for (int i = 0; i < 5000; ++i) {
    step();
    ASSERT_TRUE(quiet());
  }
}

TEST_F(BodyConditionsTest, TiltIsFoundAfterItsPersistence) {
  lean(0.43);
  facts_.enter_run();  // the ramp is steep from the beginning
  EXPECT_EQ(cycles_until(kCauseTilt), cycles(parameters_.tilt));
  EXPECT_NEAR(out_.measurements()[0].value, 0.43, 1e-9);
  EXPECT_EQ(out_.measurements()[0].limit, 0.42);
}

TEST_F(BodyConditionsTest, ALeanBelowTheLimitIsNone) {
  lean(0.41);
  facts_.enter_run();
  EXPECT_EQ(cycles_until(kCauseTilt), -1);
}

// It tips at 1 rad/s, slower than the limit of tip_over: it reaches the limit after 0.42 s, and its persistence.
TEST_F(BodyConditionsTest, TiltIsFoundWhileItGrows) {
  int count = 0;
  for (double angle = 0; quiet() && count < 2000; ++count) {
    angle += kPeriod;
    lean(angle);
    rate_ = {1, 0, 0};
    step();
  }
  EXPECT_EQ(out_.stopping(), kCauseTilt);
  EXPECT_NEAR(count, 420 + cycles(parameters_.tilt), 1) << "rounding of the sum";
}

TEST_F(BodyConditionsTest, TippingOverIsFoundBeforeTheTiltIsReached) {
  int count = 0;
  for (double angle = 0; quiet() && count < 2000; ++count) {
    angle += 2 * kPeriod;
    lean(angle);
    rate_ = {2, 0, 0};
    step();
  }
  EXPECT_EQ(out_.stopping(), kCauseTipOver);
  EXPECT_NEAR(count, 0.21 / 2 / kPeriod + cycles(parameters_.tip_over), 2);
  EXPECT_NEAR(out_.measurements()[0].value, 2, 1e-6);
  EXPECT_LT(facts_.body.attitude().tilt(), 0.42);
}

TEST_F(BodyConditionsTest, RisingAgainIsNoTippingOver) {
  lean(0.3);
  facts_.enter_run();
  steps(1);
  rate_ = {-3, 0, 0};
  for (double angle = 0.3; angle > 0; angle -= 3 * kPeriod) {
    lean(angle);
    step();
    ASSERT_TRUE(quiet());
  }
}

TEST_F(BodyConditionsTest, AFastSwayNearTheVerticalIsNoTippingOver) {
  for (int i = 0; i < 1000; ++i) {  // 0.1 rad at 30 rad/s: 3 rad/s
    const double time = kPeriod * i;
    lean(0.1 * std::sin(30 * time));
    rate_ = {3 * std::cos(30 * time), 0, 0};
    step();
    ASSERT_TRUE(quiet());
  }
}

TEST_F(BodyConditionsTest, FreeFallIsFoundAfterItsPersistence) {
  force_ = {0, 0, 0.5};
  EXPECT_EQ(cycles_until(kCauseFreeFall), cycles(parameters_.free_fall));
  EXPECT_NEAR(out_.measurements()[0].value, 0.5, 1e-6);
}

TEST_F(BodyConditionsTest, AHopIsNoFreeFall) {
  force_ = {0, 0, 0.5};
  steps(cycles(parameters_.free_fall) - 1);
  EXPECT_TRUE(quiet());
  force_ = {0, 0, kGravity};
  step();
  force_ = {0, 0, 0.5};
  steps(cycles(parameters_.free_fall) - 1);
  EXPECT_TRUE(quiet());
}

// 0.25 m/s lost in every millisecond: 0.8 m/s, the limit times the window, are gone in the fourth.
TEST_F(BodyConditionsTest, AnImpactIsFoundAsSoonAsTheSpeedIsGone) {
  force_ = {-250, 0, kGravity};
  EXPECT_EQ(cycles_until(kCauseImpact), 4);
  EXPECT_NEAR(out_.measurements()[0].value, 100, 1e-6);
  EXPECT_EQ(out_.measurements()[0].limit, 80);
}

TEST_F(BodyConditionsTest, AnImpactMayComeFromAnySide) {
  for (const double angle : {0.7, 2.0, 4.0}) {
    force_ = {250 * std::cos(angle), 250 * std::sin(angle), kGravity};
    facts_.enter_run();
    EXPECT_EQ(cycles_until(kCauseImpact), 4);
    force_ = {0, 0, kGravity};
  }
}

TEST_F(BodyConditionsTest, AKnockIsNoImpact) {
  force_ = {-500, 0, kGravity};
  step();  // 0.5 m/s
  EXPECT_NEAR(facts_.body.shock(), 50, 1e-6);
  force_ = {0, 0, kGravity};
  for (int i = 0; i < 20; ++i) {
    EXPECT_TRUE(quiet());
    step();
  }
  EXPECT_NEAR(facts_.body.shock(), 0, 1e-9) << "the window is past";
}

TEST_F(BodyConditionsTest, ALandingIsNoImpact) {
  force_ = {0, 0, 300};
  steps(10);
  EXPECT_TRUE(quiet());
}

TEST_F(BodyConditionsTest, GravityOnARampIsNoPartOfAnImpact) {
  lean(0.35);
  facts_.enter_run();
  steps(100);
  EXPECT_NEAR(facts_.body.shock(), 0, 1e-6);
}

TEST_F(BodyConditionsTest, LiftIsFoundWhereContactsAreFelt) {
  measure_contacts(sensors_);
  sensors_.contacts[0].force = sensors_.contacts[1].force = {3, 0, 0.15 * 10 * kGravity};
  EXPECT_EQ(cycles_until(kCauseLift, 200), -1);
  sensors_.contacts[0].force = {3, 0, 0};
  EXPECT_EQ(cycles_until(kCauseLift), cycles(parameters_.lift));
  EXPECT_NEAR(out_.measurements()[0].value, 0.15, 1e-9);
}

TEST_F(BodyConditionsTest, WithoutContactSensorsThereIsNoLift) {
  EXPECT_EQ(cycles_until(kCauseLift), -1);
  EXPECT_EQ(facts_.body.carried(), 1);
}

TEST_F(BodyConditionsTest, CastersCarryToo) {
  robot_.contacts.push_back("caster");
  measure_contacts(sensors_);
  sensors_.contacts[2].force = {0, 0, 0.9 * 10 * kGravity};
  begin();
  EXPECT_EQ(cycles_until(kCauseLift, 200), -1);
}

// On a ramp of 0.3 rad the weight m g rests on the wheels, along the vertical.
TEST_F(BodyConditionsTest, WeightIsVertical) {
  lean(0.3);
  facts_.enter_run();
  measure_contacts(sensors_);
  sensors_.contacts[0].force = plain(10 * force_);
  step();
  EXPECT_NEAR(facts_.body.carried(), 1, 1e-9);
}

// The other device goes on.
TEST_F(BodyConditionsTest, AStuckDeviceIsFoundWhileTheWheelsTurn) {
  for (Vector3* stuck : {&sensors_.imu.angular_velocity, &sensors_.imu.linear_acceleration}) {
    begin();
    Vector3& other =
        stuck == &sensors_.imu.angular_velocity ? sensors_.imu.linear_acceleration : sensors_.imu.angular_velocity;
    int count = 0;
    for (; quiet() && count < 2000; ++count) {
      other[0] = -other[0];
      check();
    }
    EXPECT_EQ(count, cycles(parameters_.imu_stuck));
    EXPECT_EQ(out_.with(Reaction::kSlow), kCauseImuStuck);
    EXPECT_NEAR(out_.measurements()[0].value, parameters_.imu_stuck.persistence, 1e-9);
  }
}

TEST_F(BodyConditionsTest, StandsStillWithoutAStuckImu) {
  wheels_turn_ = false;
  for (int i = 0; i < 2000; ++i) {
    check();
    ASSERT_TRUE(quiet());
  }
}

TEST_F(BodyConditionsTest, ASlowImuIsNotStuck) {
  for (int i = 0; i < 2000; ++i) {  // gyro and accelerometer at 100 Hz, not at once
    jitter_ = i / 10 % 2 == 0 ? 1e-12 : -1e-12;
    if (i % 10 == 0) sensors_.imu.angular_velocity = plain(rate_ + jitter_ * Vector3d::Ones());
    if (i % 10 == 5) sensors_.imu.linear_acceleration = plain(force_ + jitter_ * Vector3d::Ones());
    check();
    ASSERT_TRUE(quiet());
  }
}

/// Random rates within the range of a BMI088, on all axes, or on one of them.
struct JumpingRatesTest : BodyConditionsTest, testing::WithParamInterface<Vector3d> {
  static constexpr int kSeeds = 200;

  void jump() {
    for (int axis = 0; axis < 3; ++axis) rate_[axis] = GetParam()[axis] * random_(engine_);
  }

  std::mt19937_64 engine_;
  std::uniform_real_distribution<double> random_{-34.9, 34.9};
};

// A rate within the limit of the one before counts as none: of one axis that is one in seven.
TEST_P(JumpingRatesTest, AreFoundWithinTwentySamples) {
  for (int seed = 0; seed < kSeeds; ++seed) {
    begin();
    int count = 0;
    for (; quiet() && count < 20; ++count) {
      jump();
      step();
    }
    ASSERT_EQ(out_.stopping(), kCauseImuJump) << seed;
    ASSERT_GE(count, 5) << seed;
    ASSERT_GT(out_.measurements()[0].value, parameters_.imu_jump.limit.value()) << seed;
    rate_.setZero();
    steps(RateChange::kSamples);
    ASSERT_TRUE(quiet()) << seed << ": the gyro is sound again";
  }
}

TEST_P(JumpingRatesTest, OfAnImuAtAHundredHertzAreFoundAtTheFifthJump) {
  int jumps = 0;
  for (int i = 0; quiet() && i < 200; ++i) {
    if (i % 10 == 0) {
      rate_ = (jumps % 2 == 0 ? 6 : 0) * GetParam();
      sensors_.imu.angular_velocity = plain(rate_);
      ++jumps;
    }
    check();
  }
  EXPECT_EQ(out_.stopping(), kCauseImuJump);
  EXPECT_EQ(jumps, 5);
}

TEST_P(JumpingRatesTest, AreNoneWhileTwoSamplesInNineAreWrong) {
  for (int i = 0; i < 900; ++i) {
    rate_.setZero();
    if (i % 9 == 0 || i % 9 == 4) jump();
    step();
    ASSERT_TRUE(quiet()) << i;
  }
}

// A blow turns the body at 15 rad/s within 3 ms, and the ground stops it.
TEST_P(JumpingRatesTest, AreNoBlow) {
  for (const double rate : {5.5, 11.0, 16.5, 16.5, 8.0, 0.0, 0.0}) {
    rate_ = rate * GetParam().normalized();
    steps(rate == 16.5 ? 5 : 1);
    ASSERT_EQ(out_.stopping() & kCauseImuJump, 0u) << rate;
  }
}

TEST_P(JumpingRatesTest, OfAnEarlierRunDoNotCount) {
  for (int i = 0; i < 8; ++i) {
    if (i == 4) facts_.enter_run();
    rate_ = (i % 2 == 0 ? 6 : 0) * GetParam();
    step();
    ASSERT_TRUE(quiet()) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(OnAxes, JumpingRatesTest,
                         testing::Values(Vector3d(1, 1, 1), Vector3d(1, 0, 0), Vector3d(0, 1, 0), Vector3d(0, 0, 1)));

TEST_F(BodyConditionsTest, ASampleThatIsNotFiniteIsIgnored) {
  const double before = facts_.body.attitude().tilt();
  for (const double bad : {kNaN, std::numeric_limits<double>::infinity()}) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      sensors_.imu.angular_velocity = {0, 0, 0};
      sensors_.imu.linear_acceleration = {0, 0, kGravity};
      sensors_.imu.angular_velocity[axis] = bad;
      sensors_.imu.linear_acceleration[axis] = bad;
      check();
      EXPECT_TRUE(quiet());
    }
  }
  EXPECT_NEAR(facts_.body.attitude().tilt(), before, 1e-9);
  EXPECT_NEAR(facts_.body.shock(), 0, 1e-9);
  EXPECT_EQ(cycles_until(kCauseTilt, 100), -1);
}

TEST_F(BodyConditionsTest, ASampleThatIsNotValidIsIgnored) {
  sensors_.valid = 0;
  force_ = {100, 0, 0};
  rate_ = {30, 0, 0};
  steps(100);
  EXPECT_TRUE(quiet());
  EXPECT_LT(facts_.body.attitude().tilt(), 1e-6);
}

TEST_F(BodyConditionsTest, ContactForcesThatAreNotFiniteTellNothing) {
  measure_contacts(sensors_);
  sensors_.contacts[0].force = {kNaN, 0, 0};
  EXPECT_EQ(cycles_until(kCauseLift, 500), -1);
}

// 1 m/s at 2 rad/s gives 2 m/s² to the left, which would be 0.2 rad as gravity.
TEST_F(BodyConditionsTest, ACurveIsNoTilt) {
  rate_ = {0, 0, 2};
  force_ = {0, 2, kGravity};
  for (std::size_t i = 0; i < 2; ++i) sensors_.joints[i].velocity = 10;
  steps(20000);
  EXPECT_TRUE(quiet());
  EXPECT_NEAR(facts_.body.attitude().tilt(), 0, 1e-6);
}

// 0.5 m ahead of the axle, at 2 rad/s on the spot: 2 m/s² backwards.
TEST_F(BodyConditionsTest, AnImuFarOutIsNotTilted) {
  robot_.imu_in_base.position = {0.5, 0, 0.1};
  begin();
  rate_ = {0, 0, 2};
  force_ = {-2, 0, kGravity};
  for (std::size_t i = 0; i < 2; ++i) sensors_.joints[i].velocity = i == 0 ? -4 : 4;
  steps(20000);
  EXPECT_NEAR(facts_.body.attitude().tilt(), 0, 1e-6);
}

TEST_F(BodyConditionsTest, ACurveIsFeltWithWheelsThatTurnTheOtherWay) {
  robot_.wheels[0].sign = -1;
  begin();
  rate_ = {0, 0, 2};
  force_ = {0, 2, kGravity};
  sensors_.joints[0].velocity = -10;
  sensors_.joints[1].velocity = 10;
  steps(20000);
  EXPECT_NEAR(facts_.body.attitude().tilt(), 0, 1e-6);
}

TEST_F(BodyConditionsTest, EncodersThatSayNothingDoNoHarm) {
  sensors_.joints[0].velocity = kNaN;
  steps(1000);
  EXPECT_LT(facts_.body.attitude().tilt(), 1e-6);
}

// The IMU is mounted upside down and turned: its samples are turned back into base axes.
TEST_F(BodyConditionsTest, TheMountingOfTheImuCounts) {
  const Eigen::Quaterniond mounting =
      Eigen::AngleAxisd(std::numbers::pi, Vector3d::UnitX()) * Eigen::AngleAxisd(0.5, Vector3d::UnitZ());
  robot_.imu_in_base.orientation = {mounting.x(), mounting.y(), mounting.z(), mounting.w()};
  force_ = mounting.inverse() * Vector3d(0, 0, kGravity);
  facts_ = made();
  steps(100);
  EXPECT_NEAR(facts_.body.attitude().tilt(), 0, 1e-9);
  double angle = 0;
  while (quiet() && angle < 1) {
    angle += kPeriod;
    rate_ = mounting.inverse() * Vector3d(1, 0, 0);
    force_ = mounting.inverse() * (kGravity * Vector3d(0, std::sin(angle), std::cos(angle)));
    step();
  }
  EXPECT_EQ(out_.stopping(), kCauseTilt);
}

TEST_F(BodyConditionsTest, ANewRunKnowsNothing) {
  force_ = {0, 0, 0.5};
  steps(cycles(parameters_.free_fall) - 1);
  facts_.enter_run();
  EXPECT_FALSE(facts_.body.attitude().known());
  EXPECT_EQ(facts_.body.force(), 0);
  EXPECT_EQ(facts_.body.shock(), 0);
  EXPECT_EQ(made().body.shock(), 0);
  step();
  EXPECT_TRUE(quiet()) << "the count restarts";
}

TEST_F(BodyConditionsTest, SkippedCyclesCount) {
  sensors_.imu.linear_acceleration = {0, 0, 0.5};
  check(static_cast<std::uint64_t>(cycles(parameters_.free_fall)));
  EXPECT_EQ(out_.stopping(), kCauseFreeFall);
}

}  // namespace robot_control::tests

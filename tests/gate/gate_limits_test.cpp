/// Tests the gate's limits on its joints, and its failure modes.

#include <cstring>

#include "gate/gate_fixture.h"
#include "gate/joint_clamp.h"
#include "support/allocation_guard.h"

namespace robot_control::tests {

// Gains.

TEST_F(GateFixture, AJointWithoutLimitsAndWithoutAPositionGetsNoDampingBelowZero) {
  set_joints_valid(sensors_, 0);
  command_.joints[1].damping = -2.0;
  step();
  EXPECT_EQ(verdict(), GateVerdict::kClamped);
  EXPECT_EQ(joints_[1].damping, 0);
}

// Velocities for a drive's own loop.

struct GateDriveVelocity : GateFixture {
  GateDriveVelocity() : GateFixture({.effort = kLimit, .acceleration = 100}, {}) {
    command_.joints.fill({});
    request(0);
  }
  void request(double velocity) { command_.joints[0] = {.mode = JointMode::kDriveVelocity, .velocity = velocity}; }
};

TEST_F(GateDriveVelocity, ChangesByTheAccelerationOfTheJointAtMost) {
  next();
  EXPECT_EQ(verdict(), GateVerdict::kPassed);
  request(5);
  next();
  EXPECT_EQ(verdict(), GateVerdict::kClamped);
  const double first = joints_[0].velocity;
  next();
  EXPECT_NEAR(joints_[0].velocity, 2 * first, 1e-12);
  EXPECT_LT(first, 5);
}

TEST_F(GateDriveVelocity, BeginsAfterABrakeBetweenTheMeasuredSpeedAndZero) {
  next();
  permit_.action = PermitAction::kBrake;
  next();
  EXPECT_EQ(verdict(), GateVerdict::kBrake);
  permit_.action = PermitAction::kDrive;
  request(-5);
  next();
  const double first = joints_[0].velocity;
  EXPECT_LT(first, 0);
  EXPECT_GT(first, -5);
}

// Ramps.

struct GateRamp : GateFixture {
  GateRamp() : GateFixture({.effort = kLimit}, {.longest_ramp = 10}) { ramp_for_ever(); }
  void ramp_for_ever() {
    permit_.action = PermitAction::kRamp;
    permit_.ramp_until = ~0ULL;
  }
};

TEST_F(GateRamp, PassesForItsLongestTimeAndThenBrakesWhateverThePermitSays) {
  for (int tick = 0; tick < 10; ++tick) {
    next();
    ASSERT_EQ(verdict(), GateVerdict::kRamp) << tick;
  }
  for (int tick = 0; tick < 50; ++tick) {
    expect_brake(kGateRampTooLong);
    tick_at(input_.cycle + 1);
  }
}

TEST_F(GateRamp, CountsCyclesThatWereSkipped) {
  next();
  tick_at(input_.cycle + 9);  // tick 110
  expect_brake(kGateRampTooLong);
}

TEST_F(GateRamp, BeginsAnewInANewRun) {
  for (int tick = 0; tick < 9; ++tick) next();
  gate_.enter_run();
  for (int tick = 0; tick < 10; ++tick) {
    next();
    ASSERT_EQ(verdict(), GateVerdict::kRamp) << tick;
  }
}

TEST_F(GateRamp, AMissingPermitDoesNotRestartIt) {
  for (int tick = 0; tick < 10; ++tick) next();
  input_.permit_found = Lookup::kMissing;
  next();
  input_.permit_found = Lookup::kFrame;
  expect_brake(kGateRampTooLong);
}

TEST_F(GateRamp, ADrivePermitDoes) {
  for (int tick = 0; tick < 20; ++tick) next();
  permit_.action = PermitAction::kDrive;
  next();
  EXPECT_EQ(verdict(), GateVerdict::kPassed);
  ramp_for_ever();
  next();
  EXPECT_EQ(verdict(), GateVerdict::kRamp);
}

TEST_F(GateRamp, ABrakePermitDoes) {
  for (int tick = 0; tick < 20; ++tick) next();
  permit_.action = PermitAction::kBrake;
  next();
  ramp_for_ever();
  next();
  EXPECT_EQ(verdict(), GateVerdict::kRamp);
}

// How fast an effort may change: 400 N·m/s are 0.4 N·m a tick.

struct GateRate : GateFixture {
  GateRate() : GateFixture({.effort = kLimit, .effort_rate = 400}) { command_.joints[1].effort = 0; }
  void request(double effort) { command_.joints[0].effort = effort; }
};

TEST_F(GateRate, BoundsTheChangePerTick) {
  request(1.0);
  for (const double expected : {0.4, 0.8, 1.0}) {
    next();
    EXPECT_NEAR(joints_[0].effort, expected, 1e-15);
  }
  EXPECT_EQ(reasons(), 0u);
  EXPECT_EQ(verdict(), GateVerdict::kPassed);
  request(-1.0);
  next();
  EXPECT_NEAR(joints_[0].effort, 0.6, 1e-15);
  EXPECT_EQ(reasons(), std::uint64_t{kGateRateClamped});
  EXPECT_EQ(verdict(), GateVerdict::kClamped);
}

TEST_F(GateRate, SkippedTicksAddUp) {
  request(5.0);
  next();
  tick_at(input_.cycle + 3);
  step();
  EXPECT_NEAR(joints_[0].effort, 0.4 + 4 * 0.4, 1e-15);
}

TEST_F(GateRate, TheTicksBetweenTwoRunsDoNot) {
  next();
  gate_.enter_run();
  tick_at(input_.cycle + 9);
  request(5.0);
  step();
  EXPECT_NEAR(joints_[0].effort, 0.4, 1e-15);
}

TEST_F(GateRate, AHeldCommandGoesOnTowardsIt) {
  request(1.0);
  next();
  command_of(input_.cycle - 2);
  step();
  EXPECT_NEAR(joints_[0].effort, 0.8, 1e-15);
  EXPECT_EQ(reasons(), kGateCommandHeld | kGateRateClamped);
}

// The brake held a robot on a slope: the controller takes over its torque.
TEST_F(GateRate, AfterABrakeItMayBeginWhereTheBrakeHeld) {
  sensors_.joints[0].effort = -3;
  request(-3);
  step();
  EXPECT_EQ(joints_[0].effort, -3);
  EXPECT_EQ(reasons(), 0u);
}

TEST_F(GateRate, AfterABrakeItMayBeginAtZeroAndBetween) {
  sensors_.joints[0].effort = -3;
  for (const double effort : {0.0, -1.2, 0.4, -3.4}) {
    gate_.enter_run();
    request(effort);
    step();
    EXPECT_EQ(joints_[0].effort, effort);
  }
  gate_.enter_run();
  request(0.5);
  step();
  EXPECT_NEAR(joints_[0].effort, 0.4, 1e-15);
}

TEST_F(GateRate, WhatTheBrakeHeldCountsUpToTheEffortLimit) {
  for (const double absurd : {1e9, kInfinity, kNaN}) {
    gate_.enter_run();
    sensors_.joints[0].effort = absurd;
    request(kLimit);
    step();
    EXPECT_NEAR(joints_[0].effort, absurd == 1e9 ? kLimit : 0.4, 1e-15) << absurd;
  }
}

TEST_F(GateRate, WhatIsNotMeasuredCountsForNothing) {
  sensors_.joints[0].effort = -3;
  request(-3);
  for (const std::uint32_t valid : {std::uint32_t{kValidPosition}, std::uint32_t{kValidEffort}}) {
    gate_.enter_run();
    set_joints_valid(sensors_, valid);
    step();
    EXPECT_NEAR(joints_[0].effort, -0.4, 1e-15) << valid;
  }
}

TEST_F(GateRate, WhileItDrivesTheMeasuredEffortCountsForNothing) {
  request(0.4);
  next();
  sensors_.joints[0].effort = 5;
  request(5);
  next();
  EXPECT_NEAR(joints_[0].effort, 0.8, 1e-15);
}

TEST_F(GateRate, AJointThatBrakesIsNotClamped) {
  command_.joints[0] = {.mode = JointMode::kBrake, .effort = 3};
  step();
  EXPECT_EQ(reasons(), 0u);
  EXPECT_EQ(joints_[0].effort, 3);
}

TEST_F(GateRate, AJointThatBrakedAloneRestarts) {
  request(0.4);
  next();
  command_.joints[0].mode = JointMode::kBrake;
  next();
  command_.joints[0].mode = JointMode::kEffort;
  sensors_.joints[0].effort = 2;
  request(2);
  next();
  EXPECT_EQ(joints_[0].effort, 2);
}

// How fast a joint may turn: 20 rad/s.

struct GateSpeed : GateFixture {
  GateSpeed() : GateFixture({.effort = kLimit, .velocity = 20}) {}
  void turn(double speed, int ticks = 40) {
    for (int i = 0; i < ticks; ++i) {
      sensors_.joints[0].position += speed * kPeriod;
      next();
    }
  }
};

TEST_F(GateSpeed, DrivesOnBelowTheTaper) {
  turn(17.9);
  EXPECT_EQ(verdict(), GateVerdict::kPassed);
  EXPECT_EQ(joints_[0].effort, 1.5);
}

TEST_F(GateSpeed, RefusesEffortTowardsMoreSpeedAboveTheLimit) {
  turn(20.1);
  EXPECT_EQ(verdict(), GateVerdict::kClamped);
  EXPECT_EQ(reasons(), std::uint64_t{kGateSpeedClamped});
  EXPECT_EQ(joints_[0].effort, 0);
  EXPECT_EQ(joints_[1].effort, -0.5);
}

TEST_F(GateSpeed, LetsItBrakeByTorque) {
  turn(-30);
  EXPECT_EQ(joints_[0].effort, 1.5);
  EXPECT_EQ(verdict(), GateVerdict::kPassed);
}

TEST_F(GateSpeed, ReportsItOfARampToo) {
  permit_.action = PermitAction::kRamp;
  permit_.ramp_until = 1000;
  turn(30);
  EXPECT_EQ(verdict(), GateVerdict::kRamp);
  EXPECT_EQ(reasons(), std::uint64_t{kGateSpeedClamped});
}

TEST_F(GateSpeed, WatchesWhileItBrakes) {
  permit_.action = PermitAction::kBrake;
  turn(30);
  permit_.action = PermitAction::kDrive;
  turn(30, 1);
  EXPECT_EQ(joints_[0].effort, 0);
}

TEST_F(GateSpeed, WhatTheDriverMeasuresAsVelocityIsNotAsked) {
  sensors_.joints[0].velocity = kNaN;
  turn(0);
  EXPECT_EQ(verdict(), GateVerdict::kPassed);
}

TEST_F(GateSpeed, ANewRunBeginsAtRest) {
  turn(30);
  gate_.enter_run();
  step();
  EXPECT_EQ(verdict(), GateVerdict::kPassed);
}

// Samples.

TEST_F(GateSpeed, BrakesWhereTheSamplesAreMissing) {
  set_joints_valid(sensors_, 0);
  expect_brake(kGateBadSensors);
  set_joints_valid(sensors_, kValidMotion);
  sensors_.joint_count = 1;
  expect_brake(kGateBadSensors);
  command_.joints[1].mode = JointMode::kBrake;
  expect_brake(kGateBadSensors);
}

TEST_F(GateSpeed, BrakesOnAPositionThatIsNotFinite) {
  for (const std::size_t joint : {0U, 1U}) {
    for (const double position : {kNaN, kInfinity, -kInfinity}) {
      sensors_.joints[joint].position = position;
      expect_brake(kGateBadSensors);
    }
    sensors_.joints[joint].position = 0;
  }
  step();
  EXPECT_EQ(verdict(), GateVerdict::kPassed);
}

TEST_F(GateSpeed, AJointThatBrakesNeedsNoSample) {
  command_.joints[1].mode = JointMode::kBrake;
  sensors_.joints[1].position = kNaN;
  step();
  EXPECT_EQ(verdict(), GateVerdict::kPassed);
}

class GateWithoutLimits : public GateFixture {};

TEST_F(GateWithoutLimits, NeedsNoSamplesWhereNothingIsKnown) {
  set_joints_valid(sensors_, 0);
  step();
  EXPECT_EQ(verdict(), GateVerdict::kPassed);
}

// End stops.

struct GateRange : GateFixture {
  GateRange() : GateFixture({.effort = kLimit, .lower = -1, .upper = 1, .soft_zone = 0.1}) {}
};

TEST_F(GateRange, BrakesTheJointAloneAtItsEndStop) {
  sensors_.joints[0].position = 1;
  step();
  EXPECT_EQ(joints_[0].mode, JointMode::kBrake);
  EXPECT_EQ(joints_[1].mode, JointMode::kVelocity);
  EXPECT_EQ(verdict(), GateVerdict::kClamped);
  EXPECT_EQ(reasons(), std::uint64_t{kGatePositionClamped});
}

TEST_F(GateRange, BrakesWithoutAPosition) {
  set_joints_valid(sensors_, 0);
  expect_brake(kGateBadSensors);
}

// Stop actions of the joints.

struct GateWithStopActions : GateFixture {
  GateWithStopActions()
      : GateFixture({.effort = kLimit},
                    {.profiles = {{{.kind = StopKind::kCoast}, {.kind = StopKind::kDamp, .damping = 3}}}}) {}

  void expect_stop() {
    step();
    EXPECT_EQ(verdict(), GateVerdict::kBrake);
    const JointCommand coast{.mode = JointMode::kEffort};
    const JointCommand damp{.mode = JointMode::kVelocity, .damping = 3};
    EXPECT_EQ(std::memcmp(&joints_[0], &coast, sizeof coast), 0);
    EXPECT_EQ(std::memcmp(&joints_[1], &damp, sizeof damp), 0);
  }
};

TEST_F(GateWithStopActions, OrdersThatOfEachJointWhateverIsMissing) {
  permit_.action = PermitAction::kBrake;
  expect_stop();
  permit_.action = PermitAction::kDrive;
  input_.permit_found = Lookup::kMissing;
  expect_stop();
  input_.permit_found = Lookup::kFrame;
  input_.command_found = Lookup::kMissing;
  expect_stop();
  input_.command_found = Lookup::kFrame;
  command_.joints[0].effort = kNaN;
  expect_stop();
  input_.cycle = 0;
  expect_stop();
}

TEST_F(GateWithStopActions, OrdersThemInTickZeroAlready) {
  input_.cycle = 0;
  expect_stop();
}

TEST_F(GateWithStopActions, ACommandThatBrakesEveryJointIsApplied) {
  command_.joints[0].mode = command_.joints[1].mode = JointMode::kBrake;
  expect_brake(kGateControllerBrake);
}

TEST_F(GateWithStopActions, DrivesAsEver) {
  step();
  EXPECT_EQ(verdict(), GateVerdict::kPassed);
  EXPECT_EQ(joints_[0].effort, 1.5);
}

struct GateWithAMove : GateFixture {
  static constexpr StopAction kMove{
      .kind = StopKind::kMove, .damping = 2, .stiffness = 60, .target = 1.5, .time = 1.25, .brake_after = 1.5};
  static constexpr StopAction kDamp{.kind = StopKind::kDamp, .damping = 3};
  GateWithAMove() : GateFixture({.effort = kLimit}, {.profiles = {{kMove, kMove}, {kDamp, kDamp}}}) {}

  void brake() {
    permit_.action = PermitAction::kBrake;
    next();
  }
  /// The order is that of a move that begins now, `cycles` after the last tick.
  void expect_first_order(int cycles) {
    const JointCommand first = JointStop().step(kMove, 0.5, cycles * kPeriod);
    EXPECT_EQ(std::memcmp(&joints_[0], &first, sizeof first), 0);
  }
};

TEST_F(GateWithAMove, MovesByTheTimeBetweenTheTicks) {
  sensors_.joints[0].position = 0.5;
  next();
  tick_at(input_.cycle + 2);
  brake();
  expect_first_order(3);
  JointStop move;
  move.step(kMove, 0.5, 3 * kPeriod);
  brake();
  const JointCommand second = move.step(kMove, 0.5, kPeriod);
  EXPECT_EQ(std::memcmp(&joints_[0], &second, sizeof second), 0);
}

TEST_F(GateWithAMove, GoesOnToMoveWhereTheCommandBrakesEveryJointAfterAStop) {
  sensors_.joints[0].position = 0.5;
  brake();
  JointStop move;
  move.step(kMove, 0.5, kPeriod);
  permit_.action = PermitAction::kDrive;
  command_.joints[0].mode = command_.joints[1].mode = JointMode::kBrake;
  next();
  EXPECT_EQ(gate_.report().reasons, kGateControllerBrake);
  const JointCommand second = move.step(kMove, 0.5, kPeriod);
  EXPECT_EQ(std::memcmp(&joints_[0], &second, sizeof second), 0);
}

TEST_F(GateWithAMove, BrakesWhereTheCommandBrakesEveryJointThatItMovedBefore) {
  next();
  command_.joints[0].mode = command_.joints[1].mode = JointMode::kBrake;
  next();
  EXPECT_EQ(gate_.report().reasons, kGateControllerBrake);
  EXPECT_EQ(joints_[0].mode, JointMode::kBrake);
}

TEST_F(GateWithAMove, MovesFromTheBeginningAfterACommandAndInANewRun) {
  for (int i = 0; i < 100; ++i) brake();
  sensors_.joints[0].position = 0.5;
  permit_.action = PermitAction::kDrive;
  next();
  brake();
  expect_first_order(1);
  brake();
  gate_.enter_run();
  brake();
  expect_first_order(1);
}

TEST_F(GateWithAMove, StopsByTheProfileThatTheLastExecutedCommandNamed) {
  sensors_.joints[0].position = 0.5;
  command_.stop_profile = 1;
  permit_.action = PermitAction::kBrake;
  next();
  EXPECT_EQ(joints_[0].mode, JointMode::kImpedance) << "no command was executed as yet";
  permit_.action = PermitAction::kDrive;
  next();
  command_.stop_profile = 0;
  brake();
  EXPECT_EQ(joints_[0].mode, JointMode::kVelocity) << "the last command was not executed";
  permit_.action = PermitAction::kDrive;
  next();
  brake();
  expect_first_order(1);
  command_.stop_profile = 1;
  permit_.action = PermitAction::kDrive;
  next();
  gate_.enter_run();
  brake();
  expect_first_order(1);
}

TEST_F(GateWithAMove, BrakesOnAProfileThatTheRobotDoesNotHave) {
  for (const std::uint64_t profile : {std::uint64_t{2}, ~std::uint64_t{0}}) {
    command_.stop_profile = profile;
    next();
    EXPECT_EQ(verdict(), GateVerdict::kBrake);
    EXPECT_EQ(reasons(), kGateUnknownMode);
  }
  EXPECT_EQ(gate_.report().refused, 2u);
}

// Construction.

TEST(GateConstruction, RefusesLimitsThatAreNone) {
  const auto refused = [](const JointLimits& limits) {
    try {
      Gate({JointLimits{}, limits}, {}, kPeriod);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what()).find("joint 1") != std::string::npos;
    }
    return false;
  };
  EXPECT_TRUE(refused({.effort = -1.0}));
  EXPECT_TRUE(refused({.effort = kNaN}));
  EXPECT_TRUE(refused({.effort = kInfinity}));
  EXPECT_TRUE(refused({.effort_rate = 0}));
  EXPECT_TRUE(refused({.effort_rate = kNaN}));
  EXPECT_TRUE(refused({.velocity = 0}));
  EXPECT_TRUE(refused({.velocity = kNaN}));
  EXPECT_TRUE(refused({.lower = 1, .upper = 1}));
  EXPECT_TRUE(refused({.lower = kNaN}));
  EXPECT_TRUE(refused({.upper = kNaN}));
  EXPECT_TRUE(refused({.soft_zone = -0.1}));
  EXPECT_TRUE(refused({.soft_zone = kInfinity}));
}

TEST(GateConstruction, TakesSmallLimits) {
  EXPECT_NO_THROW(Gate({{.effort = 0, .effort_rate = 0.1, .velocity = 0.1, .lower = 0.1, .upper = 0.2}}, {}, kPeriod));
}

TEST(GateConstruction, RefusesStopActionsThatAreNone) {
  const std::vector<JointLimits> limits(2);
  EXPECT_NO_THROW(Gate(limits, {.profiles = {{{}, {.kind = StopKind::kDamp, .damping = 1}}}}, kPeriod));
  EXPECT_THROW(Gate(limits, {.profiles = {StopProfile(1)}}, kPeriod), std::invalid_argument);
  for (const double damping : {-1.0, kNaN, kInfinity}) {
    EXPECT_THROW(Gate(limits, {.profiles = {{{}, {.damping = damping}}}}, kPeriod), std::invalid_argument) << damping;
    EXPECT_THROW(Gate(limits, {.profiles = {{{}, {.stiffness = damping}}}}, kPeriod), std::invalid_argument) << damping;
    EXPECT_THROW(Gate(limits, {.profiles = {{{}, {.time = damping}}}}, kPeriod), std::invalid_argument) << damping;
    EXPECT_THROW(Gate(limits, {.profiles = {{{}, {.brake_after = damping}}}}, kPeriod), std::invalid_argument);
  }
  for (const double position : {kNaN, kInfinity, -kInfinity}) {
    EXPECT_THROW(Gate(limits, {.profiles = {{{}, {.target = position}}}}, kPeriod), std::invalid_argument) << position;
    EXPECT_THROW(Gate(limits, {.profiles = {{{}, {.start = position}}}}, kPeriod), std::invalid_argument) << position;
  }
  EXPECT_NO_THROW(Gate(limits, {.profiles = {{{}, {.target = -1, .start = -2}}}}, kPeriod));
}

TEST(GateConstruction, RefusesAWrongProfileBehindARightOneAndTooManyProfiles) {
  const std::vector<JointLimits> limits(2);
  const std::vector<StopProfile> most(Gate::kMaxProfiles, StopProfile(2));
  EXPECT_NO_THROW(Gate(limits, {.profiles = most}, kPeriod));
  EXPECT_THROW(Gate(limits, {.profiles = {StopProfile(2), StopProfile(3)}}, kPeriod), std::invalid_argument);
  EXPECT_THROW(Gate(limits, {.profiles = std::vector(Gate::kMaxProfiles + 1, StopProfile(2))}, kPeriod),
               std::length_error);
}

TEST(GateConstruction, RefusesMoreJointsThanAFrameHoldsAndNoPeriod) {
  EXPECT_THROW(Gate(std::vector<JointLimits>(kMaxJoints + 1), {}, kPeriod), std::invalid_argument);
  EXPECT_NO_THROW(Gate(std::vector<JointLimits>(kMaxJoints), {}, kPeriod));
  EXPECT_THROW(Gate({}, {}, 0), std::invalid_argument);
  EXPECT_THROW(Gate({}, {}, kNaN), std::invalid_argument);
}

TEST_F(GateRange, StepsWithoutAllocating) {
  if (!AllocationGuard::kCounts) GTEST_SKIP() << "the sanitizer owns the allocator";
  AllocationGuard guard;
  for (int i = 0; i < 100; ++i) {
    sensors_.joints[0].position = 0.02 * i;
    next();
  }
  gate_.enter_run();
  EXPECT_EQ(guard.count(), 0u);
}

}  // namespace robot_control::tests

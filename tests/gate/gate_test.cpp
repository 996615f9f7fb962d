#include <cstring>

#include "gate/gate_fixture.h"

namespace robot_control::tests {

class GateTest : public GateFixture {};

TEST_F(GateTest, PassesTheHealthyCommandUnchanged) {
  step();
  EXPECT_EQ(gate_.report().verdict, GateVerdict::kPassed);
  EXPECT_EQ(gate_.report().reasons, 0u);
  EXPECT_EQ(gate_.report().command_cycle, 99u);
  EXPECT_EQ(gate_.report().permit_cycle, 99u);
  EXPECT_EQ(gate_.report().cycle, 100u);
  EXPECT_EQ(gate_.report().refused, 0u);
  ASSERT_EQ(joints_.size(), 2u);
  EXPECT_EQ(std::memcmp(joints_.data(), command_.joints.data(), joints_.size_bytes()), 0);
}

TEST_F(GateTest, ReportsTheCommandThatItFindsWhateverThePermitSays) {
  permit_.action = PermitAction::kBrake;
  step();
  EXPECT_EQ(gate_.report().command_cycle, 99u);
  gate_.enter_run();
  input_.command_found = Lookup::kMissing;
  step();
  EXPECT_EQ(gate_.report().command_cycle, 0u);
}

TEST_F(GateTest, ReportsTheContactScheduleOfTheExecutedCommand) {
  command_.contact_schedule = {0.25, 0, 0, 0.25};
  step();
  EXPECT_EQ(gate_.report().contact_schedule, command_.contact_schedule);
  permit_.action = PermitAction::kBrake;
  step();
  EXPECT_EQ(gate_.report().contact_schedule, ContactSchedule{});
}

// The four questions, each answered "no" in turn.

TEST_F(GateTest, NamesWhyItBrakes) {
  const GateInput input = input_;
  const Permit permit = permit_;
  const CommandFrame command = command_;
  const auto brakes = [&](std::uint64_t reason, std::uint64_t refused, const auto& change) {
    input_ = input;
    permit_ = permit;
    command_ = command;
    gate_.enter_run();
    change();
    expect_brake(reason);
    EXPECT_EQ(gate_.report().refused, refused) << reason;
  };
  brakes(kGateNoPermit, 0, [&] { input_.permit_found = Lookup::kMissing; });
  brakes(kGateNoPermit, 0, [&] { input_.permit_found = Lookup::kToken; });
  brakes(kGateNoPermit, 0, [&] { permit_.head.run = kRun + 1; });
  brakes(kGateChecksum, 1, [&] { input_.permit_found = Lookup::kCorrupt; });
  brakes(kGateFuture, 1, [&] { permit_of(100); });
  brakes(kGateFuture, 1, [&] { permit_of(101); });
  brakes(kGatePermitExpired, 0, [&] { permit_.expiry = 99; });
  brakes(kGatePermitExpired, 0, [&] {
    permit_of(95);
    permit_.expiry = 1000;  // it claims a longer life
  });
  brakes(kGatePermitBrake, 0, [&] { permit_.action = PermitAction::kBrake; });
  brakes(kGateUnknownMode, 1, [&] { permit_.action = static_cast<PermitAction>(3); });
  brakes(kGateNoCommand, 0, [&] { input_.command_found = Lookup::kToken; });
  brakes(kGateNoCommand, 0, [&] { command_.head.run = kRun - 1; });
  brakes(kGateChecksum, 1, [&] { input_.command_found = Lookup::kCorrupt; });
  brakes(kGateUnknownMode, 1, [&] { command_.joints[1].mode = static_cast<JointMode>(kJointModes); });
}

// 1. Is the permit alive?

TEST_F(GateTest, BrakesInTickZero) {
  input_.cycle = 0;
  expect_brake(kGateFirstTick);
  EXPECT_EQ(gate_.report().missed, 0u);
}

TEST_F(GateTest, PermitIsAliveThroughItsExpiryCycleAndNoLonger) {
  permit_of(96);
  input_.cycle = 100;
  command_of(99);
  step();
  EXPECT_EQ(gate_.report().verdict, GateVerdict::kPassed);
  input_.cycle = 101;
  command_of(100);
  expect_brake(kGatePermitExpired);
}

TEST_F(GateTest, CountsPermitsThatAreLate) {
  step();
  EXPECT_EQ(gate_.report().late_permits, 0u);
  for (const std::uint64_t cycle : {98U, 97U, 96U, 95U}) {
    permit_of(cycle);
    step();
  }
  EXPECT_EQ(gate_.report().late_permits, 4u);
}

TEST_F(GateTest, ARevokedPermitDoesNotComeBack) {
  permit_.action = PermitAction::kBrake;
  step();
  tick_at(101);
  permit_of(98);  // the newest that can still be read
  permit_.action = PermitAction::kDrive;
  expect_brake(kGatePermitExpired);
}

TEST_F(GateTest, APermitWhoseCycleDoesNotAdvanceDiesAtItsAge) {
  for (std::uint64_t tick = 100; tick <= 103; ++tick) {
    input_.cycle = tick;
    command_of(tick - 1);
    step();
    EXPECT_EQ(gate_.report().verdict, GateVerdict::kPassed) << tick;
  }
  input_.cycle = 104;
  command_of(103);
  permit_.expiry = 1000;  // it claims to be valid
  expect_brake(kGatePermitExpired);
}

// 2. Does it allow motion?

TEST_F(GateTest, RampPassesThroughItsLastCycleAndNoLonger) {
  permit_.action = PermitAction::kRamp;
  permit_.ramp_until = 100;
  step();
  EXPECT_EQ(gate_.report().verdict, GateVerdict::kRamp);
  EXPECT_EQ(joints_[0].effort, 1.5);
  permit_.ramp_until = 99;
  expect_brake(kGateRampOver);
}

TEST_F(GateTest, RampClampsToo) {
  permit_.action = PermitAction::kRamp;
  permit_.ramp_until = 100;
  command_.joints[0].effort = 2 * kLimit;
  step();
  EXPECT_EQ(gate_.report().verdict, GateVerdict::kRamp);
  EXPECT_EQ(gate_.report().reasons, std::uint64_t{kGateEffortClamped});
  EXPECT_EQ(joints_[0].effort, kLimit);
}

// 3. Is the command fresh?

TEST_F(GateTest, HoldsACommandForExactlyThreeCycles) {
  for (std::uint64_t tick = 101; tick <= 103; ++tick) {
    input_.cycle = tick;
    permit_of(tick - 1);
    step();
    EXPECT_EQ(gate_.report().verdict, GateVerdict::kHeld) << tick;
    EXPECT_EQ(gate_.report().reasons, std::uint64_t{kGateCommandHeld}) << tick;
    EXPECT_EQ(joints_[0].effort, 1.5) << tick;
  }
  EXPECT_EQ(gate_.report().held, 3u);
  EXPECT_EQ(gate_.report().missed, 0u);
  input_.cycle = 104;
  permit_of(103);
  expect_brake(kGateNoCommand);
  EXPECT_EQ(gate_.report().missed, 1u);
  EXPECT_EQ(gate_.report().held, 3u);
}

TEST_F(GateTest, BrakesWithoutACommand) {
  input_.command_found = Lookup::kMissing;
  command_of(1000);  // of no meaning
  expect_brake(kGateNoCommand);
  EXPECT_EQ(gate_.report().missed, 1u);
}

TEST_F(GateTest, BrakesOnACommandOfThisCycleOrTheFuture) {
  command_of(100);
  expect_brake(kGateFuture);
  EXPECT_EQ(gate_.report().command_cycle, 0u);
  command_of(1000);
  expect_brake(kGateFuture);
  EXPECT_EQ(gate_.report().refused, 2u);
}

TEST_F(GateTest, ABrakingPermitIsTheReasonNotTheMissingCommand) {
  permit_.action = PermitAction::kBrake;
  input_.command_found = Lookup::kMissing;
  expect_brake(kGatePermitBrake);
  EXPECT_EQ(gate_.report().missed, 0u);
}

TEST_F(GateTest, MovesAgainOnceTheCommandIsBack) {
  input_.command_found = Lookup::kMissing;
  step();
  input_.command_found = Lookup::kFrame;
  step();
  EXPECT_EQ(gate_.report().verdict, GateVerdict::kPassed);
}

// 4. Is every number finite, every checksum right?

TEST_F(GateTest, BrakesOnAnyFieldThatIsNotFinite) {
  const CommandFrame healthy = command_;
  std::uint64_t refused = 0;
  for (const double value : {kNaN, kInfinity, -kInfinity}) {
    for (const auto field : {&JointCommand::position, &JointCommand::velocity, &JointCommand::stiffness,
                             &JointCommand::damping, &JointCommand::effort}) {
      for (const std::size_t joint : {0U, 1U}) {
        command_ = healthy;
        command_.joints[joint].*field = value;
        expect_brake(kGateNotFinite);
        EXPECT_EQ(gate_.report().refused, ++refused);
      }
    }
  }
}

TEST_F(GateTest, DoesNotLookAtJointsThatTheRobotHasNot) {
  command_.joints[2].effort = kNaN;
  step();
  EXPECT_EQ(gate_.report().verdict, GateVerdict::kPassed);
}

TEST_F(GateTest, BrakesOnAnotherNumberOfJoints) {
  for (const std::uint64_t count : {0ULL, 1ULL, 3ULL, ~0ULL}) {
    command_.joint_count = count;
    expect_brake(kGateWrongJointCount);
  }
  EXPECT_EQ(gate_.report().refused, 4u);
}

// Then it clamps.

TEST_F(GateTest, ClampsEffortToTheJointsLimitWithItsSign) {
  command_.joints[0].effort = kLimit + 1e-9;
  command_.joints[1].effort = -1e300;
  step();
  EXPECT_EQ(gate_.report().verdict, GateVerdict::kClamped);
  EXPECT_EQ(gate_.report().reasons, std::uint64_t{kGateEffortClamped});
  EXPECT_EQ(joints_[0].effort, kLimit);
  EXPECT_EQ(joints_[1].effort, -kLimit);
}

TEST_F(GateTest, LeavesTheLimitItselfAlone) {
  command_.joints[0].effort = -kLimit;
  step();
  EXPECT_EQ(gate_.report().verdict, GateVerdict::kPassed);
}

TEST_F(GateTest, ReportsAHeldCommandThatWasClampedAsBoth) {
  command_of(98);
  command_.joints[0].effort = 2 * kLimit;
  step();
  EXPECT_EQ(gate_.report().verdict, GateVerdict::kClamped);
  EXPECT_EQ(gate_.report().reasons, kGateCommandHeld | kGateEffortClamped);
  EXPECT_EQ(gate_.report().held, 1u);
}

TEST_F(GateTest, PassesEveryMode) {
  command_.joints[0] = {.mode = JointMode::kImpedance, .position = 1, .velocity = 2, .stiffness = 3, .damping = 4};
  command_.joints[1] = {.mode = JointMode::kBrake, .damping = -2, .effort = 3};
  step();
  EXPECT_EQ(gate_.report().verdict, GateVerdict::kPassed);
  EXPECT_EQ(std::memcmp(joints_.data(), command_.joints.data(), joints_.size_bytes()), 0);
}

// Each array ends with its last joint: what lies behind it is that of nothing.
TEST_F(GateTest, PassesTheCommandOfAsManyJointsAsAFrameHolds) {
  Gate gate(std::vector<JointLimits>(kMaxJoints, {.effort = kLimit, .velocity = 20}), {}, kPeriod);
  command_.joint_count = sensors_.joint_count = kMaxJoints;
  command_.joints.fill({.mode = JointMode::kEffort, .effort = 1.5});
  const std::span<const JointCommand> all = gate.step(input_);
  EXPECT_EQ(gate.report().verdict, GateVerdict::kPassed);
  EXPECT_EQ(gate.report().cycle, 100u);
  ASSERT_EQ(all.size(), kMaxJoints);
  for (const JointCommand& joint : all) EXPECT_EQ(joint.effort, 1.5);
  permit_.action = PermitAction::kBrake;
  for (const JointCommand& joint : gate.step(input_)) EXPECT_EQ(joint.mode, JointMode::kBrake);
  EXPECT_EQ(gate.report().verdict, GateVerdict::kBrake);
  EXPECT_EQ(gate.report().cycle, 100u);
}

TEST_F(GateTest, AJointWhoseEffortLimitIsNotGivenGetsNoEffort) {
  Gate gate({{}, {}}, {}, kPeriod);
  for (const JointCommand& joint : gate.step(input_)) EXPECT_EQ(joint.effort, 0);
}

TEST_F(GateTest, ACommandThatBrakesEveryJointIsABrake) {
  command_.joints[0] = {.mode = JointMode::kBrake, .velocity = 3};
  command_.joints[1] = {.mode = JointMode::kBrake};
  expect_brake(kGateControllerBrake);
}

TEST_F(GateTest, OneBrakingJointAmongDrivingOnesPasses) {
  command_.joints[0].mode = JointMode::kBrake;
  step();
  EXPECT_EQ(gate_.report().verdict, GateVerdict::kPassed);
}

TEST_F(GateTest, ANewRunRestartsItsCounters) {
  input_.command_found = Lookup::kMissing;
  step();
  gate_.enter_run();
  const GateReport fresh;
  EXPECT_EQ(std::memcmp(&gate_.report(), &fresh, sizeof fresh), 0);
}

TEST_F(GateTest, ANewRunForgetsWhatItKnew) {
  permit_of(1000);
  input_.cycle = 1001;
  command_of(1000);
  step();
  gate_.enter_run();
  tick_at(5);  // else a permit of cycle 4 were superseded by that of cycle 1000
  step();
  EXPECT_EQ(gate_.report().verdict, GateVerdict::kPassed);
}

TEST_F(GateTest, PassesInTheFirstTickAfterTickZero) {
  for (int run = 0; run < 2; ++run) {
    gate_.enter_run();
    tick_at(1);
    step();
    EXPECT_EQ(gate_.report().verdict, GateVerdict::kPassed);
  }
}

}  // namespace robot_control::tests

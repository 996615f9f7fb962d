#include "hal/gate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <stdexcept>

#include "support/allocation_guard.h"

namespace robot_control {
namespace {

constexpr std::uint64_t kRun = 42;
constexpr double kLimit = 5.0;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Healthy case: tick 100, drive permit and command of cycle 99, two joints in effort mode within their limits.
class GateTest : public testing::Test {
 protected:
  GateTest() {
    permit_.head.run = command_.head.run = input_.run = kRun;
    permit_.action = PermitAction::kDrive;
    command_.joint_count = 2;
    command_.joints[0] = {.mode = JointMode::kEffort, .velocity = 4.5, .effort = 1.5};
    command_.joints[1] = {.mode = JointMode::kVelocity, .velocity = 5.5, .damping = 2.0, .effort = -0.5};
    input_.permit = &permit_;
    input_.command = &command_;
    input_.permit_found = input_.command_found = Lookup::kFrame;
    input_.cycle = 100;
    permit_of(99);
    command_of(99);
  }

  void permit_of(std::uint64_t cycle) {
    permit_.head.cycle = cycle;
    permit_.expiry = cycle + kPermitLife;
  }
  void command_of(std::uint64_t cycle) { command_.head.cycle = cycle; }
  void step() { joints_ = gate_.step(input_); }
  bool braked() const {
    bool brake = gate_.report().verdict == GateVerdict::kBrake && joints_.size() == 2;
    const JointCommand none;
    for (const JointCommand& joint : joints_) brake = brake && std::memcmp(&joint, &none, sizeof none) == 0;
    return brake;
  }
  void expect_brake(std::uint64_t reasons) {
    step();
    EXPECT_TRUE(braked());
    EXPECT_EQ(gate_.report().reasons, reasons);
  }

  Gate gate_{{kLimit, kLimit}};
  Permit permit_;
  CommandFrame command_;
  GateInput input_;
  std::span<const JointCommand> joints_;
};

TEST_F(GateTest, PassesTheHealthyCommandUnchanged) {
  step();
  EXPECT_EQ(gate_.report().verdict, GateVerdict::kPassed);
  EXPECT_EQ(gate_.report().reasons, 0u);
  EXPECT_EQ(gate_.report().command_cycle, 99u);
  EXPECT_EQ(gate_.report().permit_cycle, 99u);
  ASSERT_EQ(joints_.size(), 2u);
  EXPECT_EQ(std::memcmp(joints_.data(), command_.joints.data(), joints_.size_bytes()), 0);
}

// 1. Is the permit alive?

TEST_F(GateTest, BrakesInTickZero) {
  input_.cycle = 0;
  expect_brake(kGateFirstTick);
  EXPECT_EQ(gate_.report().missed, 0u);
}

TEST_F(GateTest, BrakesWithoutAPermit) {
  input_.permit_found = Lookup::kMissing;
  expect_brake(kGateNoPermit);
}

TEST_F(GateTest, BrakesOnATokenInPlaceOfAPermit) {
  input_.permit_found = Lookup::kToken;
  expect_brake(kGateNoPermit);
}

TEST_F(GateTest, BrakesOnAPermitOfAnotherRun) {
  permit_.head.run = kRun + 1;
  expect_brake(kGateNoPermit);
}

TEST_F(GateTest, BrakesOnACorruptPermit) {
  input_.permit_found = Lookup::kCorrupt;
  expect_brake(kGateChecksum);
  EXPECT_EQ(gate_.report().refused, 1u);
}

TEST_F(GateTest, BrakesOnAPermitOfThisCycleOrTheFuture) {
  permit_of(100);
  expect_brake(kGateFuture);
  permit_of(101);
  expect_brake(kGateFuture);
  EXPECT_EQ(gate_.report().refused, 2u);
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

TEST_F(GateTest, PermitThatClaimsALongerLifeDoesNotGetIt) {
  permit_of(95);
  permit_.expiry = 1000;
  expect_brake(kGatePermitExpired);
}

TEST_F(GateTest, PermitThatExpiresEarlierIsHeard) {
  permit_.expiry = 99;
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

// 2. Does it allow motion?

TEST_F(GateTest, BrakesWhenThePermitSaysSo) {
  permit_.action = PermitAction::kBrake;
  expect_brake(kGatePermitBrake);
}

TEST_F(GateTest, BrakesOnAnUnknownAction) {
  permit_.action = static_cast<PermitAction>(3);
  expect_brake(kGateUnknownMode);
}

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
  expect_brake(kGateNoCommand);
  EXPECT_EQ(gate_.report().missed, 1u);
}

TEST_F(GateTest, BrakesOnATokenInPlaceOfACommand) {
  input_.command_found = Lookup::kToken;
  expect_brake(kGateNoCommand);
}

TEST_F(GateTest, BrakesOnACommandOfAnotherRun) {
  command_.head.run = kRun - 1;
  expect_brake(kGateNoCommand);
}

TEST_F(GateTest, BrakesOnACommandOfThisCycleOrTheFuture) {
  command_of(100);
  expect_brake(kGateFuture);
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

TEST_F(GateTest, BrakesOnACorruptCommand) {
  input_.command_found = Lookup::kCorrupt;
  expect_brake(kGateChecksum);
  EXPECT_EQ(gate_.report().refused, 1u);
}

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
}

TEST_F(GateTest, BrakesOnAnUnknownMode) {
  command_.joints[1].mode = static_cast<JointMode>(4);
  expect_brake(kGateUnknownMode);
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

TEST_F(GateTest, ANewRunBeginsItsCountersAnew) {
  input_.command_found = Lookup::kMissing;
  step();
  gate_.reset();
  const GateReport fresh;
  EXPECT_EQ(std::memcmp(&gate_.report(), &fresh, sizeof fresh), 0);
}

TEST(GateConstruction, RefusesLimitsThatAreNone) {
  EXPECT_THROW(Gate({1.0, -1.0}), std::invalid_argument);
  EXPECT_THROW(Gate({kNaN}), std::invalid_argument);
  EXPECT_THROW(Gate(std::vector<double>(kMaxJoints + 1, 1.0)), std::invalid_argument);
  EXPECT_NO_THROW(Gate(std::vector<double>(kMaxJoints, 1.0)));
}

TEST_F(GateTest, StepsWithoutAllocating) {
  if (!AllocationGuard::kCounts) GTEST_SKIP() << "the sanitizer owns the allocator";
  AllocationGuard guard;
  step();
  input_.permit_found = Lookup::kCorrupt;
  step();
  EXPECT_EQ(guard.count(), 0u);
}

/// Words that are often nearly right, so that the fuzz gets past the first question.
std::uint64_t word(std::mt19937_64& random, std::uint64_t near) {
  switch (random() % 12) {
    case 0:
      return random();
    case 1:
      return near - random() % 6;
    case 2:
      return near + random() % 3;
    default:
      return near;
  }
}

double number(std::mt19937_64& random) {
  const std::uint64_t bits = random();
  double value = 0;
  std::memcpy(&value, &bits, sizeof value);
  return random() % 64 == 0 ? value : static_cast<double>(static_cast<std::int64_t>(bits)) * 1e-18;
}

TEST_F(GateTest, GarbageNeverMovesAJointBeyondItsLimitsOrWithoutAPermit) {
  const Lookup lookups[] = {Lookup::kMissing, Lookup::kFrame, Lookup::kFrame,
                            Lookup::kFrame,   Lookup::kToken, Lookup::kCorrupt};
  std::uint64_t moved = 0;
  for (unsigned seed = 0; seed < 50000; ++seed) {
    std::mt19937_64 random(seed);
    input_.cycle = word(random, 100);
    input_.permit_found = lookups[random() % 6];
    input_.command_found = lookups[random() % 6];
    permit_.head.run = word(random, kRun);
    permit_.head.cycle = word(random, 99);
    permit_.expiry = word(random, 103);
    permit_.ramp_until = word(random, 100);
    permit_.action = static_cast<PermitAction>(word(random, 2));
    command_.head.run = word(random, kRun);
    command_.head.cycle = word(random, 99);
    command_.joint_count = word(random, 2);
    for (JointCommand& joint : command_.joints) {
      joint = {static_cast<JointMode>(word(random, 2)),
               number(random),
               number(random),
               number(random),
               number(random),
               number(random)};
    }
    step();
    ASSERT_EQ(joints_.size(), 2u);
    for (const JointCommand& joint : joints_) {
      ASSERT_TRUE(std::isfinite(joint.position) && std::isfinite(joint.velocity) && std::isfinite(joint.stiffness) &&
                  std::isfinite(joint.damping))
          << "seed " << seed;
      ASSERT_LE(std::abs(joint.effort), kLimit) << "seed " << seed;
      ASSERT_LE(joint.mode, JointMode::kImpedance) << "seed " << seed;
    }
    if (gate_.report().verdict == GateVerdict::kBrake) {
      ASSERT_TRUE(braked()) << "seed " << seed;
      ASSERT_NE(gate_.report().reasons, 0u) << "seed " << seed;
      continue;
    }
    ++moved;
    ASSERT_TRUE(input_.permit_found == Lookup::kFrame && permit_.head.run == kRun) << "seed " << seed;
    ASSERT_LT(permit_.head.cycle, input_.cycle) << "seed " << seed;
    ASSERT_LE(input_.cycle, permit_.expiry) << "seed " << seed;
    ASSERT_NE(permit_.action, PermitAction::kBrake) << "seed " << seed;
    ASSERT_LE(input_.cycle - command_.head.cycle, kCommandLife) << "seed " << seed;
  }
  EXPECT_GT(moved, 100u);  // else the fuzz proved nothing
}

}  // namespace
}  // namespace robot_control

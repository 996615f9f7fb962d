// Tests the requirements of a reset, and what it does not clear.

#include <random>

#include "safety/latch/fixed_reactions.h"
#include "safety/monitor_fixture.h"
#include "signals/names.h"

namespace robot_control::tests {

/// The healthy case was stopped by e_stop_trigger while driving; the robot stands, and nothing is requested.
struct ResetTest : MonitorTest {
  ResetTest() {
    drive();
    ++input_.operator_input.e_stop_services;
    step();
    stand();
  }
};

TEST_F(ResetTest, IsAcceptedInItsCycle) {
  EXPECT_EQ(permit_.state, SupervisorState::kStopped);
  EXPECT_EQ(reset(), 0u);
  EXPECT_EQ(permit_.state, SupervisorState::kReady);
  EXPECT_EQ(permit_.action, PermitAction::kDrive);
  EXPECT_EQ(permit_.causes, 0u);
  EXPECT_EQ(permit_.first_cause, 0u);
  EXPECT_EQ(permit_.since_cycle, cycle());
}

TEST_F(ResetTest, IsRefusedWhileAMotionIsAskedFor) {
  ask_for(0.1);
  EXPECT_EQ(reset(), std::uint64_t{kRefusalCommand});
  EXPECT_EQ(permit_.state, SupervisorState::kStopped);
}

TEST_F(ResetTest, IsRefusedWhileATurnIsAskedFor) {
  command_.requested.twist.angular[2] = -0.1;
  EXPECT_EQ(reset(), std::uint64_t{kRefusalCommand});
}

TEST_F(ResetTest, IsRefusedWhileAWheelTurns) {
  speed_[1] = -0.2;
  steps(kStands);
  EXPECT_EQ(reset(), std::uint64_t{kRefusalMoving});
}

TEST_F(ResetTest, IsRefusedWhileItIsUnknownWhetherAWheelTurns) {
  set_joints_valid(sensors_, 0);
  EXPECT_EQ(reset(), std::uint64_t{kRefusalMoving});
}

TEST_F(ResetTest, IsRefusedWhileTheTopicStillSaysTrue) {
  input_.operator_input.e_stop_level = 1;
  EXPECT_EQ(reset(), std::uint64_t{kRefusalCauseActive});
  input_.operator_input.e_stop_level = 0;
  EXPECT_EQ(reset(), 0u);
}

TEST_F(ResetTest, NamesEveryReasonAtOnce) {
  sensors_.digital_inputs = kInputEmergencyStop;
  ask_for(1);
  turn_wheels(1);
  steps(20);
  EXPECT_EQ(reset(), kRefusalCauseActive | kRefusalCommand | kRefusalMoving);
}

TEST_F(ResetTest, AStopInTheSameCycleWins) {
  ++input_.operator_input.e_stop_services;
  EXPECT_EQ(reset(), std::uint64_t{kRefusalCauseActive});
  EXPECT_EQ(permit_.state, SupervisorState::kStopped);
}

TEST_F(ResetTest, ARefusedRequestIsNotTriedAgain) {
  ask_for(0.1);
  reset();
  ask_for(0);
  steps(100);
  EXPECT_EQ(permit_.state, SupervisorState::kStopped);
  EXPECT_EQ(permit_.reset_refusal, std::uint64_t{kRefusalCommand});
}

TEST_F(ResetTest, IsRefusedInACycleWithoutACommand) {
  input_.command = nullptr;
  EXPECT_EQ(reset(), std::uint64_t{kRefusalGap});
}

TEST_F(ResetTest, IsRefusedWhileTheControllerIsLost) {
  input_.command = nullptr;
  steps(kLoss);
  EXPECT_EQ(reset(), kRefusalCauseActive | kRefusalGap);
  input_.command = &command_;
  step();  // the next zero request is the first one after the gap
  EXPECT_EQ(reset(), 0u);
}

TEST_F(ResetTest, AFaultIsResetOnceItIsRepaired) {
  sensors_.faults = kFaultDrive;
  EXPECT_EQ(reset(), std::uint64_t{kRefusalCauseActive});
  EXPECT_EQ(permit_.state, SupervisorState::kFault);
  sensors_.faults = 0;
  EXPECT_EQ(reset(), 0u);
  EXPECT_EQ(permit_.state, SupervisorState::kReady);
}

TEST_F(ResetTest, ALostDriverIsResetOnceItIsBack) {
  wait(SensorSilence::kTimedOut);
  step();
  EXPECT_EQ(reset(), 0u);
}

TEST_F(ResetTest, HasNoEffectWhereNothingIsLatched) {
  reset();
  drive();
  EXPECT_EQ(reset(), 0u);
  EXPECT_EQ(permit_.state, SupervisorState::kDrive);
}

TEST_F(MonitorTest, AResetDuringTheRampCountsAsMoving) {
  drive();
  ++input_.operator_input.heartbeats;
  steps(kHeartbeat + 2);
  ASSERT_EQ(permit_.state, SupervisorState::kStopping);
  ask_for(0);
  ++input_.operator_input.heartbeats;
  EXPECT_EQ(reset(), std::uint64_t{kRefusalMoving});
  EXPECT_EQ(permit_.state, SupervisorState::kStopping);
}

TEST_F(MonitorTest, AResetInInitIsRefusedNamingTheMissingNode) {
  new_run();
  input_.command = nullptr;
  EXPECT_EQ(reset(), std::uint64_t{kRefusalInit});
  EXPECT_EQ(permit_.missing, std::uint64_t{kMissingCommand});
  EXPECT_EQ(reset(), std::uint64_t{kRefusalInit}) << "in the second cycle as well";
}

TEST_F(MonitorTest, AResetInTheCycleThatEndsInitIsNotRefused) {
  new_run();
  input_.command = nullptr;
  steps(2);
  ASSERT_EQ(permit_.state, SupervisorState::kInit);
  EXPECT_EQ(permit_.reset_refusal, 0u) << "none was requested";
  input_.command = &command_;
  step();
  ASSERT_EQ(permit_.state, SupervisorState::kInit) << "the gate has not found the command yet";
  EXPECT_EQ(reset(), 0u);
  EXPECT_EQ(permit_.state, SupervisorState::kReady);
}

// Each seed gives random facts for 2000 cycles. No permit drives under a latch, and a latch ends only by an accepted
// reset. Permits drive in READY and DRIVE alone, and the first cause is one of all.
TEST_F(MonitorTest, NeverPermitsDrivingUnderALatch) {
  std::uint64_t drives = 0;
  std::uint64_t stops = 0;
  std::uint64_t ramps = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    std::mt19937 random(seed);
    const auto chance = [&](unsigned one_in) { return random() % one_in == 0; };
    SafetyParameters impatient = parameters();
    impatient.heartbeat_timeout = 0.05;
    monitor_ = SafetyMonitor(impatient, robot(), kPeriod);
    new_run();
    std::uint64_t latched = 0;
    for (int i = 0; i < 2000; ++i) {
      if (chance(300)) new_run();
      if (chance(400)) wait(SensorSilence::kTimedOut);
      last_permit_ = permit_;
      if (chance(500)) inherit({.permit = &last_permit_});
      OperatorInput& operator_input = input_.operator_input;
      if (chance(300)) ++operator_input.e_stop_services;
      if (chance(300)) ++operator_input.e_stop_triggers;
      if (chance(40)) operator_input.e_stop_level = chance(8);
      if (chance(20)) ++operator_input.heartbeats;
      const bool asked = chance(15);
      if (asked) ++operator_input.resets;
      if (chance(30)) input_.command = chance(4) ? nullptr : &command_;
      if (chance(30)) input_.state = chance(4) ? nullptr : &state_;
      if (chance(30)) input_.corrupt = chance(8);
      if (chance(30)) sensors_.faults = chance(10) ? 1 : 0;
      if (chance(30)) sensors_.digital_inputs = chance(10) ? 1 : 0;
      if (chance(50)) ask_for(chance(3) ? 0.5 : 0);
      if (chance(50)) turn_wheels(chance(3) ? 1 : 0);
      if (chance(50)) command_.joints[0].effort = chance(8) ? std::nan("") : 0;
      step();

      const bool accepted = asked && permit_.reset_refusal == 0;
      if (!accepted) {
        ASSERT_EQ(permit_.causes & latched, latched) << "seed " << seed << " step " << i;
      }
      latched = permit_.causes;
      const bool drives_now = permit_.action == PermitAction::kDrive;
      ASSERT_EQ(drives_now, permit_.state == SupervisorState::kReady || permit_.state == SupervisorState::kDrive)
          << "seed " << seed << " step " << i;
      if (drives_now || permit_.state == SupervisorState::kInit) {
        ASSERT_EQ(permit_.causes, 0u) << "seed " << seed << " step " << i;
      } else {
        ASSERT_NE(permit_.first_cause & permit_.causes, 0u) << "seed " << seed << " step " << i;
      }
      ASSERT_EQ(permit_.active & ~permit_.causes, 0u) << "seed " << seed << " step " << i;
      if (permit_.action == PermitAction::kRamp) {
        ASSERT_EQ(permit_.causes & ~causes_of(FixedReaction::kRamp), 0u) << "seed " << seed << " step " << i;
        ASSERT_LT(cycle(), permit_.ramp_until) << "seed " << seed << " step " << i;
      }
      ASSERT_EQ(permit_.expiry, cycle() + kPermitLife);
      ASSERT_EQ(permit_.resets_handled, operator_input.resets);
      drives += drives_now ? 1 : 0;
      stops += permit_.state == SupervisorState::kStopped || permit_.state == SupervisorState::kFault ? 1 : 0;
      ramps += permit_.action == PermitAction::kRamp ? 1 : 0;
    }
  }
  // Otherwise the sequences proved nothing.
  EXPECT_GT(drives, 10000u);
  EXPECT_GT(stops, 10000u);
  EXPECT_GT(ramps, 100u);
}

}  // namespace robot_control::tests

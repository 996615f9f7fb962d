// Every cause with a fixed reaction (fixed_reactions.h) latches in its cycle, and the gate then acts.

#include "safety/latch/fixed_reactions.h"
#include "safety/monitor_fixture.h"
#include "signals/names.h"

namespace robot_control::tests {

/// The robot drives at full speed, with a heartbeat in the last cycle.
struct FixedCauses : MonitorTest, testing::WithParamInterface<FixedCause> {
  FixedCauses() {
    drive();
    steps(20);
    ++input_.operator_input.heartbeats;
    step();
  }

  static StopCause cause() { return GetParam().cause; }

  /// The fact begins with the next step. Steps until it is active; 0 if there is no such fact here.
  std::uint64_t break_it() {
    switch (cause()) {
      case kCauseEmergencyStopTopic:
        input_.operator_input.e_stop_level = 1;
        ++input_.operator_input.e_stop_triggers;
        return 1;
      case kCauseEmergencyStopService:
        ++input_.operator_input.e_stop_services;
        return 1;
      case kCauseEmergencyStopInput:
        sensors_.digital_inputs = kInputEmergencyStop;
        return 1;
      case kCauseDriverLost:
        ++sensors_.driver_instance;
        return 1;
      case kCauseDriverFault:
        sensors_.faults = kFaultDrive;
        return 1;
      case kCauseControllerLost:
        input_.command = nullptr;
        return kLoss;
      case kCauseEstimatorLost:
        input_.state = nullptr;
        return kLoss;
      case kCauseHeartbeatLost:
        return kHeartbeat + 1;
      case kCauseMonitorRestarted:
        restart_monitor();
        return 1;
      case kCauseCorruptFrame:
        input_.corrupt = true;
        return FrameConditions::kPersistence;
      case kCauseNotFinite:
        sensors_.imu.angular_velocity[1] = std::numeric_limits<double>::quiet_NaN();
        return FrameConditions::kPersistence;
      case kCauseMonitorLate:
        skip(kLoss);
        return 1;
      case kCauseCommandStale:
        fresh_state_ = false;
        return kLoss;
      case kCauseGateRefuses:
        gate_works_ = false;
        return kLoss;
      case kCauseGateDisobeys:  // it passes what has expired
        gate_obeys_ = false;
        skip(kPermitLife + 2);
        return 1;
      case kCauseLatchUnreadable:
        inherit({.causes = kCauseLatchUnreadable, .first_cause = kCauseLatchUnreadable});
        return 1;
      default:
        return 0;
    }
  }
};

TEST_P(FixedCauses, LatchInTheirCycleAndReachTheMotors) {
  if (cause() == kCauseMachineNotReady) GTEST_SKIP() << "motion is never permitted before it: machine_start_test.cpp";
  ASSERT_FALSE(braked());
  const std::uint64_t persistence = break_it();
  ASSERT_GT(persistence, 0u) << "a rule without a test";
  steps(persistence - 1);
  ASSERT_EQ(permit_.causes, 0u) << "before it had persisted";
  ASSERT_EQ(permit_.action, PermitAction::kDrive);
  step();
  ASSERT_EQ(permit_.causes, std::uint64_t{cause()});

  const bool ramp = GetParam().reaction == FixedReaction::kRamp;
  const bool fault = GetParam().reaction == FixedReaction::kFault;
  EXPECT_EQ(permit_.state, ramp    ? SupervisorState::kStopping
                           : fault ? SupervisorState::kFault
                                   : SupervisorState::kStopped);
  const std::uint64_t latched = cycle();
  const std::uint64_t deadline = permit_.ramp_until;
  EXPECT_EQ(deadline, ramp ? latched + kRamp : 0);

  gate_obeys_ = true;  // its report and its action differ
  const auto acts = [&] { return ramp ? ramps() : braked(); };
  while (!acts() && cycle() < latched + kToMotors) step();
  EXPECT_TRUE(acts());
  while (!braked() && cycle() < latched + kRamp + kToMotors) step();
  EXPECT_TRUE(braked());
  if (ramp) {
    EXPECT_EQ(cycle(), deadline + 1);
  }
  for (int i = 0; i < 100; ++i) {
    step();
    ASSERT_TRUE(braked()) << "a stop stays";
  }
}

std::string name_of_rule(const testing::TestParamInfo<FixedCause>& info) {
  return std::string(row_of(kStopCauseNames, info.param.cause)->name);
}

INSTANTIATE_TEST_SUITE_P(Every, FixedCauses, testing::ValuesIn(kFixedCauses), name_of_rule);

}  // namespace robot_control::tests

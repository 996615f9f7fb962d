// The gate acts against the permits.

#include "safety/monitor_fixture.h"
#include "support/constants.h"

namespace robot_control::tests {

/// The robot drives without a heartbeat.
struct GateConditionsTest : MonitorTest {
  GateConditionsTest() {
    begin_with(without_heartbeat());
    drive();
    steps(50);
  }
};

// The frame that it did not find in time was late.
TEST_F(GateConditionsTest, AGateThatFindsNoPermitOrNoCommandInTimeNamesWhatIsLate) {
  for (const auto& [reason, cause] :
       {std::pair{kGateNoCommand, kCauseCommandStale}, std::pair{kGatePermitExpired, kCauseMonitorLate},
        std::pair{kGateNoPermit, kCauseMonitorLate}}) {
    GateConditions conditions(kLoss, 0.001);
    ActiveCauses active;
    Permit permit;
    permit.action = PermitAction::kDrive;
    for (std::uint64_t k = 1; k < 2 * kLoss; ++k) {
      SensorFrame sensors;
      sensors.head.cycle = k;
      sensors.gate = {.cycle = k - 1, .verdict = GateVerdict::kBrake, .reasons = reason};
      active.clear();
      conditions.step(sensors, active);
      conditions.remember(permit, k);
    }
    EXPECT_EQ(active.stopping(), std::uint64_t{cause});
  }
}

// The monitor's permits expire before it notices that it is late; a gate that brakes then is right.
TEST_F(GateConditionsTest, ABrakeUnderAnExpiredPermitIsNoRefusal) {
  for (int i = 0; i < 100; ++i) {
    skip(kPermitLife + 2);
    step();
    ASSERT_FALSE(gate_passes());
  }
  EXPECT_EQ(permit_.causes, 0u);
}

TEST_F(GateConditionsTest, AGateThatPassesUnderABrakeDisobeysAndWaitsForARepair) {
  ++input_.operator_input.e_stop_services;
  step();
  steps(5);
  ASSERT_EQ(permit_.causes, std::uint64_t{kCauseEmergencyStopService});
  gate_obeys_ = false;
  step();
  EXPECT_EQ(permit_.causes, kCauseEmergencyStopService | kCauseGateDisobeys);
  EXPECT_EQ(permit_.state, SupervisorState::kFault);
}

// In the tick after the stop the gate still used the permit before it, as it should.
TEST_F(GateConditionsTest, ThePermitOnItsWayIsNoDisobedience) {
  ++input_.operator_input.e_stop_services;
  step();
  step();
  ASSERT_TRUE(gate_passes());
  steps(10);
  EXPECT_EQ(permit_.causes, std::uint64_t{kCauseEmergencyStopService});
}

TEST_F(GateConditionsTest, ThePermitsOfAnEarlierMonitorAreNotJudged) {
  restart_monitor();
  steps(10);
  EXPECT_EQ(permit_.causes, std::uint64_t{kCauseMonitorRestarted});
}

}  // namespace robot_control::tests

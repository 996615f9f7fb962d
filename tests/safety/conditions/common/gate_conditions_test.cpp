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
  /// One command in every `period` is missing for longer than a command lives.
  std::uint64_t braked_ticks_until_refused(std::uint64_t period, std::uint64_t braked, std::uint64_t patience) {
    for (std::uint64_t k = 0; k < patience; ++k) {
      gate_works_ = k % period >= braked;
      step();
      if (permit_.causes != 0) return k + 1;
    }
    return patience;
  }
};

TEST_F(GateConditionsTest, AGateThatBrakesInSpiteOfThePermitIsRefusingAfterLossCycles) {
  gate_works_ = false;
  steps(kLoss - 1);
  EXPECT_EQ(permit_.causes, 0u);
  step();
  EXPECT_EQ(permit_.causes, std::uint64_t{kCauseGateRefuses});
  EXPECT_EQ(permit_.state, SupervisorState::kStopped);
  EXPECT_EQ(permit_.evidence[0].value, static_cast<double>(kLoss));
}

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

// It brakes in 6 ticks of 10, as with a controller whose commands come every tenth cycle: more than half of 1000 after
// 833 ticks.
TEST_F(GateConditionsTest, AGateThatBrakesInMoreThanHalfOfASecondIsRefusing) {
  const std::uint64_t ticks = braked_ticks_until_refused(10, 6, 2000);
  EXPECT_EQ(permit_.causes, std::uint64_t{kCauseGateRefuses});
  EXPECT_NEAR(static_cast<double>(ticks), 501 / 0.6, 10);
}

TEST_F(GateConditionsTest, AGateThatBrakesInHalfOfTheTicksAtMostIsTolerated) {
  EXPECT_EQ(braked_ticks_until_refused(10, 5, 5000), 5000u);
}

TEST_F(GateConditionsTest, ABrakeThatTheControllerAskedForIsNoRefusal) {
  stand();
  steps(2000);
  EXPECT_EQ(permit_.causes, 0u);
}

// It may drive on with the previous frame, and counts.
TEST_F(GateConditionsTest, AGateThatRefusesFramesIsRefusing) {
  for (std::uint64_t i = 0; i < kLoss; ++i) {
    ASSERT_EQ(permit_.causes, 0u);
    ++refused_frames_;
    step();
    ASSERT_TRUE(gate_passes());
  }
  EXPECT_EQ(permit_.causes, std::uint64_t{kCauseGateRefuses});
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

TEST_F(GateConditionsTest, AGateThatPassesWhatExpiredDisobeys) {
  gate_obeys_ = false;
  steps(10);
  EXPECT_EQ(permit_.causes, 0u) << "the permits allow it";
  skip(kPermitLife + 2);
  step();
  EXPECT_EQ(permit_.causes, std::uint64_t{kCauseGateDisobeys});
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

/// Frames of a driver whose ticks all brake for want of a command, or all pass.
struct GateReports : ::testing::Test {
  std::uint64_t causes_after(std::uint64_t frame, std::uint64_t tick, GateVerdict verdict) {
    SensorFrame sensors;
    sensors.head.cycle = frame;
    sensors.gate = {.cycle = tick, .verdict = verdict, .reasons = 0, .permit_cycle = tick - 1};
    ActiveCauses out;
    conditions_.step(sensors, out);
    Permit permit;
    permit.action = PermitAction::kDrive;
    conditions_.remember(permit, frame);
    return out.with(Reaction::kBrake);
  }

  static constexpr std::uint64_t kLoss = 20;

  GateConditions conditions_{kLoss, kPeriod};
};

TEST_F(GateReports, CyclesThatTheDriverSkippedAreNoTicks) {
  for (std::uint64_t k = 10; k < 15; ++k) EXPECT_EQ(causes_after(k, k - 1, GateVerdict::kBrake), 0u);
  EXPECT_EQ(causes_after(15 + kLoss, 14, GateVerdict::kBrake), 0u);
  for (std::uint64_t k = 16 + kLoss; k < 14 + 2 * kLoss; ++k)
    EXPECT_EQ(causes_after(k, k - 1, GateVerdict::kBrake), 0u) << k;
}

TEST_F(GateReports, OfAnotherTimeThanBetweenTwoFramesDisobey) {
  for (std::uint64_t k = 10; k < 20; ++k) EXPECT_EQ(causes_after(k, k - 1, GateVerdict::kPassed), 0u);
  EXPECT_EQ(causes_after(19, 18, GateVerdict::kPassed), 0u) << "published again";
  EXPECT_EQ(causes_after(20, 18, GateVerdict::kPassed), std::uint64_t{kCauseGateDisobeys}) << "it stands still";
  EXPECT_EQ(causes_after(21, 21, GateVerdict::kPassed), std::uint64_t{kCauseGateDisobeys}) << "to come";
}

}  // namespace robot_control::tests

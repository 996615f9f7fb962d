// Tests what a start, a new run and a restart of the monitor forget, and what they keep.

#include "safety/monitor_fixture.h"
#include "signals/names.h"

namespace robot_control::tests {

struct RunTest : MonitorTest {
  void e_stop() {
    ++input_.operator_input.e_stop_services;
    step();
  }
};

// INIT.

TEST_F(RunTest, InitBrakesUnlatchedAndNamesTheMissingNode) {
  new_run();
  input_.command = nullptr;
  input_.state = nullptr;
  steps(10 * kLoss);
  EXPECT_EQ(permit_.state, SupervisorState::kInit);
  EXPECT_EQ(permit_.action, PermitAction::kBrake);
  EXPECT_EQ(permit_.causes, 0u);
  EXPECT_EQ(permit_.missing, kMissingState | kMissingCommand);
  input_.state = &state_;
  step();
  EXPECT_EQ(permit_.missing, std::uint64_t{kMissingCommand});
}

TEST_F(RunTest, StateAndCommandNeedToBeSeenInOneCycle) {
  new_run();
  input_.command = nullptr;
  step();
  input_.command = &command_;
  input_.state = nullptr;
  step();
  EXPECT_EQ(permit_.state, SupervisorState::kInit);
  EXPECT_EQ(permit_.missing, 0u);
  input_.state = &state_;
  step();
  EXPECT_EQ(permit_.state, SupervisorState::kReady);
  EXPECT_EQ(permit_.missing, 0u);
  EXPECT_EQ(permit_.since_cycle, cycle());
}

/// The driver maps a new channel up to 100 ms later than the monitor.
TEST_F(RunTest, InitWaitsForAGateThatFindsWhatTheMonitorFinds) {
  for (bool* const found : {&gate_finds_permit_, &gate_finds_command_}) {
    new_run();
    input_.command = nullptr;
    steps(3);
    input_.command = &command_;
    *found = false;
    steps(10 * kLoss);
    EXPECT_EQ(permit_.state, SupervisorState::kInit);
    EXPECT_EQ(permit_.missing, std::uint64_t{kMissingGate});
    EXPECT_EQ(permit_.causes, 0u);
    input_.command = nullptr;
    step();
    EXPECT_EQ(permit_.state, SupervisorState::kInit) << "a cycle without a command shows nothing of the gate";
    input_.command = &command_;
    *found = true;
    step();
    EXPECT_EQ(permit_.state, SupervisorState::kReady);
    *found = false;
    step();
    EXPECT_EQ(permit_.missing, 0u) << "a loss, which is a cause of a stop";
    *found = true;
  }
}

TEST_F(RunTest, AStopInInitLatches) {
  new_run();
  input_.command = nullptr;
  e_stop();
  EXPECT_EQ(permit_.state, SupervisorState::kStopped);
  EXPECT_EQ(permit_.since_cycle, 0u);
}

TEST_F(RunTest, ResetOfAStopInARunWithoutAControllerIsRefused) {
  new_run();
  input_.command = nullptr;
  e_stop();
  stand();
  EXPECT_EQ(reset(), std::uint64_t{kRefusalGap});
  EXPECT_EQ(permit_.state, SupervisorState::kStopped);
}

// A new run.

TEST_F(RunTest, ANewRunIsInitUntilAllWereSeenAgain) {
  drive();
  new_run();
  input_.command = nullptr;
  step();
  EXPECT_EQ(permit_.state, SupervisorState::kInit);
  EXPECT_EQ(permit_.since_cycle, 0u);
  EXPECT_EQ(permit_.missing, std::uint64_t{kMissingCommand});
}

TEST_F(RunTest, ANewRunNeverClearsALatch) {
  e_stop();
  new_run();
  steps(100);
  EXPECT_EQ(permit_.state, SupervisorState::kStopped);
  EXPECT_EQ(permit_.causes, std::uint64_t{kCauseEmergencyStopService});
  EXPECT_EQ(permit_.first_cause, std::uint64_t{kCauseEmergencyStopService});
  EXPECT_EQ(permit_.since_cycle, 0u);
}

TEST_F(RunTest, ANewRunNeverClearsAFaultButAResetThenDoes) {
  sensors_.faults = kFaultSimulationDiverged;
  step();
  new_run();
  sensors_.faults = 0;
  steps(kStands);
  EXPECT_EQ(permit_.state, SupervisorState::kFault);
  EXPECT_EQ(reset(), 0u);
  EXPECT_EQ(permit_.state, SupervisorState::kReady);
}

TEST_F(RunTest, ANewRunDuringTheRampIsAStop) {
  drive();
  steps(kHeartbeat + 2);
  ASSERT_EQ(permit_.state, SupervisorState::kStopping);
  new_run();
  step();
  EXPECT_EQ(permit_.state, SupervisorState::kStopped);
  EXPECT_EQ(permit_.causes, std::uint64_t{kCauseHeartbeatLost});
}

TEST_F(RunTest, ANewRunRestartsTheCounts) {
  input_.command = nullptr;
  steps(kLoss - 1);
  new_run();
  input_.command = &command_;
  step();
  input_.command = nullptr;
  steps(kLoss - 1);
  EXPECT_EQ(permit_.causes, 0u);
  step();
  EXPECT_EQ(permit_.causes, std::uint64_t{kCauseControllerLost});
}

TEST_F(RunTest, AResetRequestedBeforeANewRunIsDroppedAndAnswered) {
  e_stop();
  stand();
  request_reset();
  new_run();
  steps(20);
  EXPECT_EQ(permit_.state, SupervisorState::kStopped);
  EXPECT_EQ(permit_.resets_handled, input_.operator_input.resets);
  EXPECT_EQ(permit_.reset_refusal, std::uint64_t{kRefusalInit});
}

TEST_F(RunTest, AStopPressedBetweenTwoRunsIsNotLost) {
  ++input_.operator_input.e_stop_services;
  new_run();
  step();
  EXPECT_EQ(permit_.state, SupervisorState::kStopped);
}

TEST_F(RunTest, ALevelThatIsTrueCountsInANewRun) {
  new_run();
  input_.operator_input.e_stop_level = 1;
  step();
  EXPECT_EQ(permit_.state, SupervisorState::kStopped);
}

TEST_F(RunTest, AnInboxThatRestartedIsNoStop) {
  e_stop();
  stand();
  ASSERT_EQ(reset(), 0u);
  input_.operator_input = {};
  new_run();
  steps(5);
  EXPECT_EQ(permit_.causes, 0u);
}

TEST_F(RunTest, HeartbeatsOfTheLastRunAreNotAwaited) {
  ++input_.operator_input.heartbeats;
  step();
  new_run();
  steps(10 * kHeartbeat);
  EXPECT_EQ(permit_.state, SupervisorState::kReady);
}

// No clock shows a restart of the driver.

TEST_F(RunTest, ADriverStartedAgainIsLostHoweverSoonItIsBack) {
  drive();
  sensors_.driver_instance = 78;
  new_run();
  step();
  EXPECT_EQ(permit_.state, SupervisorState::kStopped);
  EXPECT_EQ(permit_.action, PermitAction::kBrake);
  EXPECT_EQ(permit_.causes, std::uint64_t{kCauseDriverLost});
  EXPECT_EQ(permit_.evidence[0].cause, std::uint64_t{kCauseDriverLost});
  step();
  EXPECT_EQ(permit_.active, 0u);
  EXPECT_EQ(permit_.state, SupervisorState::kStopped);
}

TEST_F(RunTest, ADriverStartedAgainIsLostWhateverItsLastWordWas) {
  sensors_.driver_state = DriverState::kPaused;
  step();
  sensors_.driver_state = DriverState::kRunning;
  sensors_.driver_instance = 78;
  new_run();
  step();
  EXPECT_EQ(permit_.causes, std::uint64_t{kCauseDriverLost});
}

TEST_F(RunTest, EachRestartOfTheDriverIsAnother) {
  for (const std::uint64_t driver_instance : {78U, 79U, 77U}) {
    sensors_.driver_instance = driver_instance;
    new_run();
    step();
    EXPECT_EQ(permit_.causes, std::uint64_t{kCauseDriverLost}) << driver_instance;
    stand();
    ASSERT_EQ(reset(), 0u) << driver_instance;
  }
}

TEST_F(RunTest, ANewRunOfTheSameDriverIsNoLoss) {
  drive();
  new_run();
  ask_for(0);
  steps(5);
  EXPECT_EQ(permit_.causes, 0u);
  EXPECT_EQ(permit_.action, PermitAction::kDrive);
}

// A restart of the monitor.

struct RestartTest : RunTest {
  void restart() {
    input_.operator_input = {};
    restart_monitor();
  }
};

TEST_F(RestartTest, BesideARunningDriverBeginsStopped) {
  drive();
  restart();
  step();
  EXPECT_EQ(permit_.state, SupervisorState::kStopped);
  EXPECT_EQ(permit_.action, PermitAction::kBrake);
  EXPECT_EQ(permit_.causes, std::uint64_t{kCauseMonitorRestarted});
  EXPECT_EQ(permit_.first_cause, std::uint64_t{kCauseMonitorRestarted});
  EXPECT_EQ(permit_.since_cycle, cycle());
  step();
  EXPECT_EQ(permit_.active, 0u);
}

TEST_F(RestartTest, KeepsWhatWasLatched) {
  drive();
  e_stop();
  restart();
  step();
  EXPECT_EQ(permit_.causes, kCauseEmergencyStopService | kCauseMonitorRestarted);
  EXPECT_EQ(permit_.first_cause, std::uint64_t{kCauseEmergencyStopService});
}

TEST_F(RestartTest, KeepsAFault) {
  sensors_.faults = kFaultLink;
  step();
  sensors_.faults = 0;
  restart();
  step();
  EXPECT_EQ(permit_.state, SupervisorState::kFault);
}

TEST_F(RestartTest, IsResetLikeAnyStop) {
  restart();
  stand();
  EXPECT_EQ(reset(), 0u);
  EXPECT_EQ(permit_.state, SupervisorState::kReady);
}

TEST_F(RestartTest, TheDriversResetInBetweenChangesNothing) {
  drive();
  restart();
  ++sensors_.head.run;
  sensors_.head.cycle = 0;
  begun_ = false;
  step();
  EXPECT_EQ(permit_.state, SupervisorState::kStopped);
}

TEST_F(RestartTest, BesideANewDriverKeepsWhatWasLatched) {
  e_stop();
  restart();
  sensors_.driver_instance = 78;
  new_run();
  steps(5);
  EXPECT_EQ(permit_.state, SupervisorState::kStopped);
  EXPECT_EQ(permit_.causes, std::uint64_t{kCauseEmergencyStopService});
  EXPECT_EQ(permit_.evidence[0].cause, std::uint64_t{kCauseEmergencyStopService});
}

TEST_F(RestartTest, BesideANewDriverBeginsInInitWhereNothingWasLatched) {
  restart();
  sensors_.driver_instance = 78;
  new_run();
  input_.command = nullptr;
  step();
  EXPECT_EQ(permit_.state, SupervisorState::kInit);
  EXPECT_EQ(permit_.causes, 0u);
  EXPECT_EQ(permit_.driver_instance, 78u);
}

TEST_F(RestartTest, WithoutItsLastPermitTheGateIsTheWitness) {
  drive();
  sensors_.gate.permit_cycle = cycle();
  monitor_ = SafetyMonitor(parameters(), robot(), kPeriod);
  step();
  EXPECT_EQ(permit_.state, SupervisorState::kStopped);
  EXPECT_EQ(permit_.causes, std::uint64_t{kCauseMonitorRestarted});
}

TEST_F(RestartTest, ATopicThatSaidTrueIsTrueUntilItsNextMessage) {
  input_.operator_input.e_stop_level = input_.operator_input.e_stop_messages = 1;
  stand();
  restart();
  stand();
  EXPECT_EQ(reset(), std::uint64_t{kRefusalCauseActive});
  input_.operator_input.e_stop_messages = 1;  // false, at last
  EXPECT_EQ(reset(), 0u);
}

TEST_F(RestartTest, ATopicThatStoppedIsTrueUntilItsNextMessageWhereNoPermitSaysOtherwise) {
  for (const std::uint64_t cause : {kCauseEmergencyStopTopic, kCauseStall}) {
    Permit first;
    const InheritedLatch latch{.causes = cause, .first_cause = cause};
    SafetyMonitor(parameters(), robot(), kPeriod).step({.inherited = &latch}, first);
    EXPECT_EQ(first.active, cause & kCauseEmergencyStopTopic);
    EXPECT_EQ(first.causes, cause);
  }
  input_.operator_input.e_stop_level = input_.operator_input.e_stop_messages = 1;
  stand();
  input_.operator_input.e_stop_level = 0;
  stand();
  restart();
  inherit({.permit = &last_permit_, .causes = permit_.causes, .first_cause = permit_.first_cause});
  step();
  EXPECT_EQ(permit_.active & kCauseEmergencyStopTopic, 0u) << "the last permit says that it was false again";
}

TEST_F(RestartTest, ATopicThatIsTrueStaysActiveWithoutSensors) {
  input_.operator_input.e_stop_level = input_.operator_input.e_stop_messages = 1;
  for (int i = 0; i < 3; ++i) {
    wait();
    EXPECT_EQ(permit_.active, std::uint64_t{kCauseEmergencyStopTopic}) << "step " << i;
  }
}

TEST_F(RestartTest, ADriverThatEndedIsMissingAndItsRunGivesNoPermit) {
  drive();
  for (int i = 0; i < 2; ++i) {
    wait(SensorSilence::kEnded);
    EXPECT_EQ(permit_.state, SupervisorState::kInit);
    EXPECT_EQ(permit_.missing, kMissingSensors | kMissingState | kMissingCommand);
    EXPECT_EQ(permit_.causes, 0u);
  }
}

TEST_F(RestartTest, ALastFrameThatIsTheFirstToReportTheEndIsAnEnd) {
  drive();
  sensors_.driver_state = DriverState::kEnded;
  step();
  EXPECT_EQ(permit_.state, SupervisorState::kInit);
  EXPECT_EQ(permit_.action, PermitAction::kBrake);
}

TEST_F(RestartTest, ARequestWithoutAFrameIsAnsweredOnce) {
  request_reset();
  for (const SensorSilence silence : {SensorSilence::kPaused, SensorSilence::kNone}) {
    wait(silence);
    EXPECT_EQ(permit_.resets_handled, input_.operator_input.resets);
    EXPECT_EQ(permit_.reset_refusal, std::uint64_t{kRefusalPaused}) << "the second step has no new request";
  }
}

TEST_F(RestartTest, ANewDriverBesideARunningMonitorClearsNothing) {
  e_stop();
  sensors_.driver_instance = 78;
  new_run();
  step();
  EXPECT_EQ(permit_.state, SupervisorState::kStopped);
}

}  // namespace robot_control::tests

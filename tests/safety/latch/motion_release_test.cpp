#include "safety/latch/motion_release.h"

#include "safety/monitor_fixture.h"

namespace robot_control::tests {

/// The healthy case is a run that was followed from cycle 0; estimator and controller computed every cycle. A motion is
/// requested since the start, and silence_needed is 100 cycles.
struct MotionReleaseTest : testing::Test {
  static constexpr std::uint64_t kSilence = 100;

  MotionReleaseTest() {
    input_.sensors = &sensors_;
    command_.silence_needed = kSilence;
    request_motion();
    steps(10);
  }

  void step(std::uint64_t elapsed = 1) {
    const std::uint64_t cycle = cycle_;
    cycle_ += elapsed;
    sensors_.head.cycle = cycle;
    command_.head.cycle = command_.state_cycle = cycle == 0 ? 0 : cycle - 1;
    command_.silent_cycles += elapsed;
    input_.command = cycle == 0 || no_command_ ? nullptr : &command_;
    input_.state = cycle > 0 ? &state_ : nullptr;
    release_.step(input_, elapsed);
  }
  void steps(std::uint64_t count) {
    for (std::uint64_t i = 0; i < count; ++i) step();
  }
  void request_motion() {
    command_.requested.twist.linear[0] = 1;
    command_.zero_requested = 0;
    command_.silent_cycles = 0;
  }
  void request_zero() {
    command_.requested.twist = {};
    command_.zero_requested = 1;
    ++command_.zero_requests;
    command_.silent_cycles = 0;
  }
  /// A message was refused; the command in force ramps to zero.
  void refuse() {
    command_.requested.twist = {};
    command_.zero_requested = 0;
    command_.silent_cycles = 0;
  }
  void restart_controller() {
    command_ = {};
    command_.silence_needed = kSilence;
    command_.first_cycle = cycle_ - 1;
  }
  /// Requests of motion do not release; a zero request after them does.
  void expect_release_by_a_new_zero_only() {
    for (int i = 0; i < 1000; ++i) {
      request_motion();
      step();
      ASSERT_FALSE(release_.released());
    }
    request_zero();
    step();
    EXPECT_TRUE(release_.released());
  }

  SensorFrame sensors_;
  CommandFrame command_;
  StateFrame state_;
  MonitorInput input_;
  MotionRelease release_;
  std::uint64_t cycle_ = 0;
  bool no_command_ = false;
};

TEST_F(MotionReleaseTest, AMotionRequestedSinceTheStartReleasesNothing) {
  for (int i = 0; i < 1000; ++i) {
    request_motion();
    step();
    ASSERT_FALSE(release_.released());
    ASSERT_EQ(release_.reset_refusal(), std::uint64_t{kRefusalCommand});
  }
}

TEST_F(MotionReleaseTest, NoPartOfARequestInForceIsSilence) {
  for (const Request& part : {Request{.twist = {.linear = {}, .angular = {0, 0, 1}}}, Request{.posture = {.roll = 0.1}},
                              Request{.mode = {ModeKind::kStand}}, Request{.joints = {0.1}}}) {
    command_.requested = part;
    steps(10 * kSilence);
    EXPECT_FALSE(release_.released());
    EXPECT_EQ(release_.reset_refusal(), std::uint64_t{kRefusalCommand});
  }
  command_.requested = {};
  step();
  EXPECT_TRUE(release_.released());
}

TEST_F(MotionReleaseTest, AZeroRequestReleasesAndMotionMayFollow) {
  request_zero();
  step();
  EXPECT_TRUE(release_.released());
  EXPECT_EQ(release_.reset_refusal(), 0u);
  request_motion();
  step();
  EXPECT_TRUE(release_.released());
  EXPECT_EQ(release_.reset_refusal(), std::uint64_t{kRefusalCommand});
}

TEST_F(MotionReleaseTest, SilenceReleasesAfterWhatItNeedsAndNotACycleEarlier) {
  refuse();
  for (std::uint64_t i = 1; i < kSilence; ++i) {
    step();
    ASSERT_FALSE(release_.released()) << i;
  }
  step();
  EXPECT_TRUE(release_.released());
  EXPECT_EQ(release_.reset_refusal(), 0u);
}

TEST_F(MotionReleaseTest, ACommandWithoutTimeoutThatIsInForceIsNoSilence) {
  steps(10 * kSilence);
  EXPECT_FALSE(release_.released());
}

TEST_F(MotionReleaseTest, RefusedMessagesAreNoSilence) {
  for (std::uint64_t i = 0; i < 10 * kSilence; ++i) {
    if (i % (kSilence / 2) == 0) refuse();
    step();
    ASSERT_FALSE(release_.released());
  }
}

TEST_F(MotionReleaseTest, AMissingCommandFrameIsNoEvidenceAndStartsTheCountAgain) {
  request_zero();
  step();
  no_command_ = true;
  step();
  EXPECT_EQ(release_.reset_refusal(), std::uint64_t{kRefusalGap});
  no_command_ = false;
  for (std::uint64_t i = 0; i < kSilence; ++i) {
    step();
    ASSERT_EQ(release_.reset_refusal(), std::uint64_t{kRefusalGap}) << i;
  }
  step();
  EXPECT_EQ(release_.reset_refusal(), 0u);
}

TEST_F(MotionReleaseTest, AZeroRequestAfterAMissingFrameIsEvidenceAtOnce) {
  no_command_ = true;
  steps(5);
  no_command_ = false;
  refuse();
  step();
  request_zero();
  step();
  EXPECT_EQ(release_.reset_refusal(), 0u);
}

TEST_F(MotionReleaseTest, CyclesThatWereNotLookedAtAreAGap) {
  request_zero();
  step();
  step(2);
  step();
  EXPECT_EQ(release_.reset_refusal(), std::uint64_t{kRefusalGap});
  steps(kSilence - 3);
  EXPECT_EQ(release_.reset_refusal(), std::uint64_t{kRefusalGap});
  step();
  EXPECT_EQ(release_.reset_refusal(), 0u) << "silence counts from the last of them";
}

TEST_F(MotionReleaseTest, ACommandFromAnOldStateIsNoEvidence) {
  request_zero();
  step();
  ASSERT_EQ(release_.reset_refusal(), 0u);
  sensors_.head.cycle = cycle_;
  command_.head.cycle = cycle_ - 1;  // computed from the state of the cycle before
  release_.step(input_, 1);
  EXPECT_EQ(release_.reset_refusal(), std::uint64_t{kRefusalGap});
}

TEST_F(MotionReleaseTest, ARestartedControllerTakesTheReleaseBack) {
  request_zero();
  steps(10 * kSilence);
  restart_controller();
  request_motion();
  step();
  EXPECT_FALSE(release_.released());
  request_zero();
  step();
  EXPECT_TRUE(release_.released());
}

TEST_F(MotionReleaseTest, ARestartedEstimatorTakesTheReleaseBackAndOlderZerosDoNotCount) {
  request_zero();
  steps(5);
  request_motion();
  state_.first_cycle = cycle_ - 1;
  expect_release_by_a_new_zero_only();
}

TEST_F(MotionReleaseTest, ANewMonitorHasSeenNoStartAndNoEvidence) {
  const MotionRelease release;
  EXPECT_EQ(release.starts(), 0u);
  EXPECT_FALSE(release.released());
  EXPECT_EQ(release.reset_refusal(), std::uint64_t{kRefusalGap});
}

TEST_F(MotionReleaseTest, ANewRunIsAStartAndTakesTheReleaseBack) {
  request_zero();
  step();
  const std::uint64_t starts = release_.starts();
  release_.enter_run();
  EXPECT_EQ(release_.starts(), starts + 1);
  cycle_ = 0;
  command_.zero_requests = 0;
  request_motion();
  steps(1000);
  EXPECT_FALSE(release_.released());
}

TEST_F(MotionReleaseTest, ARunThatBeginsWithAZeroIsReleasedWithTheFirstCommandFrame) {
  release_.enter_run();
  cycle_ = 0;
  command_.zero_requests = 1;  // and a motion in the same cycle
  request_motion();
  steps(2);
  EXPECT_TRUE(release_.released());
}

TEST_F(MotionReleaseTest, AMonitorThatStartsInAGoingRunDoesNotCountOlderZeros) {
  request_zero();
  step();
  request_motion();
  release_.enter_run();
  expect_release_by_a_new_zero_only();
}

TEST_F(MotionReleaseTest, TheEndOfAPauseIsAStart) {
  request_zero();
  step();
  ASSERT_TRUE(release_.released());
  ++sensors_.resumes;
  request_motion();
  step();
  EXPECT_FALSE(release_.released());
  expect_release_by_a_new_zero_only();
}

TEST_F(MotionReleaseTest, SilenceBeforeAPauseDoesNotCountAfterIt) {
  request_zero();
  steps(10 * kSilence);
  command_.zero_requested = 0;
  ++sensors_.resumes;
  steps(kSilence);
  EXPECT_FALSE(release_.released());
  steps(2);
  EXPECT_TRUE(release_.released());
}

TEST_F(MotionReleaseTest, SilenceBeforeTheFirstCycleThatTheMonitorSeesDoesNotCount) {
  release_.enter_run();
  command_.requested.twist = {};
  command_.silent_cycles = 10 * kSilence;
  ++sensors_.resumes;
  steps(kSilence);
  EXPECT_FALSE(release_.released());
  steps(2);
  EXPECT_TRUE(release_.released());
}

// Through the monitor.

TEST_F(MonitorTest, CountsStopsAndStarts) {
  const std::uint64_t before = permit_.withdrawals;
  drive();
  EXPECT_EQ(permit_.withdrawals, before);
  ++input_.operator_input.e_stop_services;
  step();
  ++input_.operator_input.e_stop_services;
  step();
  EXPECT_EQ(permit_.withdrawals, before + 1) << "a cause that is latched already";
  ++input_.operator_input.e_stop_triggers;
  step();
  EXPECT_EQ(permit_.withdrawals, before + 2) << "another cause in the same stop";
  stand();
  ASSERT_EQ(reset(), 0u);
  EXPECT_EQ(permit_.withdrawals, before + 2) << "the release";
  ++sensors_.resumes;
  ask_for(1);
  step();
  EXPECT_EQ(permit_.state, SupervisorState::kInit);
  EXPECT_EQ(permit_.withdrawals, before + 3);
  ++sensors_.resumes;
  step();
  EXPECT_EQ(permit_.withdrawals, before + 4) << "in INIT, too";
  stand();
  const std::uint64_t in_run = permit_.withdrawals;
  new_run();
  step();
  EXPECT_GT(permit_.withdrawals, in_run);
}

TEST_F(MonitorTest, ARestartOfTheMonitorIsAWithdrawal) {
  drive();
  restart_monitor();
  step();
  EXPECT_GT(permit_.withdrawals, last_permit_.withdrawals);
}

TEST_F(MonitorTest, AtAColdStartNothingMovesBeforeAZeroRequest) {
  new_run();
  for (int i = 0; i < 5000; ++i) {
    ask_for(1);
    step();
    ASSERT_EQ(permit_.action, PermitAction::kBrake);
    ASSERT_EQ(permit_.causes, 0u);
  }
  EXPECT_EQ(permit_.state, SupervisorState::kInit);
  EXPECT_EQ(permit_.unreleased, 1u);
  ask_for(0);
  step();
  step();
  EXPECT_EQ(permit_.state, SupervisorState::kReady);
  EXPECT_EQ(permit_.unreleased, 0u);
}

TEST_F(MonitorTest, ARestartedEstimatorBrakesWithoutALatchUntilAZeroRequest) {
  drive();
  state_.first_cycle = cycle();
  step();
  EXPECT_EQ(permit_.state, SupervisorState::kInit);
  EXPECT_EQ(permit_.action, PermitAction::kBrake);
  EXPECT_EQ(permit_.causes, 0u);
  stand();
  EXPECT_EQ(permit_.state, SupervisorState::kReady);
}

TEST_F(MonitorTest, ARestartDuringTheRampBrakes) {
  drive();
  ++input_.operator_input.heartbeats;
  steps(kHeartbeat + 2);
  ASSERT_EQ(permit_.state, SupervisorState::kStopping);
  command_.first_cycle = cycle();
  command_.zero_requests = 0;
  step();
  EXPECT_EQ(permit_.state, SupervisorState::kStopped);
  EXPECT_EQ(permit_.action, PermitAction::kBrake);
}

TEST_F(MonitorTest, AResetInACycleWithoutACommandFrameIsRefused) {
  drive();
  ++input_.operator_input.e_stop_services;
  step();
  ask_for(1);
  turn_wheels(0);
  steps(kStands);
  input_.command = nullptr;
  EXPECT_EQ(reset(), std::uint64_t{kRefusalGap});
  input_.command = &command_;
  EXPECT_EQ(permit_.state, SupervisorState::kStopped);
}

}  // namespace robot_control::tests

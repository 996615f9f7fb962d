#include <gtest/gtest.h>

#include "cycle_fixture.h"
#include "support/allocation_guard.h"

namespace robot_control {
namespace {

/// A loop in DRIVE with a standing command.
class RunningLoop : public ::testing::Test {
 protected:
  RunningLoop() {
    loop.step();  // a command from before the run would be dropped
    loop.controller->inbox().store({.content = {.twist = kAhead}, .count = 1});
    loop.steps(20);
  }

  Loop loop;
};

TEST_F(RunningLoop, PassesACommandExactlyOneCycleAfterItsSensors) {
  ASSERT_EQ(loop.gate().verdict, GateVerdict::kPassed);
  EXPECT_EQ(loop.gate().command_cycle, loop.driver.next_cycle() - 2);
  EXPECT_EQ(loop.gate().permit_cycle, loop.driver.next_cycle() - 2);
  EXPECT_EQ(loop.machine.mode, JointMode::kEffort);
}

/// In one thread a frame stays where its writer has put it (bus/latest_frames.h).
TEST(DriverCycleInOneThread, UsesThePermitAndTheCommandOfItsWriters) {
  StandingMachine machine;
  const TestChannel<SensorFrame> sensors;
  const TestChannel<TruthFrame> truth;
  const TestChannel<CommandFrame> command;
  const TestChannel<Permit> permit;
  const auto own_command = std::make_unique<OwnFrames<CommandFrame>>();
  const auto own_permit = std::make_unique<OwnFrames<Permit>>();
  FrameWriter<CommandFrame> commands(command.memory.get(), own_command.get());
  FrameWriter<Permit> permits(permit.memory.get(), own_permit.get());
  const auto commands_read = commands.reader();
  const auto permits_read = permits.reader();
  DriverCycle driver{
      machine, two_wheels(), {sensors.writer, truth.writer, &commands_read, &permits_read}, kPeriodNs, nullptr};
  driver.begin_run(1);
  driver.step();
  CommandFrame wanted;
  Permit allowed;
  wanted.head.run = allowed.head.run = 1;
  commands.publish(wanted);
  permits.publish(allowed);
  driver.step();
  EXPECT_NE(wanted.head.checksum, 0u);
  EXPECT_EQ(driver.trace().calls.command.checksum, wanted.head.checksum);
  EXPECT_EQ(driver.trace().calls.permit.checksum, allowed.head.checksum);
}

TEST_F(RunningLoop, HoldsTheLastCommandForThreeMissedCyclesThenBrakes) {
  for (int missed = 1; missed <= 3; ++missed) {
    loop.driver.step();
    loop.estimator->step();
    loop.monitor->step();
  }
  // the first tick without the controller still found the command of the cycle before
  loop.driver.step();
  EXPECT_EQ(loop.gate().verdict, GateVerdict::kHeld);
  EXPECT_EQ(loop.gate().held, 3u);
  loop.estimator->step();
  loop.monitor->step();
  loop.driver.step();
  EXPECT_EQ(loop.gate().verdict, GateVerdict::kBrake);
  EXPECT_EQ(loop.gate().reasons & kGateNoCommand, kGateNoCommand);
}

TEST_F(RunningLoop, BrakesWhenTheMonitorStops) {
  for (std::uint64_t tick = 0; tick <= kPermitLife; ++tick) {
    loop.driver.step();
    loop.estimator->step();
    loop.controller->step();
  }
  EXPECT_EQ(loop.gate().verdict, GateVerdict::kBrake);
  EXPECT_NE(loop.gate().reasons & kGatePermitExpired, 0u) << "there was a permit, and it is distinguished from none";
  EXPECT_EQ(loop.machine.mode, JointMode::kBrake);
}

TEST_F(RunningLoop, LatchesTheLossOfTheController) {
  for (int tick = 0; tick < 25; ++tick) {
    loop.driver.step();
    loop.estimator->step();
    loop.monitor->step();
  }
  EXPECT_EQ(loop.newest_permit().state, SupervisorState::kStopped);
  EXPECT_NE(loop.newest_permit().causes & kCauseControllerLost, 0u);
  loop.restart_controller();
  loop.steps(5);
  EXPECT_EQ(loop.newest_permit().state, SupervisorState::kStopped) << "a stop latches";
}

// On hardware the last tick before the gap used a permit that is long expired when its report is read.
TEST_F(RunningLoop, ADriverThatSkipsCyclesIsNoDisobedience) {
  for (std::uint64_t skipped = 1; skipped < 19; ++skipped) {
    loop.driver.skip(skipped);
    loop.steps(20);
    EXPECT_EQ(loop.newest_permit().causes, 0u) << skipped;
    EXPECT_EQ(loop.gate().verdict, GateVerdict::kPassed);
  }
}

TEST_F(RunningLoop, ResumesTheEstimateAfterARestart) {
  const StateFrame before = loop.newest_state();
  loop.restart_estimator();
  loop.step();
  const StateFrame after = loop.newest_state();
  EXPECT_EQ(after.base.pose_odom.position, before.base.pose_odom.position);
  EXPECT_NE(after.base.flags & kStateRestarted, 0u);
  EXPECT_GT(after.base.pose_covariance[0], before.base.pose_covariance[0]);
}

TEST_F(RunningLoop, StopsWhenTheMonitorIsRestarted) {
  loop.restart_monitor();
  loop.step();
  EXPECT_EQ(loop.newest_permit().state, SupervisorState::kStopped);
  EXPECT_NE(loop.newest_permit().causes & kCauseMonitorRestarted, 0u);
}

TEST_F(RunningLoop, BeginsInInitWhenDriverAndMonitorBothRestart) {
  loop.driver.set_driver_instance(100);
  loop.driver.begin_run(2);
  loop.restart_monitor();
  loop.step();
  EXPECT_EQ(loop.newest_permit().state, SupervisorState::kInit);
  loop.steps(3);
  EXPECT_EQ(loop.newest_permit().action, PermitAction::kDrive);
}

TEST_F(RunningLoop, ForgetsTheCommandInANewRun) {
  loop.driver.begin_run(2);
  loop.steps(3);
  EXPECT_NE(loop.newest_command().reasons & kReasonNoCommand, 0u);
  EXPECT_EQ(loop.newest_command().requests_received, 0u);
}

TEST_F(RunningLoop, TakesAgeAndRefusalsFromTheInbox) {
  VelocityCommand command{.content = {.twist = kAhead}, .count = 2};
  command.age_ns = 1'249 * kPeriodNs;  // of the default timeout's 1250
  loop.controller->inbox().store(command);
  loop.steps(2);
  EXPECT_EQ(loop.newest_command().reasons & kReasonTimedOut, 0u);
  loop.step();
  EXPECT_NE(loop.newest_command().reasons & kReasonTimedOut, 0u);
  command.stale = 3;
  command.crowded = 4;
  command.revoked = 5;
  command.many_senders = 1;
  loop.controller->inbox().store(command);
  loop.step();
  EXPECT_NE(loop.newest_command().reasons & kReasonStale, 0u);
  EXPECT_NE(loop.newest_command().reasons & kReasonManySenders, 0u);
  EXPECT_EQ(loop.newest_command().requests_refused, 12u);
  loop.driver.begin_run(2);
  loop.steps(3);
  EXPECT_EQ(loop.newest_command().requests_refused, 0u);
}

TEST_F(RunningLoop, KeepsALatchInANewRun) {
  loop.monitor->inbox().store({.e_stop_services = 1});
  loop.steps(2);
  ASSERT_EQ(loop.newest_permit().state, SupervisorState::kStopped);
  loop.driver.begin_run(2);
  loop.steps(5);
  EXPECT_EQ(loop.newest_permit().state, SupervisorState::kStopped);
  EXPECT_EQ(loop.gate().verdict, GateVerdict::kBrake);
}

TEST_F(RunningLoop, ProcessesAFrameOnlyOnce) {
  EXPECT_FALSE(loop.estimator->step());
  EXPECT_FALSE(loop.controller->step());
  EXPECT_FALSE(loop.monitor->step());
}

TEST_F(RunningLoop, IgnoresFramesOfAnotherRun) {
  const std::uint64_t cycle = loop.driver.next_cycle() - 1;
  CommandFrame foreign = loop.newest_command();
  foreign.head.run = 12345;
  loop.command.writer.publish(foreign);
  loop.driver.step();
  EXPECT_EQ(loop.gate().verdict, GateVerdict::kHeld) << "cycle " << cycle << " was overwritten by a foreign run";
  EXPECT_EQ(loop.gate().command_cycle, cycle - 1);
}

TEST_F(RunningLoop, BrakesOnACommandWhoseChecksumIsWrong) {
  CommandFrame broken = loop.newest_command();
  broken.joints[0].effort += 1;
  loop.command.writer.store(broken);
  loop.driver.step();
  EXPECT_EQ(loop.gate().verdict, GateVerdict::kBrake);
  EXPECT_NE(loop.gate().reasons & kGateChecksum, 0u);
}

TEST_F(RunningLoop, IgnoresSensorsOfAnotherRobot) {
  loop.sensors.memory->head.robot_hash.store(8);
  loop.driver.step();
  EXPECT_FALSE(loop.estimator->step());
  EXPECT_FALSE(loop.monitor->step());
}

TEST_F(RunningLoop, AnswersATokenOfAStateWithATokenOfACommand) {
  loop.driver.step();
  const FrameHead head = loop.driver.trace().sensors.head;
  loop.state.writer.publish_token(head);
  CommandFrame command;
  EXPECT_FALSE(loop.controller->step());
  EXPECT_EQ(loop.command.reader.at(head.run, head.cycle, command), Lookup::kToken);
}

TEST_F(RunningLoop, CountsATokenAsAMissingCommand) {
  loop.driver.step();
  loop.estimator->step();
  loop.monitor->step();
  loop.command.writer.publish_token(loop.driver.trace().sensors.head);
  loop.driver.step();
  EXPECT_EQ(loop.gate().verdict, GateVerdict::kHeld);
}

TEST_F(RunningLoop, LatchesTheLossOfTheDriverOnceItIsSilent) {
  loop.monitor->time_out();
  EXPECT_NE(loop.newest_permit().causes & kCauseDriverLost, 0u);
  loop.steps(5);
  EXPECT_EQ(loop.newest_permit().state, SupervisorState::kStopped);
}

TEST_F(RunningLoop, LatchesTheLossOfADriverThatIsBackBeforeItsSilenceIsNoticed) {
  loop.driver.set_driver_instance(100);
  loop.driver.begin_run(2);
  loop.steps(5);
  EXPECT_EQ(loop.newest_permit().state, SupervisorState::kStopped);
  EXPECT_EQ(loop.newest_permit().causes, std::uint64_t{kCauseDriverLost});
  EXPECT_EQ(loop.gate().verdict, GateVerdict::kBrake);
}

TEST_F(RunningLoop, AResetAskedForDuringSilenceReleasesNothingLater) {
  loop.controller->inbox().store({.content = {}, .count = 2});
  loop.steps(20);
  loop.monitor->time_out();
  loop.monitor->inbox().store({.resets = 1});
  loop.monitor->time_out();
  EXPECT_EQ(loop.newest_permit().resets_handled, 1u);
  EXPECT_EQ(loop.newest_permit().reset_refusal, std::uint64_t{kRefusalSilent});
  loop.steps(20);
  EXPECT_EQ(loop.newest_permit().state, SupervisorState::kStopped);
}

TEST_F(RunningLoop, HandsEachResetOfTheOperatorToTheDriverButNoRestartOfTheMonitor) {
  loop.monitor->inbox().store({.resets = 1});
  loop.steps(3);
  EXPECT_EQ(loop.machine.resets, 1);
  loop.restart_monitor();
  loop.steps(3);
  EXPECT_EQ(loop.machine.resets, 1);
  loop.monitor->inbox().store({.resets = 1});
  loop.steps(3);
  EXPECT_EQ(loop.machine.resets, 2);
}

TEST_F(RunningLoop, AnswersAResetWhileTimeStandsStill) {
  loop.monitor->idle();
  loop.monitor->inbox().store({.resets = 1});
  loop.monitor->idle();
  EXPECT_EQ(loop.newest_permit().reset_refusal, std::uint64_t{kRefusalSilent});
  loop.step();
  EXPECT_EQ(loop.newest_permit().state, SupervisorState::kDrive) << "and nothing was lost";
}

TEST_F(RunningLoop, StopsOnSensorsThatStayCorrupt) {
  for (int frame = 0; frame < 3; ++frame) {
    SensorFrame broken;
    loop.driver.step();
    loop.sensors.reader.newest(broken);
    broken.imu.linear_acceleration[0] += 1;
    loop.sensors.writer.store(broken);
    EXPECT_EQ(loop.monitor->step(), frame == 2) << "the stop has a row";
  }
  EXPECT_NE(loop.newest_permit().causes & kCauseCorruptFrame, 0u);
  EXPECT_EQ(loop.newest_permit().action, PermitAction::kBrake);
}

TEST_F(RunningLoop, StopsAfterAHangOfTheMonitor) {
  for (int tick = 0; tick < 30; ++tick) {
    loop.driver.step();
    loop.estimator->step();
    loop.controller->step();
  }
  loop.steps(2);
  EXPECT_NE(loop.newest_permit().causes & kCauseMonitorLate, 0u);
  EXPECT_EQ(loop.newest_permit().state, SupervisorState::kStopped);
}

TEST_F(RunningLoop, HoldsTheCommandOverCyclesThatHardwareMissed) {
  loop.driver.skip(2);
  loop.step();
  EXPECT_EQ(loop.gate().verdict, GateVerdict::kHeld);
  EXPECT_EQ(loop.newest_state().skipped, 2u);
  loop.steps(2);
  EXPECT_EQ(loop.gate().verdict, GateVerdict::kPassed);
}

TEST_F(RunningLoop, NeverAllocates) {
  const AllocationGuard guard;
  loop.steps(100);
  EXPECT_EQ(guard.count(), 0u);
}

TEST(FirstCycles, BrakeUntilEveryNodeWasSeen) {
  Loop loop;
  loop.step();
  EXPECT_EQ(loop.gate().verdict, GateVerdict::kBrake);
  EXPECT_EQ(loop.gate().reasons & kGateFirstTick, kGateFirstTick);
  EXPECT_EQ(loop.newest_permit().state, SupervisorState::kInit);
  EXPECT_EQ(loop.newest_permit().missing, kMissingState | kMissingCommand);
  loop.step();
  EXPECT_EQ(loop.newest_permit().state, SupervisorState::kReady);
}

TEST(FirstCycles, NameTheNodeThatIsMissing) {
  Loop loop;
  for (int tick = 0; tick < 50; ++tick) {
    loop.driver.step();
    loop.estimator->step();
    loop.monitor->step();
  }
  EXPECT_EQ(loop.newest_permit().state, SupervisorState::kInit);
  EXPECT_EQ(loop.newest_permit().missing, kMissingCommand);
  EXPECT_EQ(loop.newest_permit().causes, 0u) << "nothing latches before the loop was closed";
}

}  // namespace
}  // namespace robot_control

#include <gtest/gtest.h>

#include "cycle_fixture.h"
#include "support/allocation_guard.h"

namespace robot_control::tests {

/// A loop in DRIVE with a standing command.
struct RunningLoop : ::testing::Test {
  RunningLoop() { loop.drive(); }

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
  const TestChannels channels;
  const auto own_command = std::make_unique<OwnFrames<CommandFrame>>();
  const auto own_permit = std::make_unique<OwnFrames<Permit>>();
  FrameWriter<CommandFrame> commands(channels.command.memory.get(), own_command.get());
  FrameWriter<Permit> permits(channels.permit.memory.get(), own_permit.get());
  own_command->seal_all();
  own_permit->seal_all();
  const auto commands_read = commands.reader();
  const auto permits_read = permits.reader();
  DriverCycle driver{machine,
                     two_wheels(),
                     {channels.sensors.writer, channels.truth.writer, &commands_read, &permits_read},
                     kPeriodNs,
                     nullptr};
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

// On hardware the last tick before the gap used a permit that is long expired when its report is read.
TEST_F(RunningLoop, ADriverThatSkipsCyclesIsNoDisobedience) {
  for (std::uint64_t skipped = 1; skipped < 19; ++skipped) {
    loop.driver.skip(skipped);
    loop.steps(20);
    EXPECT_EQ(loop.newest_permit().causes, 0u) << skipped;
    EXPECT_EQ(loop.gate().verdict, GateVerdict::kPassed);
  }
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

}  // namespace robot_control::tests

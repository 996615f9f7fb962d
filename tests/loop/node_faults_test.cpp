/// Faults are injected into estimator, controller and monitor: the tests check their output, and the reaction of the
/// other nodes.

#include <gtest/gtest.h>

#include <bit>

#include "cycle_fixture.h"
#include "signals/names.h"
#include "support/allocation_guard.h"

namespace robot_control::tests {

constexpr FaultComponent kNodes[]{FaultComponent::kController, FaultComponent::kEstimator, FaultComponent::kMonitor};

/// A loop in DRIVE whose controller pushes ever harder at wheels that never turn.
struct NodeFaults : ::testing::Test {
  NodeFaults() { loop.drive(); }

  static void inject(Loop& any, FaultComponent component, FaultKind kind) {
    InjectedFaults faults = any.machine.faults;
    set_fault(faults, {.component = component, .kind = kind});
    any.machine.inject(faults);
  }
  void inject(FaultComponent component, FaultKind kind) { inject(loop, component, kind); }

  /// Steps once; returns the node's published output of that cycle.
  Lookup publishes(FaultComponent component) {
    loop.step();
    const std::uint64_t cycle = loop.driver.next_cycle() - 1;
    if (component == FaultComponent::kController) return loop.command.reader.at(1, cycle, command_);
    if (component == FaultComponent::kEstimator) return loop.state.reader.at(1, cycle, state_);
    return loop.permit.reader.at(1, cycle, permit_);
  }

  static double effort(const CommandFrame& command) { return command.joints[0].effort; }

  /// Cycles until the gate brakes; limit + 1 if it never does.
  int cycles_until_brake(int limit) {
    for (int cycles = 1; cycles <= limit; ++cycles) {
      loop.step();
      if (loop.gate().verdict == GateVerdict::kBrake) return cycles;
    }
    return limit + 1;
  }

  Loop loop;
  CommandFrame command_;
  StateFrame state_;
  Permit permit_;
};

TEST(NodesOfTheRobot, PublishTheSameFramesWhateverIsInjected) {
  Loop healthy;
  Loop injected;
  for (std::size_t i = 0; i < kFaultComponents; ++i) {
    set_fault(injected.machine.faults, {.component = static_cast<FaultComponent>(i), .kind = FaultKind::kGarbage});
  }
  for (int i = 0; i < 100; ++i) {
    for (Loop* any : {&healthy, &injected}) {
      any->driver.step();
      any->estimator->step();
      any->controller->step();
      any->monitor->step();
      if (i == 0) any->controller->inbox().store({.content = {.twist = kAhead}, .count = 1});
    }
    EXPECT_EQ(healthy.newest_state().head.checksum, injected.newest_state().head.checksum) << i;
    EXPECT_EQ(healthy.newest_command().head.checksum, injected.newest_command().head.checksum) << i;
    EXPECT_EQ(healthy.newest_permit().head.checksum, injected.newest_permit().head.checksum) << i;
  }
  EXPECT_EQ(healthy.newest_permit().action, PermitAction::kDrive) << "or nothing was shown";
}

TEST_F(NodeFaults, OffIsATokenInEveryCycle) {
  for (const FaultComponent node : kNodes) {
    inject(node, FaultKind::kOff);
    for (int i = 0; i < 30; ++i) EXPECT_EQ(publishes(node), Lookup::kToken) << name_of(node);
    inject(node, FaultKind::kOk);
    EXPECT_EQ(publishes(node), Lookup::kFrame) << name_of(node);
  }
}

TEST_F(NodeFaults, StuckIsOldContentUnderANewHead) {
  inject(FaultComponent::kController, FaultKind::kStuck);
  ASSERT_EQ(publishes(FaultComponent::kController), Lookup::kFrame);
  const CommandFrame first = command_;
  for (std::uint64_t i = 1; i <= 15; ++i) {
    ASSERT_EQ(publishes(FaultComponent::kController), Lookup::kFrame);
    EXPECT_EQ(command_.head.cycle, first.head.cycle + i);
    EXPECT_EQ(effort(command_), effort(first));
    EXPECT_EQ(command_.state_cycle, first.state_cycle);
  }
}

TEST_F(NodeFaults, AWrongControllerTurnsEveryEffortRound) {
  Loop healthy;
  healthy.drive();
  inject(FaultComponent::kController, FaultKind::kWrong);
  for (int i = 0; i < 20; ++i) {
    healthy.step();
    ASSERT_EQ(publishes(FaultComponent::kController), Lookup::kFrame);
    EXPECT_EQ(effort(command_), -effort(healthy.newest_command()));
    EXPECT_NE(effort(command_), 0);
  }
}

TEST_F(NodeFaults, AWrongEstimatorMirrorsTheMotion) {
  state_.base.pose_odom.position = {1, 2, 0};
  state_.base.twist_base = {.linear = {0.5, 0, 0}, .angular = {0, 0, 0.2}};
  FaultRandom random;
  distort(FaultKind::kWrong, state_, random);
  EXPECT_EQ(state_.base.pose_odom.position, (Vector3{-1, -2, 0}));
  EXPECT_EQ(state_.base.twist_base.linear, (Vector3{-0.5, 0, 0}));
  EXPECT_EQ(state_.base.twist_base.angular, (Vector3{0, 0, -0.2}));
}

TEST_F(NodeFaults, AWrongMonitorBrakesARobotThatMayDrive) {
  inject(FaultComponent::kMonitor, FaultKind::kWrong);
  ASSERT_EQ(publishes(FaultComponent::kMonitor), Lookup::kFrame);
  EXPECT_EQ(permit_.action, PermitAction::kBrake);
  loop.step();
  EXPECT_EQ(loop.gate().verdict, GateVerdict::kBrake);
}

TEST_F(NodeFaults, GarbageIsBrokenUnboundedOrRandom) {
  inject(FaultComponent::kController, FaultKind::kGarbage);
  constexpr int kCycles = 2000;
  int broken = 0, not_finite = 0, finite_ones = 0;
  for (int i = 0; i < kCycles; ++i) {
    const Lookup found = publishes(FaultComponent::kController);
    broken += found == Lookup::kCorrupt ? 1 : 0;
    if (found != Lookup::kFrame) continue;
    (finite(command_.joints[0]) ? finite_ones : not_finite) += 1;
  }
  // Binomial with p = 1/4: deviation √(np(1 − p)) = 19; five of them.
  EXPECT_NEAR(broken, kCycles / 4, 97);
  EXPECT_GT(not_finite, 0);
  EXPECT_GT(finite_ones, 0);
}

TEST_F(NodeFaults, RestartInANewRun) {
  Loop other;
  inject(FaultComponent::kController, FaultKind::kGarbage);
  loop.steps(50);
  inject(other, FaultComponent::kController, FaultKind::kGarbage);
  loop.driver.begin_run(2);
  other.driver.begin_run(2);
  for (int i = 0; i < 50; ++i) {
    loop.step();
    other.step();
    const CommandFrame one = loop.newest_command(), two = other.newest_command();
    EXPECT_EQ(std::bit_cast<std::uint64_t>(effort(one)), std::bit_cast<std::uint64_t>(effort(two))) << i;
  }
}

TEST_F(NodeFaults, ACorruptStateCostsTheCommandButNotTheCycle) {
  inject(FaultComponent::kEstimator, FaultKind::kGarbage);
  int corrupt = 0;
  for (int i = 0; i < 100; ++i) {
    const Lookup state = publishes(FaultComponent::kEstimator);
    const Lookup command = loop.command.reader.at(1, loop.driver.next_cycle() - 1, command_);
    EXPECT_EQ(command, state == Lookup::kCorrupt ? Lookup::kToken : Lookup::kFrame);
    corrupt += state == Lookup::kCorrupt ? 1 : 0;
  }
  EXPECT_GT(corrupt, 0);
}

// The cause of the stop, and the time until it.

TEST_F(NodeFaults, TheGateHoldsThreeCyclesThenBrakesForAControllerThatIsOffAndTheMonitorLatches) {
  inject(FaultComponent::kController, FaultKind::kOff);
  EXPECT_EQ(cycles_until_brake(50), 5) << "one on time, three held";
  loop.steps(static_cast<int>(SafetyParameters{}.loss_cycles));
  EXPECT_NE(loop.newest_permit().causes & kCauseControllerLost, 0u);
  inject(FaultComponent::kController, FaultKind::kOk);
  loop.steps(50);
  EXPECT_EQ(loop.newest_permit().state, SupervisorState::kStopped) << "until a reset";
}

TEST_F(NodeFaults, ThePermitOfAMonitorThatIsStuckExpires) {
  inject(FaultComponent::kMonitor, FaultKind::kStuck);
  EXPECT_EQ(cycles_until_brake(50), static_cast<int>(kPermitLife) + 2) << "the frame of the first cycle is healthy";
  loop.steps(100);
  EXPECT_EQ(loop.gate().verdict, GateVerdict::kBrake);
  EXPECT_NE(loop.gate().reasons & kGatePermitExpired, 0u) << "a fresh head does not prolong it";
}

TEST_F(NodeFaults, NeverAllocate) {
  const AllocationGuard guard;
  for (const FaultComponent node : kNodes) {
    for (std::size_t kind = 0; kind < kFaultKinds; ++kind) {
      inject(node, static_cast<FaultKind>(kind));
      loop.steps(50);
    }
    inject(node, FaultKind::kOk);
  }
  EXPECT_EQ(guard.count(), 0u);
}

}  // namespace robot_control::tests

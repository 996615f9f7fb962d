/// The rows record the calls on each law (signals/law_calls.h). The tests of the folder replay show that they are
/// complete, because a replay runs the laws again from them.

#include <gtest/gtest.h>

#include "cycle_fixture.h"
#include "signals/names.h"

namespace robot_control::tests {

struct LawCalls : testing::Test {
  LawCalls() { loop.steps(10); }

  const GateCalls& gate() const { return loop.driver.trace().calls; }
  const EstimatorCalls& estimator() const { return loop.estimator->trace().calls; }
  const ControllerCalls& controller() const { return loop.controller->trace().calls; }
  const MonitorCalls& monitor() const { return loop.monitor->trace().calls; }

  Loop loop;
};

TEST_F(LawCalls, NameTheFramesThatWereUsed) {
  const std::uint64_t sensors = loop.driver.trace().sensors.head.checksum;
  EXPECT_EQ(gate().law.sensors, sensors);
  EXPECT_EQ(estimator().law.sensors, sensors);
  EXPECT_EQ(controller().law.sensors, sensors);
  EXPECT_EQ(monitor().law.sensors, sensors);
  EXPECT_EQ(controller().state, loop.newest_state().head.checksum);
  const std::uint64_t command = loop.newest_command().head.checksum;
  const Permit permit = loop.newest_permit();
  loop.step();
  EXPECT_EQ(gate().command.checksum, command);
  EXPECT_EQ(monitor().command.checksum, command);
  EXPECT_EQ(gate().permit.checksum, permit.head.checksum);
  EXPECT_EQ(controller().permit.checksum, permit.head.checksum);
  EXPECT_EQ(controller().permit.cycle, permit.head.cycle);
}

TEST_F(LawCalls, GiveTheOutputOfAHealthyNode) {
  EXPECT_EQ(estimator().law.output, loop.newest_state().head.checksum);
  EXPECT_EQ(controller().law.output, loop.newest_command().head.checksum);
  EXPECT_EQ(monitor().law.output, loop.newest_permit().head.checksum);
}

TEST_F(LawCalls, GiveTheOutputBeforeAFaultChangesIt) {
  loop.machine.faults = {};
  set_fault(loop.machine.faults, {.component = FaultComponent::kController, .kind = FaultKind::kWrong});
  loop.step();
  EXPECT_NE(controller().law.output, loop.newest_command().head.checksum);
}

TEST_F(LawCalls, HaveARowWhereAFaultSuppressesTheFrame) {
  set_fault(loop.machine.faults, {.component = FaultComponent::kEstimator, .kind = FaultKind::kOff});
  loop.driver.step();
  const EstimatorTrace* row = loop.step_estimator();
  ASSERT_NE(row, nullptr);
  EXPECT_EQ(row->state.head.kind, FrameKind::kToken);
  EXPECT_EQ(estimator().law.number, 10u);
}

TEST_F(LawCalls, HaveARowForEachStepOfTheMonitorWithoutAFrame) {
  EXPECT_NE(monitor().law.sensors, 0u);
  ASSERT_TRUE(loop.monitor->time_out());
  EXPECT_EQ(monitor().law.number, 10u);
  EXPECT_EQ(monitor().law.sensors, 0u);
  EXPECT_EQ(monitor().silence, SensorSilence::kTimedOut);
  EXPECT_EQ(monitor().law.output, loop.newest_permit().head.checksum);
  EXPECT_EQ(loop.monitor->trace().permit.head.cycle, loop.driver.trace().sensors.head.cycle);
  EXPECT_FALSE(loop.monitor->time_out()) << "nothing has happened since";
  loop.monitor->inbox().store({.resets = 1});
  EXPECT_TRUE(loop.monitor->time_out());
  EXPECT_EQ(monitor().law.number, 11u);
  EXPECT_EQ(monitor().operator_input.resets, 1u);
}

}  // namespace robot_control::tests

// A machine that starts slowly: INIT until it is ready, FAULT when it never gets ready or falls back.

#include "safety/monitor_fixture.h"

namespace robot_control::tests {

/// The driver reports that the machine is starting. No joint and no IMU reports.
struct MachineStartTest : MonitorTest {
  MachineStartTest() {
    new_run();
    begin_start();
  }

  void begin_start() {
    sensors_.driver_state = DriverState::kStarting;
    set_joints_valid(sensors_, 0);
    sensors_.valid = 0;
  }
  void get_ready() {
    sensors_.driver_state = DriverState::kRunning;
    set_joints_valid(sensors_, kValidMotion);
    sensors_.valid = kValidGyro | kValidAccelerometer;
  }

  static constexpr std::uint64_t kTimeout = 30'000;  ///< cycles of start_timeout
};

TEST_F(MachineStartTest, ItIsAwaitedInInitWithoutACause) {
  input_.operator_input.heartbeats = 0;
  for (std::uint64_t i = 0; i < kTimeout - 2; ++i) {
    step();
    ASSERT_EQ(permit_.state, SupervisorState::kInit) << i;
    ASSERT_EQ(permit_.missing, kMissingMachine) << i;
    ASSERT_TRUE(braked()) << i;
  }
  get_ready();
  steps(kStands);
  EXPECT_EQ(permit_.state, SupervisorState::kReady);
  EXPECT_EQ(permit_.causes, 0u);
}

TEST_F(MachineStartTest, ItIsAFaultAfterTheTimeoutUntilItIsReadyAndReset) {
  steps(kTimeout + 1);
  EXPECT_EQ(permit_.state, SupervisorState::kFault);
  EXPECT_EQ(permit_.causes, kCauseMachineNotReady);
  EXPECT_EQ(permit_.evidence[0].limit, 30);
  EXPECT_NE(reset() & kRefusalCauseActive, 0u);
  get_ready();
  stand();
  EXPECT_EQ(permit_.state, SupervisorState::kFault);
  EXPECT_EQ(reset(), 0u);
  EXPECT_EQ(permit_.state, SupervisorState::kReady);
}

TEST_F(MachineStartTest, AMachineThatFallsBackIsAFaultAtOnce) {
  get_ready();
  steps(kStart);
  drive();
  begin_start();
  step();
  EXPECT_EQ(permit_.state, SupervisorState::kFault);
  EXPECT_EQ(permit_.causes, kCauseDriverFault);
  EXPECT_NE(reset() & kRefusalCauseActive, 0u);
  get_ready();
  stand();
  EXPECT_EQ(permit_.state, SupervisorState::kFault) << "nothing but a reset releases it";
  EXPECT_EQ(reset(), 0u);
}

TEST_F(MachineStartTest, AnEmergencyStopLatchesMeanwhile) {
  step();
  ++input_.operator_input.e_stop_services;
  step();
  EXPECT_EQ(permit_.causes, kCauseEmergencyStopService);
  get_ready();
  steps(kStart);
  EXPECT_EQ(permit_.state, SupervisorState::kStopped);
}

}  // namespace robot_control::tests

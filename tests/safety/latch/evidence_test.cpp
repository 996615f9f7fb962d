// A permit reports evidence of its causes for a limited time.

#include "safety/monitor_fixture.h"

namespace robot_control::tests {

struct EvidenceTest : MonitorTest {
  static constexpr double kSlow = 0.6;  // m/s; the robot drives at 0.5

  EvidenceTest() {
    SafetyParameters chosen = without_heartbeat();
    chosen.slow_speed = kSlow;
    chosen.battery_low = {22, 0, Reaction::kSlow};
    chosen.imu_lost.reaction = Reaction::kWarn;
    sensors_.valid |= kValidBattery;
    sensors_.battery_voltage = 24;
    begin_with(chosen);
    drive();
  }
  std::vector<std::uint64_t> reported() const {
    std::vector<std::uint64_t> causes;
    for (const CauseEvidence& evidence : permit_.evidence) {
      if (evidence.cause != 0) causes.push_back(evidence.cause);
    }
    return causes;
  }
  using Causes = std::vector<std::uint64_t>;
};

TEST_F(EvidenceTest, AWarningStaysForASecondAfterItsFactAndSlowsDownAsLong) {
  sensors_.battery_voltage = 21;
  step();
  const std::uint64_t since = cycle();
  steps(10);
  sensors_.battery_voltage = 24;
  steps(1000);
  EXPECT_EQ(permit_.warnings, std::uint64_t{kCauseBatteryLow});
  EXPECT_EQ(permit_.speed_limit, kSlow);
  EXPECT_EQ(permit_.evidence[0].cycle, since);
  EXPECT_EQ(permit_.evidence[0].value, 21);
  EXPECT_EQ(permit_.evidence[0].limit, 22);
  step();
  EXPECT_EQ(permit_.warnings, 0u);
  EXPECT_EQ(permit_.speed_limit, kNoSpeedLimit);
  EXPECT_EQ(reported(), Causes());
}

TEST(Warnings, ACauseThatStopsInsteadIsNoWarningASecondLater) {
  Warnings warnings(1e-3);
  ActiveCauses active;
  active.add(kCauseTorqueOscillation, Reaction::kWarn, {.value = 1});
  warnings.step(active, 1, 1);
  active.clear();
  active.add(kCauseTorqueOscillation, Reaction::kBrake, {.value = 2});
  for (std::uint64_t k = 2; k <= 1001; ++k) warnings.step(active, k, 1);
  EXPECT_EQ(warnings.bits(), std::uint64_t{kCauseTorqueOscillation});
  EXPECT_EQ(warnings.evidence(kCauseTorqueOscillation).value, 1);
  warnings.step(active, 1002, 1);
  EXPECT_EQ(warnings.bits(), 0u);
}

TEST_F(EvidenceTest, AFactThatComesAndGoesIsOneWarning) {
  sensors_.battery_voltage = 21;
  step();
  const std::uint64_t since = cycle();
  for (int i = 0; i < 50; ++i) {
    sensors_.battery_voltage = i % 2 == 0 ? 24 : 21;
    steps(100);
    ASSERT_EQ(permit_.warnings, std::uint64_t{kCauseBatteryLow});
  }
  EXPECT_EQ(permit_.evidence[0].cycle, since);
}

TEST_F(EvidenceTest, StandsInTheOrderInWhichCausesCameWithWarningsLast) {
  sensors_.battery_voltage = 21;
  step();
  ++input_.operator_input.e_stop_services;
  step();
  const std::uint64_t stopped = cycle();
  input_.command = nullptr;
  steps(kLoss);
  EXPECT_EQ(reported(), (Causes{kCauseEmergencyStopService, kCauseControllerLost, kCauseBatteryLow}));
  EXPECT_EQ(permit_.evidence[0].cycle, stopped);
  EXPECT_EQ(permit_.evidence[1].cycle, cycle());
  EXPECT_EQ(permit_.evidence[1].value, static_cast<double>(kLoss));
}

TEST_F(EvidenceTest, NamesTheJoint) {
  speed_[1] = 12;
  steps(180);
  ASSERT_NE(permit_.causes & kCauseRunaway, 0u);
  EXPECT_EQ(permit_.evidence[0].joint, 1u);
  EXPECT_GT(permit_.evidence[0].value, permit_.evidence[0].limit);
}

TEST_F(EvidenceTest, NamesTheJointWhoseSampleIsNotFinite) {
  sensors_.joints[1].effort = std::numeric_limits<double>::quiet_NaN();
  steps(3);
  ASSERT_EQ(permit_.causes, std::uint64_t{kCauseNotFinite});
  EXPECT_EQ(permit_.evidence[0].joint, 1u);
}

TEST_F(EvidenceTest, NamesNoJointWhereTheGyroIsNotFinite) {
  sensors_.imu.angular_velocity[1] = std::numeric_limits<double>::quiet_NaN();
  steps(3);
  ASSERT_EQ(permit_.causes, std::uint64_t{kCauseNotFinite});
  EXPECT_EQ(permit_.evidence[0].joint, kMaxJoints);
}

TEST_F(EvidenceTest, IsClearedByAnAcceptedReset) {
  ++input_.operator_input.e_stop_services;
  step();
  stand();
  ASSERT_EQ(reset(), 0u);
  EXPECT_EQ(reported(), Causes());
}

TEST_F(EvidenceTest, OutlivesARestartOfTheMonitor) {
  ++input_.operator_input.e_stop_services;
  step();
  input_.command = nullptr;
  steps(kLoss);
  const Permit last = permit_;
  input_.command = &command_;
  input_.operator_input = {};
  restart_monitor();
  step();
  EXPECT_EQ(reported(), (Causes{kCauseEmergencyStopService, kCauseControllerLost, kCauseMonitorRestarted}));
  EXPECT_EQ(permit_.evidence[0].cycle, last.evidence[0].cycle);
  EXPECT_EQ(permit_.evidence[1].value, last.evidence[1].value);
}

TEST_F(EvidenceTest, OutlivesANewRun) {
  ++input_.operator_input.e_stop_services;
  step();
  new_run();
  steps(5);
  EXPECT_EQ(reported(), Causes{kCauseEmergencyStopService});
}

}  // namespace robot_control::tests

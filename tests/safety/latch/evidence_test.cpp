// A permit reports evidence of its causes for a limited time.

#include "safety/monitor_fixture.h"

namespace robot_control::tests {

struct EvidenceTest : MonitorTest {
  EvidenceTest() {
    begin_with(without_heartbeat());
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

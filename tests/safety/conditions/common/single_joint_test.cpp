// One joint of a machine fails. The cause names this joint, and the reaction comes as early as if all joints failed.

#include "safety/conditions/common/frame_conditions.h"
#include "safety/conditions/common/machine_conditions.h"
#include "safety/conditions/common/sensor_presence.h"
#include "safety/latch/active_causes.h"
#include "safety/monitor_fixture.h"

namespace robot_control::tests {

constexpr double kCycle = 1e-3;
constexpr std::size_t kJoints = 4;
constexpr std::uint64_t kPersistence = 10;  ///< cycles of encoders_lost by default

struct SingleJointTest : testing::Test {
  SingleJointTest() {
    sensors_.joint_count = kJoints;
    set_joints_valid(sensors_, kValidMotion);
    for (int i = 0; i < 100; ++i) step();
  }

  void step() {
    ++sensors_.head.cycle;
    out_.clear();
    presence_.step(sensors_, 1, out_);
    machine_.step(sensors_, 1, out_);
  }

  /// Returns the cycle, counted from 1, in which the cause becomes active while `spoil` acts in each; 0: never.
  std::uint64_t cycles_until(StopCause cause, const std::function<void(std::uint64_t)>& spoil) {
    for (std::uint64_t cycle = 1; cycle < 1000; ++cycle) {
      spoil(cycle);
      step();
      if ((out_.stopping() & cause) != 0) return cycle;
    }
    return 0;
  }

  std::uint64_t named_joint() const { return out_.measurements()[0].joint; }

  SensorFrame sensors_;
  ActiveCauses out_;
  SensorPresence presence_{SafetyParameters{}, kJoints, kCycle};
  MachineConditions machine_{SafetyParameters{}, kCycle};
};

TEST_F(SingleJointTest, AHealthyMachineHasNoCause) {
  EXPECT_TRUE(out_.measurements().empty());
}

TEST_F(SingleJointTest, AMissingSampleIsNamedAfterThePersistence) {
  for (std::size_t joint = 0; joint < kJoints; ++joint) {
    set_joints_valid(sensors_, kValidMotion);
    step();
    EXPECT_EQ(cycles_until(kCauseEncodersLost, [&](std::uint64_t) { sensors_.joints[joint].valid = 0; }), kPersistence);
    EXPECT_EQ(named_joint(), joint);
  }
}

// Without one of them the controller brakes. It drives on when the number returns, so its absence must latch.
TEST_F(SingleJointTest, ASampleWithoutOneOfTheNumbersThatTheControllerNeedsIsMissing) {
  for (const std::uint32_t number : {kValidPosition, kValidVelocity, kValidEffort}) {
    set_joints_valid(sensors_, kValidMotion);
    step();
    EXPECT_EQ(
        cycles_until(kCauseEncodersLost, [&](std::uint64_t) { sensors_.joints[1].valid = kValidMotion & ~number; }),
        kPersistence);
    EXPECT_EQ(named_joint(), 1u);
  }
}

TEST(SensorPresence, ADriveOfSpeedsNeedsNoTorque) {
  SafetyParameters parameters;
  parameters.joint_numbers = kValidKinematics;
  SensorPresence presence(parameters, kJoints, kCycle);
  SensorFrame sensors;
  sensors.joint_count = kJoints;
  ActiveCauses out;
  const auto lost = [&](std::uint32_t valid) {
    set_joints_valid(sensors, valid);
    for (std::uint64_t i = 0; i < 2 * kPersistence; ++i) {
      out.clear();
      presence.step(sensors, 1, out);
    }
    return (out.stopping() & kCauseEncodersLost) != 0;
  };
  EXPECT_FALSE(lost(kValidKinematics));
  EXPECT_TRUE(lost(kValidPosition));
}

TEST_F(SingleJointTest, ASampleThatGrowsOldIsNamedInTheSameCycle) {
  const auto freeze = [&](std::uint64_t cycle) {
    sensors_.joints[2].age_ns = static_cast<std::int64_t>(cycle) * 1000000;
  };
  EXPECT_EQ(cycles_until(kCauseEncodersLost, freeze), kPersistence);
  EXPECT_EQ(named_joint(), 2u);
  EXPECT_DOUBLE_EQ(out_.measurements()[0].value, 0.01);
  EXPECT_DOUBLE_EQ(out_.measurements()[0].limit, 0.01);
}

TEST_F(SingleJointTest, SamplesOfASlowDriveAreNoLoss) {
  const auto every_fifth = [&](std::uint64_t cycle) {
    for (JointSample& sample : sensors_.joints) sample.age_ns = static_cast<std::int64_t>(cycle % 5) * 1000000;
  };
  EXPECT_EQ(cycles_until(kCauseEncodersLost, every_fifth), 0u);
}

TEST_F(SingleJointTest, ADriveFaultIsNamedAtOnce) {
  EXPECT_EQ(cycles_until(kCauseDriverFault, [&](std::uint64_t) { sensors_.joints[3].fault = 0x2000; }), 1u);
  EXPECT_EQ(named_joint(), 3u);
}

TEST_F(SingleJointTest, AFaultOfTheWholeDriverNamesNoJoint) {
  EXPECT_EQ(cycles_until(kCauseDriverFault, [&](std::uint64_t) { sensors_.faults = kFaultLink; }), 1u);
  EXPECT_EQ(named_joint(), kMaxJoints);
}

TEST_F(SingleJointTest, ANumberThatIsNotFiniteCountsOnlyWhereItIsValid) {
  sensors_.joints[1].position = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(not_finite_joint(sensors_), 1u);
  sensors_.joints[1].valid &= ~static_cast<std::uint32_t>(kValidPosition);
  EXPECT_EQ(not_finite_joint(sensors_), kMaxJoints);
}

/// The whole monitor, in motion; the second wheel's joint fails.
struct FailingJointTest : MonitorTest {
  FailingJointTest() {
    begin_with(without_heartbeat());
    drive();
  }
  void expect_named(StopCause cause) {
    EXPECT_EQ(permit_.action, PermitAction::kBrake);
    EXPECT_EQ(permit_.first_cause, cause);
    EXPECT_EQ(permit_.evidence[0].cause, cause);
    EXPECT_EQ(permit_.evidence[0].joint, 1u);
  }
};

TEST_F(FailingJointTest, MissingStopsTheRobotAndIsNamed) {
  sensors_.joints[1].valid = 0;
  steps(kPersistence);
  expect_named(kCauseEncodersLost);
}

TEST_F(FailingJointTest, FaultyStopsTheRobotAndIsNamed) {
  sensors_.joints[1].fault = 7;
  step();
  expect_named(kCauseDriverFault);
}

}  // namespace robot_control::tests

#pragma once
/// The contract of drivers/driver.h as tests, to which any driver can be given:
///
///   INSTANTIATE_TEST_SUITE_P(MyMachine, DriverContract, testing::Values(MachineUnderTest{…}), machine_name);
///
/// The machine stands on a level floor, or its wheels hang free, and every joint may turn by some revolutions.

#include <gtest/gtest.h>

#include <cmath>

#include "drivers/driver.h"
#include "gate/stop_action.h"
#include "support/allocation_guard.h"

namespace robot_control {

struct MachineUnderTest {
  std::string name;
  std::function<std::unique_ptr<Driver>()> make;  ///< not started
  std::size_t joints = 2;
  double period = 0.001;                      ///< s
  double effort_limit = 0;                    ///< N·m, of every joint
  double effort = 0;                          ///< N·m, turns a single joint
  double damping = 0;                         ///< N·m·s/rad, lets a joint follow a velocity
  double stiffness = 0;                       ///< N·m/rad, with that damping
  std::function<void()> next_period = [] {};  ///< waits for the period, on hardware
  bool devices_allocate = false;              ///< simulated ones, in `write`
};

inline void PrintTo(const MachineUnderTest& machine, std::ostream* out) {
  *out << machine.name;
}

inline std::string machine_name(const testing::TestParamInfo<MachineUnderTest>& info) {
  return info.param.name;
}

struct DriverContract : testing::TestWithParam<MachineUnderTest> {
  static constexpr double kStanding = 0.05;  ///< rad/s: safety_monitor.standstill_speed

  void SetUp() override {
    driver_ = GetParam().make();
    driver_->start();
  }
  void TearDown() override { driver_->stop(); }

  SensorFrame sensors() {
    SensorFrame frame;
    driver_->read(frame);
    return frame;
  }
  const JointSample& joint(std::size_t i) {
    frame_ = sensors();
    return frame_.joints[i];
  }

  std::vector<JointCommand> all(const JointCommand& command) const {
    return std::vector<JointCommand>(GetParam().joints, command);
  }
  JointCommand effort(double value) const { return {.mode = JointMode::kEffort, .effort = value}; }
  JointCommand velocity(double value) const {
    return {.mode = JointMode::kVelocity, .velocity = value, .damping = GetParam().damping};
  }

  /// Runs cycles of read and write, as DriverCycle makes them.
  void hold(const std::vector<JointCommand>& commands, double seconds) {
    for (long i = 0; i < std::lround(seconds / GetParam().period); ++i) {
      driver_->read(frame_);
      driver_->write(commands);
      GetParam().next_period();
    }
  }

  /// rad/s of every joint, mean over 0.1 s of these commands: encoders may count coarsely.
  std::vector<double> speeds_under(const std::vector<JointCommand>& commands) {
    constexpr double kSpan = 0.1;  // s
    const SensorFrame before = sensors();
    hold(commands, kSpan);
    const SensorFrame after = sensors();
    std::vector<double> speeds;
    for (std::size_t i = 0; i < GetParam().joints; ++i) {
      speeds.push_back((after.joints[i].position - before.joints[i].position) / kSpan);
    }
    return speeds;
  }
  void expect_standing_under(const std::vector<JointCommand>& commands) {
    for (const double speed : speeds_under(commands)) EXPECT_LT(std::abs(speed), kStanding);
  }

  std::unique_ptr<Driver> driver_;
  SensorFrame frame_;
  const JointCommand brake_{};
};

TEST_P(DriverContract, StandsWithValidJointsAfterStart) {
  const SensorFrame frame = sensors();
  EXPECT_EQ(frame.driver_state, DriverState::kRunning);
  EXPECT_EQ(frame.faults, 0u);
  EXPECT_EQ(frame.joint_count, GetParam().joints);
  EXPECT_TRUE(joints_have(frame, GetParam().joints, kValidPosition | kValidVelocity));
  expect_standing_under(all(brake_));
}

/// These fields belong to the cycle (DriverCycle).
TEST_P(DriverContract, LeavesHeadInstanceGateAndCountersAlone) {
  SensorFrame frame;
  frame.head = {.checksum = 1, .run = 2, .cycle = 3, .stamp_ns = 4};
  frame.driver_instance = 5;
  frame.gate.held = 6;
  frame.overruns = 7;
  frame.slipped_ns = 8;
  frame.held_ns = 9;
  driver_->read(frame);
  EXPECT_EQ(frame.head.checksum + frame.head.run + frame.head.cycle, 6u);
  EXPECT_EQ(frame.head.stamp_ns, 4);
  EXPECT_EQ(frame.driver_instance, 5u);
  EXPECT_EQ(frame.gate.held, 6u);
  EXPECT_EQ(frame.overruns, 7u);
  EXPECT_EQ(frame.slipped_ns, 8u);
  EXPECT_EQ(frame.held_ns, 9u);
}

TEST_P(DriverContract, ABrakeHoldsThePosition) {
  const SensorFrame before = sensors();
  hold(all(brake_), 1.0);
  for (std::size_t i = 0; i < GetParam().joints; ++i) {
    EXPECT_NEAR(joint(i).position, before.joints[i].position, 0.01) << i;
  }
}

TEST_P(DriverContract, APositiveEffortTurnsItsJointTowardsPositiveAngles) {
  for (std::size_t i = 0; i < GetParam().joints; ++i) {
    const double before = joint(i).position;
    auto commands = all(brake_);
    commands[i] = effort(GetParam().effort);
    hold(commands, 0.3);
    EXPECT_GT(joint(i).position, before + 0.05) << i;
    hold(all(brake_), 1.0);
  }
}

TEST_P(DriverContract, VelocityIsTheRateOfPosition) {
  hold(all(velocity(3.0)), 1.0);
  const double before = joint(0).position;
  double distance = 0;
  for (int i = 0; i < 200; ++i) {
    hold(all(velocity(3.0)), GetParam().period);
    distance += joint(0).velocity * GetParam().period;
  }
  EXPECT_NEAR(joint(0).position - before, distance, 0.02 * distance);
}

TEST_P(DriverContract, AVelocityIsFollowedInBothDirections) {
  for (const double target : {3.0, -3.0}) {
    hold(all(velocity(target)), 2.0);
    for (const double speed : speeds_under(all(velocity(target)))) EXPECT_NEAR(speed, target, 0.3);
  }
}

TEST_P(DriverContract, AnImpedanceHoldsItsPosition) {
  const SensorFrame before = sensors();
  auto commands = all(brake_);
  for (std::size_t i = 0; i < GetParam().joints; ++i) {
    commands[i] = {.mode = JointMode::kImpedance,
                   .position = before.joints[i].position + 0.5,
                   .stiffness = GetParam().stiffness,
                   .damping = GetParam().damping};
  }
  hold(commands, 3.0);
  for (std::size_t i = 0; i < GetParam().joints; ++i) {
    EXPECT_NEAR(joint(i).position, before.joints[i].position + 0.5, 0.05) << i;
  }
}

TEST_P(DriverContract, AnEffortBeyondTheLimitIsClamped) {
  for (int i = 0; i < 20; ++i) {
    hold(all(effort(100 * GetParam().effort_limit)), GetParam().period);
    EXPECT_LE(std::abs(joint(0).effort), GetParam().effort_limit * 1.01);
  }
  EXPECT_GT(joint(0).effort, GetParam().effort_limit * 0.9);
}

TEST_P(DriverContract, AcceptsTheBrake) {
  EXPECT_TRUE(driver_->accepts(JointMode::kBrake));
}

TEST_P(DriverContract, AStopActionWhoseModeItAcceptsActsAtOnce) {
  for (const StopKind kind : {StopKind::kBrake, StopKind::kCoast, StopKind::kDamp}) {
    const JointCommand order =
        JointStop().step({.kind = kind, .damping = GetParam().damping}, std::nullopt, GetParam().period);
    if (!driver_->accepts(order.mode)) continue;
    hold(all(velocity(3.0)), 1.0);
    hold(all(order), 2 * GetParam().period);
    for (std::size_t i = 0; i < GetParam().joints; ++i) {
      const double effort = joint(i).effort;
      if (kind == StopKind::kCoast) {
        EXPECT_NEAR(effort, 0, 0.05 * GetParam().effort_limit) << i;
      } else {
        EXPECT_LT(effort, 0) << i << ", action " << static_cast<int>(kind);
      }
    }
  }
}

TEST_P(DriverContract, ABrakeStopsAMovingJoint) {
  hold(all(velocity(3.0)), 1.0);
  hold(all(brake_), 2.0);
  expect_standing_under(all(brake_));
}

/// The gate refuses such commands already; the driver is the last place that can stop one.
TEST_P(DriverContract, ACommandThatIsNotFiniteOrOfUnknownModeBrakes) {
  const JointCommand unknown{.mode = static_cast<JointMode>(77), .effort = GetParam().effort};
  for (const JointCommand& bad : {effort(std::numeric_limits<double>::quiet_NaN()), unknown}) {
    hold(all(velocity(3.0)), 1.0);
    hold(all(bad), 2.0);
    expect_standing_under(all(bad));
  }
}

TEST_P(DriverContract, StopBrakesPermanently) {
  hold(all(velocity(3.0)), 1.0);
  driver_->stop();
  hold(all(velocity(3.0)), 2.0);
  expect_standing_under(all(velocity(3.0)));
}

TEST_P(DriverContract, CanBeStartedAgainAfterStop) {
  driver_->stop();
  driver_->start();
  hold(all(velocity(3.0)), 1.0);
  for (const double speed : speeds_under(all(velocity(3.0)))) EXPECT_GT(speed, 1.0);
}

TEST_P(DriverContract, ReadAndWriteDoNotAllocate) {
  if (GetParam().devices_allocate) GTEST_SKIP() << "a test of the driver alone shows it";
  const auto commands = all(velocity(1.0));
  hold(commands, 0.1);
  const AllocationGuard guard;
  hold(commands, 0.1);
  EXPECT_EQ(guard.count(), 0u);
}

}  // namespace robot_control

#include "control/wheeled/drive_controller.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "control/wheeled/control_bench.h"
#include "support/allocation_guard.h"

namespace robot_control::tests {

/// Driving at 0.5 m/s and 0.2 rad/s, healthy.
struct DriveControllerTest : testing::Test {
  void SetUp() override { start(); }

  void start() {
    bench.run(0.3);
    bench.send(0.5, 0.2);
    bench.run(1.0);
  }

  bool braked() const {
    for (const JointCommand& joint : bench.command.joints) {
      if (joint.mode != JointMode::kBrake || joint.effort != 0) return false;
    }
    return bench.command.twist_limited.linear[0] == 0 && bench.command.twist_limited.angular[2] == 0;
  }

  double limited() const { return bench.command.twist_limited.linear[0]; }

  ControlBench bench{make_test_robot(), straight_ramps()};
};

TEST_F(DriveControllerTest, DrivesTheArticlesExample) {
  EXPECT_NEAR(bench.plant.twist.linear, 0.5, 1e-6);
  EXPECT_NEAR(bench.plant.twist.angular, 0.2, 1e-6);
  EXPECT_EQ(bench.command.joints[0].mode, JointMode::kEffort);
  EXPECT_NEAR(bench.command.joints[0].velocity, 4.5, 1e-12);  // rad/s: 0.45 m/s
  EXPECT_NEAR(bench.command.joints[1].velocity, 5.5, 1e-12);
  EXPECT_NEAR(bench.command.wheeled.velocity[0], 4.5, 1e-5);
  EXPECT_NEAR(bench.command.wheeled.velocity[1], 5.5, 1e-5);
  EXPECT_EQ(bench.command.reasons, 0u);
  EXPECT_EQ(bench.command.joint_count, 2u);
  EXPECT_EQ(bench.command.requests_received, 1u);
  EXPECT_EQ(bench.command.request_cycle, 300u);
  EXPECT_EQ(bench.command.state_cycle, bench.cycle - 1);
  EXPECT_EQ(bench.command.permit_cycle, bench.cycle - 1);
}

TEST_F(DriveControllerTest, BrakesUnlessThePermitIsThereAndSaysDrive) {
  const auto reasons_of = [&](bool with_permit, PermitAction action) {
    bench.with_permit = with_permit;
    bench.permit.action = action;
    bench.step();
    EXPECT_TRUE(braked());
    return bench.command.reasons;
  };
  EXPECT_EQ(reasons_of(false, PermitAction::kDrive), kReasonNoPermit);
  EXPECT_EQ(reasons_of(true, PermitAction::kBrake), kReasonPermitBrake);
  reasons_of(true, static_cast<PermitAction>(7));
}

TEST_F(DriveControllerTest, BrakesAfterTheLastCycleOfARamp) {
  bench.permit.action = PermitAction::kRamp;
  bench.permit.ramp_until = bench.cycle;
  bench.step();
  EXPECT_FALSE(braked());
  bench.step();
  EXPECT_TRUE(braked());
  EXPECT_TRUE(bench.command.reasons & kReasonPermitBrake);
}

TEST_F(DriveControllerTest, BrakesOnSensorsThatItCannotUseAndRecovers) {
  const std::vector<std::function<void(SensorFrame&)>> spoilt{
      [](SensorFrame& sensors) { sensors.joints[1].position = std::nan(""); },
      [](SensorFrame& sensors) { sensors.joints[1].velocity = std::nan(""); },
      [](SensorFrame& sensors) { sensors.joints[1].effort = std::nan(""); },
      [](SensorFrame& sensors) { sensors.joints[0].effort = 1e308; },
      [](SensorFrame& sensors) { set_joints_valid(sensors, 0); },
      [](SensorFrame& sensors) { sensors.joint_count = 3; },
      [](SensorFrame& sensors) { --sensors.head.cycle; }};
  for (std::size_t i = 0; i < spoilt.size(); ++i) {
    SCOPED_TRACE(i);
    bench.send(0.5, 0.2);
    bench.spoil = spoilt[i];
    bench.step();
    EXPECT_TRUE(braked());
    EXPECT_TRUE(bench.command.reasons & kReasonBadSensors);
    bench.spoil = [](SensorFrame& sensors) {
      sensors.joint_count = 2;
      set_joints_valid(sensors, kValidMotion);
    };
    bench.run(0.8);
    ASSERT_NEAR(bench.plant.twist.linear, 0.5, 1e-3);
  }
}

TEST_F(DriveControllerTest, BrakesForOneCycleOnAnAngleThatJumpsAndDrivesOn) {
  for (const double jump : {1.1, -50.0, 1e308}) {
    bench.send(0.5, 0.2);
    bench.spoil = [=](SensorFrame& sensors) { sensors.joints[0].position += jump; };
    bench.step();
    EXPECT_TRUE(braked());
    EXPECT_TRUE(bench.command.reasons & kReasonBadSensors);
    bench.spoil = [](SensorFrame&) {};
    for (int k = 0; k < 500; ++k) {
      bench.step();
      ASSERT_FALSE(braked());
      // One cycle of the brake, 2 N·m·s/rad at 5 rad/s, bounds the fall of the speed.
      ASSERT_NEAR(bench.plant.twist.linear, 0.5, 0.1) << "jump " << jump << " cycle " << k;
    }
    ASSERT_NEAR(bench.plant.twist.linear, 0.5, 1e-3);
  }
}

TEST_F(DriveControllerTest, DrivesOnWithoutAStateAndSaysSo) {
  bench.with_state = false;
  const std::uint64_t known = bench.command.state_cycle;
  bench.run(0.1);
  EXPECT_EQ(bench.command.reasons, kReasonNoState);
  EXPECT_EQ(bench.command.state_cycle, known);
  EXPECT_NEAR(bench.plant.twist.linear, 0.5, 1e-6);
}

TEST_F(DriveControllerTest, SaysThatTheStateIsInvalid) {
  bench.state.base.flags = 0;
  bench.step();
  EXPECT_EQ(bench.command.reasons, kReasonNoState);
}

TEST_F(DriveControllerTest, RestartsItsRampFromTheMeasuredSpeedWhileTheGateBrakes) {
  bench.send(1, 0);
  bench.spoil = [](SensorFrame& sensors) { sensors.gate.verdict = GateVerdict::kBrake; };
  for (int k = 0; k < 200; ++k) {
    bench.step();
    ASSERT_NEAR(limited(), bench.plant.twist.linear, 0.01);
  }
}

TEST_F(DriveControllerTest, TakesSkippedCyclesIntoTheRamp) {
  bench.send(0, 0);
  bench.cycle += 2;
  bench.step();
  EXPECT_NEAR(limited(), 0.5 - 0.003, 1e-12);
}

TEST_F(DriveControllerTest, ReseedsAfterMoreSkippedCyclesThanTheGateHolds) {
  bench.send(0, 0);
  bench.cycle += kCommandLife;
  bench.step();

  const double measured =
      0.05 * (bench.command.wheeled.velocity[0] + bench.command.wheeled.velocity[1]);  // r/2 of both
  EXPECT_NEAR(limited(), measured, 1e-12);
  EXPECT_EQ(bench.command.reasons, 0u);
}

TEST_F(DriveControllerTest, DrivesBackwardsAsItDrivesForwards) {
  ControlBench back(make_test_robot(), straight_ramps());
  back.run(0.3);
  back.send(-0.5, -0.2);
  back.run(1.0);
  EXPECT_NEAR(back.plant.twist.linear, -bench.plant.twist.linear, 1e-12);
  EXPECT_NEAR(back.plant.distance, -bench.plant.distance, 1e-12);
}

TEST_F(DriveControllerTest, DrivesAWheelThatIsMountedTheOtherWayRound) {
  DriveTrain mirrored = make_test_robot();
  mirrored.wheels[1].sign = -1;
  bench = ControlBench(mirrored);
  start();
  EXPECT_NEAR(bench.plant.twist.linear, 0.5, 1e-6);
  EXPECT_NEAR(bench.command.joints[1].velocity, -5.5, 1e-12);
}

// The right wheel is held. An encoder of 45 counts a turn would not contradict 0.5 rad/s for 0.3 s.
TEST(DriveControllerOfAHeldWheel, KnowsByTheCountsOfTheOtherThatItStands) {
  DriveController controller({}, make_test_robot(), 1e-3);
  controller.enter_run();
  SensorFrame sensors;
  set_joints_valid(sensors, kValidMotion);
  sensors.joint_count = 2;
  Permit permit;
  permit.action = PermitAction::kDrive;
  permit.speed_limit = kNoSpeedLimit;
  VelocityCommand request;
  request.content.twist = {.linear = {0.05, 0, 0}};
  request.count = 1;
  CommandFrame out;
  double angle = 0;
  std::array<CommandFrame, 2> last{};
  for (std::uint64_t k = 0; k < 250; ++k) {
    sensors.head.cycle = permit.head.cycle = k;
    sensors.gate.verdict = k == 0 ? GateVerdict::kBrake : GateVerdict::kPassed;
    angle += 1e-3 * last[1].joints[0].velocity;
    sensors.joints[0].position = 1.5e-3 * std::floor(angle / 1.5e-3);
    for (std::size_t i = 0; i < 2; ++i) sensors.joints[i].effort = last[1].joints[i].effort;
    controller.step({&sensors, nullptr, &permit, request}, out);
    last = {out, last[0]};
  }
  EXPECT_NEAR(out.joints[1].velocity, 0.5, 1e-9);
  EXPECT_NEAR(out.wheeled.velocity[0], 0.5, 0.1);
  EXPECT_LT(std::abs(out.wheeled.velocity[1]), 0.25);
}

// Sensors that do as commanded: the plans of 0.5 m/s, 0.2 rad/s on all four wheels, load shared.
TEST(DriveControllerOfFourWheels, DrivesEveryWheelOfASideAlikeAndBrakesForAnyThatFails) {
  const DriveTrain robot = make_skid_steer();
  DriveController controller({}, robot, 1e-3);
  controller.enter_run();
  SensorFrame sensors;
  set_joints_valid(sensors, kValidMotion);
  sensors.joint_count = 4;
  Permit permit;
  permit.action = PermitAction::kDrive;
  permit.speed_limit = kNoSpeedLimit;
  VelocityCommand request;
  request.content.twist = {.linear = {0.5, 0, 0}, .angular = {0, 0, 0.2}};
  CommandFrame out;
  WheelValues plan{};
  WheelValues last{};
  for (std::uint64_t k = 0; k < 1000; ++k) {
    request.count = k < 10 ? 0 : 1;
    sensors.head.cycle = permit.head.cycle = k;
    sensors.gate.verdict = k == 0 ? GateVerdict::kBrake : GateVerdict::kPassed;
    for (std::size_t i = 0; i < 4; ++i) {
      sensors.joints[i] = {.position = sensors.joints[i].position + 0.5e-3 * (last[i] + plan[i]),
                           .velocity = plan[i],
                           .valid = kValidMotion};
    }
    controller.step({&sensors, nullptr, &permit, request}, out);
    last = plan;
    for (std::size_t i = 0; i < 4; ++i) plan[i] = out.joints[i].velocity;
  }
  EXPECT_NEAR(out.twist_limited.angular[2], 0.2, 1e-12);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(out.joints[i].mode, JointMode::kEffort);
    EXPECT_NEAR(out.joints[i].velocity, i < 2 ? -4.18 : 5.82, 1e-12);
  }
  sensors.joints[3].position = std::nan("");
  ++sensors.head.cycle;
  controller.step({&sensors, nullptr, &permit, request}, out);
  EXPECT_TRUE(out.reasons & kReasonBadSensors);
  for (const JointCommand& joint : out.joints) EXPECT_EQ(joint.mode, JointMode::kBrake);
}

TEST_F(DriveControllerTest, BrakesTheJointsThatAreNotWheels) {
  DriveTrain arm = make_test_robot();
  arm.joints.push_back({.name = "arm", .child_link = "arm", .effort_limit = 1, .velocity_limit = 1});
  bench = ControlBench(arm);
  start();
  EXPECT_EQ(bench.command.joint_count, 3u);
  EXPECT_EQ(bench.command.joints[0].mode, JointMode::kEffort);
  EXPECT_EQ(bench.command.joints[2].mode, JointMode::kBrake);
}

TEST_F(DriveControllerTest, StartsANewRunFromNothing) {
  bench.controller.enter_run(bench.request);
  bench.cycle = 0;
  bench.plant = TwoWheelPlant(make_test_robot());
  bench.plant.angle = {123, -456};
  bench.run(0.3);
  EXPECT_TRUE(bench.command.reasons & kReasonNoCommand);
  EXPECT_EQ(bench.command.requests_received, 0u);
  EXPECT_EQ(bench.plant.distance, 0);
  bench.send(0.5, 0.2);
  bench.run(1.0);
  EXPECT_NEAR(bench.plant.twist.linear, 0.5, 1e-6);
}

TEST_F(DriveControllerTest, NeverExceedsLimitsUnderRandomCommandsPermitsAndFaults) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> requested(-3, 3);
    std::uniform_int_distribution<int> event(0, 400);
    bench = ControlBench(make_test_robot(), straight_ramps());
    bench.plant.counts = 4096;
    int brake = 0;
    for (int k = 0; k < 8000; ++k) {
      const int what = event(random);
      if (what < 3) bench.send(requested(random), requested(random));
      if (what == 3) bench.send(INFINITY, 0);
      if (what == 4) brake = 50;
      bench.permit.action = brake-- > 0 ? PermitAction::kBrake : PermitAction::kDrive;
      bench.with_permit = what != 5;
      const CommandFrame before = bench.command;
      bench.step();
      for (const JointCommand& joint : bench.command.joints) {
        ASSERT_TRUE(std::isfinite(joint.effort)) << "seed " << seed;
        ASSERT_LE(std::abs(joint.effort), 5) << "seed " << seed;
      }
      // Compares plan with plan; a seed is the measured speed and no plan.
      const std::uint64_t own = kReasonAccelerationLimited;
      if ((before.reasons & own) && (bench.command.reasons & own)) {
        ASSERT_LE(std::abs(limited() - before.twist_limited.linear[0]), 1e-3 + 1e-12) << "seed " << seed;
        ASSERT_LE(std::abs(bench.command.twist_limited.angular[2] - before.twist_limited.angular[2]), 4e-3 + 1e-12)
            << "seed " << seed;
      }
    }
  }
}

/// These are the default limits: 1 m/s² usually, 2 m/s² in an emergency, 10 m/s³.
struct Emergency : DriveControllerTest {
  Emergency() { bench = ControlBench(); }

  /// Expects this deceleration of the limited speed, m/s², over the next 0.6 s, and the way in m to standstill.
  void expect_a_ramp_of(double deceleration, std::uint64_t reason) {
    const double start = bench.plant.distance;
    double strongest = 0;
    std::uint64_t reasons = 0;
    for (int k = 0; k < 700; ++k) {
      const double before = limited();
      bench.step();
      reasons |= bench.command.reasons;
      strongest = std::fmax(strongest, (before - limited()) / bench.period);
    }
    EXPECT_NEAR(strongest, deceleration, 1e-9);
    EXPECT_EQ(reasons & reason, reason);
    EXPECT_EQ(limited(), 0);
    const double speed = std::hypot(0.5, 0);
    const double distance = speed * speed / (2 * deceleration) + speed * deceleration / (2 * 10);
    EXPECT_NEAR(bench.plant.distance - start, distance, 2e-3 + 2e-3 * speed)
        << "two cycles of delay, and what a curve adds";
  }
};

TEST_F(Emergency, IsNoneByAZeroCommand) {
  bench.send(0, 0);
  expect_a_ramp_of(1, 0);
}

TEST_F(Emergency, IsATimeout) {
  while (bench.cycle <= bench.command.request_cycle + 1250) bench.step();
  expect_a_ramp_of(2, kReasonTimedOut);
  EXPECT_EQ(bench.command.timeouts, 1u);
}

TEST_F(Emergency, IsARefusedCommand) {
  bench.send(std::nan(""), 0);
  expect_a_ramp_of(2, kReasonRefused);
  EXPECT_EQ(bench.command.requests_refused, 1u);
}

TEST_F(Emergency, IsARampPermit) {
  bench.permit.action = PermitAction::kRamp;
  bench.permit.ramp_until = bench.cycle + 1000;
  expect_a_ramp_of(2, kReasonPermitRamp);
}

TEST_F(DriveControllerTest, DoesNotAllocate) {
  ControlInput input{&bench.sensors, &bench.state, &bench.permit, bench.request};
  CommandFrame out;
  const AllocationGuard guard;
  for (int k = 0; k < 2000; ++k) {
    ++bench.sensors.head.cycle;
    input.request.count += k % 100 == 0 ? 1 : 0;
    bench.permit.action = k % 500 < 20 ? PermitAction::kBrake : PermitAction::kDrive;
    bench.controller.step(input, out);
  }
  bench.controller.enter_run();
  EXPECT_EQ(guard.count(), 0u);
}

}  // namespace robot_control::tests

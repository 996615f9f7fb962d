#include "loop/gate_setup.h"

#include "loop/cycle_fixture.h"
#include "robots/differential_drive.h"
#include "support/matchers.h"
#include "support/message_of.h"

namespace robot_control::tests {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// One joint of a robot: a wheel of 3 N·m, 20 rad/s, 500 N·m/s.
JointLimits limits_of(const std::function<void(JointModel&)>& change) {
  DriveTrain robot = two_wheels();
  robot.joints[1].effort_rate = 500;
  change(robot.joints[1]);
  return joint_limits(robot).at(1);
}

TEST(GateSetup, AWheelsLimitsAreThoseOfItsModel) {
  const JointLimits limits = limits_of([](JointModel&) {});
  EXPECT_EQ(limits.effort, 3);
  EXPECT_EQ(limits.velocity, 20);
  EXPECT_EQ(limits.effort_rate, 500);
  EXPECT_EQ(limits.lower, -kInfinity);
  EXPECT_EQ(limits.upper, kInfinity);
}

TEST(GateSetup, WhatIsUnknownIsNoLimit) {
  const JointLimits limits = limits_of([](JointModel& joint) {
    joint.velocity_limit = 0;
    joint.effort_rate = 0;
  });
  EXPECT_EQ(limits.velocity, kInfinity);
  EXPECT_EQ(limits.effort_rate, kInfinity);
}

TEST(GateSetup, TheSoftZoneIsATwentiethOfTheRangeAndNeverMuch) {
  const auto zone = [](double lower, double upper, bool prismatic) {
    return limits_of([&](JointModel& joint) {
             joint.range = JointRange{lower, upper};
             joint.prismatic = prismatic;
           })
        .soft_zone;
  };
  EXPECT_DOUBLE_EQ(zone(-0.5, 0.5, false), 0.05);
  EXPECT_DOUBLE_EQ(zone(-3, 3, false), 0.1);
  EXPECT_DOUBLE_EQ(zone(0, 0.2, true), 0.01);
  EXPECT_DOUBLE_EQ(zone(0, 2, true), 0.02);
}

TEST(GateSetup, EndStopsAreThoseOfTheRange) {
  const JointLimits limits = limits_of([](JointModel& joint) { joint.range = JointRange{-1, 2}; });
  EXPECT_EQ(limits.lower, -1);
  EXPECT_EQ(limits.upper, 2);
}

TEST(GateSetup, TheLongestRampIsTheMonitorsAndALossLonger) {
  Parameters parameters;
  parameters.loop.rate = 1000;
  parameters.safety.ramp_time = 2;
  parameters.safety.loss_cycles = 20;
  EXPECT_EQ(DifferentialDrive(parameters, two_wheels()).gate().longest_ramp, 2020u);
  parameters.loop.rate = 300;
  parameters.safety.ramp_time = 0.011;  // 3.3 periods
  EXPECT_EQ(DifferentialDrive(parameters, two_wheels()).gate().longest_ramp, 24u);
}

/// Two wheels and an arm.
DriveTrain with_an_arm() {
  DriveTrain robot = two_wheels();
  robot.joints.push_back({.name = "arm", .child_link = "arm", .effort_limit = 5, .role = JointRole::kHeld});
  return robot;
}

TEST(GateSetup, WheelsStopByTheUsersActionAndAnArmBrakes) {
  Parameters parameters;
  for (const StopKind kind : {StopKind::kBrake, StopKind::kCoast, StopKind::kDamp}) {
    parameters.loop.fail_action = kind;
    const std::vector<StopProfile> profiles = DifferentialDrive(parameters, with_an_arm()).gate().profiles;
    ASSERT_EQ(profiles.size(), 1u);
    const StopProfile& stops = profiles[0];
    ASSERT_EQ(stops.size(), 3u);
    EXPECT_EQ(stops[0].kind, kind);
    EXPECT_EQ(stops[1].kind, kind);
    EXPECT_EQ(stops[2].kind, StopKind::kBrake);
  }
}

/// A machine whose wheel runs away, or whose encoder is lost.
struct RunawayMachine final : Driver {
  void start() override {}
  void read(SensorFrame& sensors) noexcept override {
    position += speed * kPeriod;
    set_joints_valid(sensors, valid);
    sensors.joint_count = 2;
    sensors.joints[0].position = position;
  }
  void write(std::span<const JointCommand> commands) noexcept override { command = commands[0]; }
  void stop() noexcept override {}

  double speed = 0;
  double position = 0;
  std::uint32_t valid = kValidMotion;
  JointCommand command;
};

TEST(RequireNeeds, NamesEverythingThatTheDriverLacksWithTheRemedy) {
  const RunawayMachine machine;  // It brakes, and measures its joints.
  const auto refusal = [&](const MachineNeeds& needs) {
    return message_of<DriverError>([&] { require_needs(machine, needs); });
  };
  EXPECT_EQ(refusal({.modes = {JointMode::kBrake}, .inputs = {MachineInput::kJointMotion}}), "");
  EXPECT_EQ(refusal({.modes = {JointMode::kImpedance}, .inputs = {MachineInput::kImu, MachineInput::kContacts}}),
            "this kind of robot needs functions that its driver does not have: commands of impedances: add the "
            "computation of torques to the driver (drivers/joint_law.h); an IMU: set robot.imu to topic and start the "
            "IMU's node, or use a "
            "driver with an IMU; forces of contacts: use a driver with contact sensors");
  EXPECT_THAT(refusal({.modes = {JointMode::kBrake, JointMode::kDriveVelocity}}),
              HasSubstr("set robot.wheel_command to torque"));
}

TEST(DriverCycleAndGate, AStopActionThatTheDriverDoesNotImplementIsRefusedAtStart) {
  RunawayMachine machine;
  const TestChannels channels;
  const auto refusal = [&](StopKind kind) {
    return message_of<DriverError>([&] {
      DriverCycle(machine, two_wheels(), channels.of_driver(), kPeriodNs, nullptr,
                  {.profiles = {StopProfile(2), {{}, {.kind = kind}}}});
    });
  };
  EXPECT_EQ(refusal(StopKind::kBrake), "");
  EXPECT_EQ(refusal(StopKind::kCoast), "joint " + two_wheels().joints[1].name +
                                           " must be stopped by the action \"coast\", which this driver does not "
                                           "implement. Set robot.fail_action to brake.");
  EXPECT_THAT(refusal(StopKind::kDamp), HasSubstr("\"damp\""));
}

TEST(DriverCycleAndGate, TheGateSeesTheSamplesOfItsOwnTick) {
  RunawayMachine machine;
  TestChannels channels;
  DriverCycle driver(machine, two_wheels(), channels.of_driver(), kPeriodNs, nullptr);
  driver.begin_run(1);
  const auto tick = [&] {
    driver.step();
    const FrameHead head{.run = 1, .cycle = driver.next_cycle() - 1};
    CommandFrame next;
    next.head = head;
    next.joint_count = 2;
    next.joints[0] = {.mode = JointMode::kEffort, .effort = 1};
    channels.command.writer.publish(next);
    Permit drive;
    drive.head = head;
    drive.action = PermitAction::kDrive;
    drive.expiry = head.cycle + kPermitLife;
    channels.permit.writer.publish(drive);
  };
  for (int i = 0; i < 10; ++i) tick();
  EXPECT_EQ(driver.trace().gate.verdict, GateVerdict::kPassed);
  machine.valid = 0;
  tick();
  EXPECT_EQ(driver.trace().gate.reasons, std::uint64_t{kGateBadSensors});
  EXPECT_EQ(machine.command.mode, JointMode::kBrake);
  machine.valid = kValidMotion;
  machine.speed = 25;  // of 20 rad/s
  for (int i = 0; i < 30; ++i) tick();
  EXPECT_EQ(driver.trace().gate.reasons, std::uint64_t{kGateSpeedClamped});
  EXPECT_EQ(machine.command.effort, 0);
}

}  // namespace robot_control::tests

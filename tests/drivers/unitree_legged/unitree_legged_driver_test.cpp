/// The driver of a Go1 before its simulated robot, in virtual time: two joints in the air.

#include "drivers/unitree_legged/unitree_legged_driver.h"

#include <gtest/gtest.h>

#include <cmath>

#include "drivers/line/free_port.h"
#include "drivers/line/udp_socket.h"
#include "drivers/unitree_legged/random_messages.h"
#include "drivers/unitree_legged/unitree_legged_front.h"
#include "drivers/wheels_in_air.h"
#include "support/allocation_guard.h"
#include "support/matchers.h"

namespace robot_control::tests {

using unitree::LowCmd;

constexpr double kOffset = 0.25;  // rad, of joint 1

class Go1InAir final : public WheelsInAir<UnitreeLeggedFront, UnitreeLeggedDriver> {
 public:
  explicit Go1InAir(double rate) : WheelsInAir(1 / rate) {
    board_ = std::make_unique<UnitreeLeggedFront>(parameters(), period_, 1, nullptr);
    driver_ = std::make_unique<UnitreeLeggedDriver>(parameters(), motors(), period_,
                                                    std::get<std::unique_ptr<DatagramLine>>(board_->driver_end()),
                                                    [this] { return board_->now_ns(); });
  }

  UnitreeLeggedDriver& driver() { return *driver_; }
  const unitree::MotorCommand& ordered(std::size_t joint) const { return board_->command().motors[motor(joint)]; }

  /// The joints are not in the order of the motors.
  static std::size_t motor(std::size_t joint) { return joint == 0 ? 5 : 2; }
  static UnitreeLeggedParameters parameters() {
    UnitreeLeggedParameters parameters{.line = {.address = "none"}, .joints = {}};
    parameters.joints.push_back({.joint = "thigh", .motor = motor(0), .torque_limit = 3, .velocity_limit = 30});
    parameters.joints.push_back({.joint = "knee",
                                 .motor = motor(1),
                                 .direction = -1,
                                 .offset = kOffset,
                                 .torque_limit = 3,
                                 .velocity_limit = 30});
    return parameters;
  }
  static DriveMotors motors() {
    return {.joints = {"thigh", "knee"},
            .effort_limits = {kEffortLimit, kEffortLimit},
            .brakes = {kBrake, kBrake},
            .joint_count = 2};
  }
};

struct UnitreeLegged : testing::TestWithParam<double> {
  void SetUp() override {
    machine_.start();
    ASSERT_EQ(run(0.2).driver_state, DriverState::kRunning) << machine_.warning();
  }
  const SensorFrame& run(double seconds, const JointCommand& command = kTurns) {
    return machine_.cycles(static_cast<int>(std::lround(seconds / machine_.period())), command);
  }
  bool turns() const { return std::abs(machine_.joints[0].velocity) > 0.5; }
  void inject(std::string_view component, std::string_view kind) {
    ASSERT_EQ(machine_.board().inject(component, kind), "");
  }
  /// s from now until the fault, at most 1.
  double time_to_fault() {
    for (int i = 0; i < std::lround(1 / machine_.period()); ++i) {
      if (machine_.cycles(1, kTurns).driver_state == DriverState::kFault) return (i + 1) * machine_.period();
    }
    return INFINITY;
  }
  void expect_runs_after_reset() {
    run(kInFlight);
    machine_.reset();
    EXPECT_EQ(run(1).driver_state, DriverState::kRunning) << machine_.warning();
    EXPECT_TRUE(turns());
  }

  static constexpr double kInFlight = 0.01;  ///< s, after which no datagram of before is on the line
  static constexpr JointCommand kTurns{.mode = JointMode::kVelocity, .velocity = 3, .damping = 0.5};
  Go1InAir machine_{GetParam()};
};

TEST_P(UnitreeLegged, AnImpedanceGoesToTheMotorsAsItIs) {
  run(0.01,
      {.mode = JointMode::kImpedance, .position = 1, .velocity = 2, .stiffness = 30, .damping = 4, .effort = 0.5});
  EXPECT_EQ(machine_.ordered(0).mode, unitree::kServo);
  EXPECT_FLOAT_EQ(machine_.ordered(0).q, 1);
  EXPECT_FLOAT_EQ(machine_.ordered(0).dq, 2);
  EXPECT_EQ(machine_.ordered(0).tau, 0.5);
  EXPECT_EQ(machine_.ordered(0).kp, 30);
  EXPECT_EQ(machine_.ordered(0).kd, 4);
  EXPECT_FLOAT_EQ(machine_.ordered(1).q, -(1 - kOffset));
  EXPECT_FLOAT_EQ(machine_.ordered(1).dq, -2);
  EXPECT_EQ(machine_.ordered(1).tau, -0.5);
  EXPECT_EQ(machine_.ordered(1).kp, 30);
  for (std::size_t motor = 0; motor < unitree::kMotors; ++motor) {
    if (motor == Go1InAir::motor(0) || motor == Go1InAir::motor(1)) continue;
    EXPECT_EQ(machine_.board().command().motors[motor].mode, unitree::kDamping) << motor;
    EXPECT_EQ(machine_.board().command().motors[motor].kp, 0) << motor;
  }
}

TEST_P(UnitreeLegged, AJointMovesOnWithItsVelocityWhileNoStateComes) {
  run(0.5);
  inject("line", "cut");
  const JointSample before = machine_.cycles(2, kTurns).joints[1], held = machine_.cycles(1, kTurns).joints[1];
  EXPECT_GT(std::abs(held.velocity), 0.5);
  EXPECT_GT(before.age_ns, 0);
  EXPECT_EQ(held.velocity, before.velocity);
  EXPECT_NEAR(held.position, before.position + held.velocity * machine_.period(), 1.0e-12);
}

TEST_P(UnitreeLegged, ABrakeDampsWithoutStiffness) {
  run(0.01, {});
  EXPECT_EQ(machine_.ordered(0).mode, unitree::kServo);
  EXPECT_EQ(machine_.ordered(0).kp, 0);
  EXPECT_EQ(machine_.ordered(0).kd, Go1InAir::kBrake.damping);
  EXPECT_EQ(machine_.ordered(0).dq, 0);
  EXPECT_EQ(machine_.ordered(0).tau, 0);
}

TEST_P(UnitreeLegged, AnEffortIsClampedToTheLimitOfTheFile) {
  run(0.01, {.mode = JointMode::kEffort, .effort = 1000});
  EXPECT_EQ(machine_.ordered(0).tau, 3);
  EXPECT_EQ(machine_.ordered(1).tau, -3);
  EXPECT_EQ(machine_.ordered(1).kd, 0);
}

TEST_P(UnitreeLegged, StopSendsTheBrakeAsTheLastDatagram) {
  run(0.1);
  machine_.stop();
  machine_.run_board();
  EXPECT_EQ(machine_.ordered(0).kp, 0);
  EXPECT_EQ(machine_.ordered(0).kd, Go1InAir::kBrake.damping);
  EXPECT_EQ(machine_.ordered(0).dq, 0);
}

TEST_P(UnitreeLegged, TheFrameHasWhatTheRobotMeasures) {
  machine_.board().sense(
      {.angular_velocity = {1, 2, 3}, .linear_acceleration = {4, 5, 6}, .orientation = {0, 1, 0, 0}});
  const SensorFrame& frame = run(0.1, {});  // at rest by then
  EXPECT_NEAR(frame.joints[1].position, machine_.joints[1].position, 1e-6);
  EXPECT_EQ(frame.joints[1].temperature, 40);
  EXPECT_TRUE(joints_have(frame, 2, kValidMotion | kValidTemperature));
  EXPECT_EQ(frame.valid, kValidGyro | kValidAccelerometer | kValidOrientation | kValidBattery);
  EXPECT_EQ(frame.imu.angular_velocity, (Vector3{1, 2, 3}));
  EXPECT_EQ(frame.imu.linear_acceleration, (Vector3{4, 5, 6}));
  EXPECT_EQ(frame.imu.orientation, (Quaternion{0, 1, 0, 0}));
  EXPECT_NEAR(frame.battery_voltage, 6 * 3.84, 1e-9);
  EXPECT_EQ(frame.battery_current, 3) << "discharging";
  EXPECT_EQ(frame.contact_count, 0U);
  EXPECT_EQ(frame.digital_inputs, 0U);
  EXPECT_THAT(machine_.description(), HasSubstr("serial number 1-1"));
}

TEST_P(UnitreeLegged, TheRemoteIsAnEmergencyStop) {
  inject("robot", "e_stop");
  EXPECT_EQ(run(0.01).digital_inputs, kInputEmergencyStop);
  inject("robot", "ok");
  EXPECT_EQ(run(0.01).digital_inputs, 0U);
}

struct Loss {
  const char *component, *kind, *words;
  double limit;  // s, until the fault
};

void PrintTo(const Loss& loss, std::ostream* out) {
  *out << loss.kind;
}

TEST_P(UnitreeLegged, EachLossIsNamedInTimeBrakesAndEndsWithAReset) {
  constexpr double kLost = kLeggedSilence + 0.004, kSeen = 0.01;
  for (const Loss& loss : {Loss{"line", "cut", "is silent: no state", kLost},
                           {"line", "answers_lost", "is silent: no state", kLost},
                           {"line", "answers_late", "is silent: no state", kLost},
                           {"robot", "off", "is silent: no state", kLost},
                           {"robot", "encrypted", "sends messages with a wrong check sum; check", kLost},
                           {"robot", "frozen", "repeats its last state", kLost},
                           {"line", "answers_shifted", "differs from the drive file: beginning of its states", kLost},
                           {"motor", "not_finite", "sent NaN or infinity or a number beyond its range", kLost},
                           {"robot", "other_robot", "sends a state of another robot, by its serial number", kSeen}}) {
    SCOPED_TRACE(loss.kind);
    ASSERT_TRUE(turns());
    inject(loss.component, loss.kind);
    EXPECT_LE(time_to_fault(), loss.limit);
    EXPECT_THAT(machine_.warning(), HasSubstr(loss.words));
    EXPECT_NE(machine_.frame().faults, 0U);
    run(0.5);
    const bool has_power = std::string_view(loss.kind) != "off";
    EXPECT_FALSE(has_power && turns());
    inject(loss.component, "ok");
    EXPECT_EQ(run(1.5).driver_state, DriverState::kFault);
    EXPECT_FALSE(turns());
    expect_runs_after_reset();
  }
}

TEST_P(UnitreeLegged, ARobotThatWasSwitchedOnAgainIsNamed) {
  run(1);
  inject("robot", "reset");
  EXPECT_LE(time_to_fault(), kLeggedSilence + 0.004);
  machine_.reset();  // before it answers again
  run(0.02);
  EXPECT_EQ(machine_.frame().driver_state, DriverState::kStarting);
  EXPECT_EQ(run(1).driver_state, DriverState::kRunning);
}

/// Only the tick shows a restart that is shorter than the allowed silence.
TEST_P(UnitreeLegged, ATickThatGoesBackIsARestart) {
  struct Robot final : DatagramLine {
    std::size_t receive(std::span<std::uint8_t> bytes) noexcept override {
      if (!pending) return 0;
      pending = false;
      std::array<std::uint8_t, unitree::kStateBytes> all;
      state.battery.charge = 50;
      encode(state, all);
      std::ranges::copy(all, bytes.begin());
      return all.size();
    }
    bool send(std::span<const std::uint8_t>) noexcept override { return pending = answers; }
    std::string name() const override { return "a line"; }
    unitree::LowState state;
    bool pending = false, answers = true;
  };
  auto line = std::make_unique<Robot>();
  Robot& robot = *line;
  std::int64_t now_ns = 0;
  UnitreeLeggedDriver driver(Go1InAir::parameters(), Go1InAir::motors(), 0.002, std::move(line),
                             [&] { return now_ns; });
  SensorFrame frame;
  const auto cycle = [&](std::uint32_t tick) {
    now_ns += 2'000'000;
    robot.state.tick = tick;
    driver.write({});
    driver.read(frame);
  };
  driver.start();
  for (std::uint32_t i = 0; i < 10; ++i) cycle(0xFFFFFFFB + i);  // the tick wraps
  EXPECT_EQ(frame.driver_state, DriverState::kRunning);
  cycle(3);  // overtaken
  EXPECT_EQ(frame.links[0].late, 1U);
  cycle(6);
  EXPECT_EQ(frame.driver_state, DriverState::kRunning);
  for (std::uint32_t i = 0; i < 11; ++i) cycle(0x80000100 + i);
  EXPECT_EQ(frame.driver_state, DriverState::kFault);
  EXPECT_THAT(driver.warning(), HasSubstr("was switched on again"));
  driver.reset();
  cycle(0x80000200);
  EXPECT_EQ(frame.driver_state, DriverState::kRunning);
  robot.state.motors[Go1InAir::motor(0)].q = 1;
  cycle(0x80000201);
  EXPECT_EQ(frame.driver_state, DriverState::kFault);
  EXPECT_THAT(driver.warning(), AllOf(HasSubstr("reports a jump of its position"), HasSubstr("thigh")));
  driver.reset();
  for (const std::uint32_t tick : {0x80000300U, 0x80000300U}) cycle(tick);  // the second one is a copy
  robot.answers = false;
  for (int i = 0; i < 11; ++i) cycle(0);
  EXPECT_THAT(driver.warning(), HasSubstr("is silent: no state")) << "the copy came long before";
}

TEST_P(UnitreeLegged, AHotMotorAndALowBatteryAreNamedAndTheMotorsObey) {
  inject("motor", "hot");
  EXPECT_LE(time_to_fault(), 0.3);
  EXPECT_THAT(machine_.warning(), HasSubstr("is too hot: motor of thigh, 110 instead of 80"));
  EXPECT_NE(machine_.frame().joints[0].fault, 0U);
  EXPECT_EQ(machine_.frame().joints[1].fault, 0U);
  run(0.5);
  EXPECT_TRUE(turns());
  EXPECT_TRUE(joints_have(machine_.frame(), 2, kValidKinematics));
  inject("motor", "ok");
  expect_runs_after_reset();
  inject("robot", "low_battery");
  EXPECT_LE(time_to_fault(), 0.3);
  EXPECT_THAT(machine_.warning(), HasSubstr("has a low supply: charge in %, 1 instead of 10"));
  run(0.5);
  EXPECT_TRUE(turns());
}

TEST_P(UnitreeLegged, ARobotWhoseCheckSumsAreEncryptedIsRefused) {
  inject("robot", "encrypted");
  run(kInFlight);
  machine_.driver().start();
  EXPECT_EQ(run(0.1).driver_state, DriverState::kFault);
  EXPECT_THAT(machine_.warning(), HasSubstr("its firmware encrypts them, which is not supported"));
}

TEST_P(UnitreeLegged, AnAbsentRobotIsAwaitedWithTheKeysOfTheRemote) {
  inject("robot", "off");
  run(kInFlight);
  machine_.driver().start();
  EXPECT_EQ(run(1).driver_state, DriverState::kStarting);
  EXPECT_THAT(machine_.warning(), HasSubstr("L2 and A, L2 and B"));
}

TEST_P(UnitreeLegged, LostAndLateDatagramsStopNothing) {
  inject("line", "disturbed");
  EXPECT_EQ(run(60).driver_state, DriverState::kRunning) << machine_.warning();
  EXPECT_TRUE(turns());
  EXPECT_GT(machine_.frame().links[0].lost, 100U);
}

TEST_P(UnitreeLegged, ReadAndWriteDoNotAllocate) {
  SensorFrame frame;
  const std::vector<JointCommand> commands(2, kTurns);
  run(0.1);
  for (const char* kind : {"ok", "encrypted"}) {
    inject("robot", kind);
    run(0.004);
    const AllocationGuard guard;
    for (int i = 0; i < 100; ++i) {
      machine_.driver().read(frame);
      machine_.driver().write(commands);
    }
    EXPECT_EQ(guard.count(), 0U);
  }
}

INSTANTIATE_TEST_SUITE_P(Rates, UnitreeLegged, testing::Values(500.0, 1000.0));

TEST(UnitreeLeggedUdp, TheRobotOfAnotherProgramIsFoundOnTheLoopback) {
  constexpr double kPeriod = 0.002;
  const std::string address = "127.0.0.1:" + std::to_string(free_port());
  UnitreeLeggedFront robot(Go1InAir::parameters(), kPeriod, 1, UdpSocket::device_end(address));
  UnitreeLeggedDriver driver(Go1InAir::parameters(), Go1InAir::motors(), kPeriod,
                             UdpSocket::host_end(address, free_port()), [&] { return robot.now_ns(); });
  const std::vector<JointSample> joints(2, {.position = 0.5});
  SensorFrame frame;
  driver.start();
  for (int i = 0; i < 100; ++i) {
    driver.read(frame);
    driver.write(std::vector<JointCommand>(2, {.mode = JointMode::kEffort, .effort = 2}));
    robot.run(joints);
  }
  EXPECT_EQ(frame.driver_state, DriverState::kRunning) << driver.warning();
  EXPECT_NEAR(frame.joints[1].position, 0.5, 1e-6);
  EXPECT_EQ(robot.torque(1), 2);
  EXPECT_LE(frame.links[0].lost, 1U);
}

/// Mutated states pass into the driver.
void expect_no_motion_of_the_go1(int datagrams) {
  Go1InAir machine(500);
  machine.start();
  machine.cycles(10);
  DatagramLine& robot = machine.board().line().device_end();
  unitree::RandomMessages random(3);
  for (int i = 0; i < datagrams; ++i) {
    std::array<std::uint8_t, unitree::kStateBytes> bytes{};
    encode(random.state(), bytes);
    for (auto changes = random.raw() % 4; changes > 0; --changes)
      bytes[random.raw() % bytes.size()] ^= static_cast<std::uint8_t>(1U << random.raw() % 8);
    robot.send(std::span(bytes).first(random.raw() % 8 == 0 ? random.raw() % bytes.size() : bytes.size()));
    machine.cycles(1);
    ASSERT_LT(std::abs(machine.joints[0].velocity), 0.1) << i;
    for (std::size_t joint = 0; joint < 2; ++joint) ASSERT_TRUE(std::isfinite(machine.frame().joints[joint].position));
    if (i % 100 == 0) machine.reset();
  }
  machine.cycles(20);
  machine.reset();
  EXPECT_EQ(machine.cycles(500).driver_state, DriverState::kRunning) << machine.warning();
}

TEST(UnitreeLeggedFuzz, MutatedStatesMoveNothing) {
  expect_no_motion_of_the_go1(10'000);
}

TEST(UnitreeLeggedFuzz, NightlyAMillionMutatedStatesMoveNothing) {
  expect_no_motion_of_the_go1(1'000'000);
}

}  // namespace robot_control::tests

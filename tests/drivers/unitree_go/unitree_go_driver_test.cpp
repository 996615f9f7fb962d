/// The driver of a Go2 before its simulated robot and the bridge, in virtual time: one joint in the air. The common
/// part of it and of the driver of a Go1 is in unitree_legged_driver_test.cpp.

#include <gtest/gtest.h>

#include <cmath>

#include "drivers/unitree/unitree_driver.h"
#include "drivers/unitree/unitree_front.h"
#include "drivers/unitree_go/go2.h"
#include "drivers/unitree_go/random_messages.h"
#include "drivers/wheels_in_air.h"
#include "support/allocation_guard.h"
#include "support/matchers.h"

namespace robot_control::tests {

namespace go = unitree::go;

constexpr std::size_t kMotor = 5;

class Go2InAir final : public WheelsInAir<UnitreeFront<Go2>, UnitreeDriver<Go2>> {
 public:
  explicit Go2InAir(double rate, const UnitreeGoLine& line = {}) : WheelsInAir(1 / rate, 1) {
    const UnitreeParameters<Go2> parameters{
        .line = line, .joints = {{.joint = "thigh", .motor = kMotor, .torque_limit = 3, .velocity_limit = 30}}};
    const DriveMotors motors{
        .joints = {"thigh"}, .effort_limits = {kEffortLimit}, .brakes = {kBrake}, .joint_count = 1};
    board_ = std::make_unique<UnitreeFront<Go2>>(parameters, period_, 1, nullptr);
    driver_ = std::make_unique<UnitreeDriver<Go2>>(parameters, motors, period_,
                                                   std::get<std::unique_ptr<DatagramLine>>(board_->driver_end()),
                                                   [this] { return board_->now_ns(); });
  }
  UnitreeDriver<Go2>& driver() { return *driver_; }
};

struct UnitreeGo : testing::TestWithParam<double> {
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

  static constexpr double kInFlight = 0.01;            ///< s, after which no datagram of before is on the line
  static constexpr double kLost = kGoSilence + 0.006;  ///< s, of which a state on the line takes one cycle of 2 ms
  static constexpr JointCommand kTurns{.mode = JointMode::kVelocity, .velocity = 3, .damping = 0.5};
  Go2InAir machine_{GetParam()};
};

TEST_P(UnitreeGo, AnImpedanceGoesToTheMotorAsItIs) {
  run(0.01,
      {.mode = JointMode::kImpedance, .position = 1, .velocity = 2, .stiffness = 30, .damping = 4, .effort = 0.5});
  const unitree::MotorCommand& ordered = machine_.board().command().motors[kMotor];
  EXPECT_EQ(ordered.mode, go::kServo);
  EXPECT_FLOAT_EQ(ordered.q, 1);
  EXPECT_FLOAT_EQ(ordered.dq, 2);
  EXPECT_EQ(ordered.tau, 0.5);
  EXPECT_EQ(ordered.kp, 30);
  EXPECT_EQ(ordered.kd, 4);
}

TEST_P(UnitreeGo, TheFrameHasWhatTheRobotMeasures) {
  machine_.board().sense(
      {.angular_velocity = {1, 2, 3}, .linear_acceleration = {4, 5, 6}, .orientation = {0, 1, 0, 0}});
  const SensorFrame& frame = run(0.1, {});  // at rest by then
  EXPECT_NEAR(frame.joints[0].position, machine_.joints[0].position, 1e-6);
  EXPECT_EQ(frame.joints[0].temperature, 40);
  EXPECT_EQ(frame.imu.orientation, (Quaternion{0, 1, 0, 0}));
  EXPECT_NEAR(frame.battery_voltage, 28.8, 1e-5);
  EXPECT_EQ(frame.battery_current, 3) << "discharging";
  EXPECT_EQ(frame.links[0].lost, 0U) << "it sends at 500 Hz";
  EXPECT_EQ(frame.digital_inputs, 0U);
  inject("robot", "e_stop");
  EXPECT_EQ(run(0.01).digital_inputs, kInputEmergencyStop);
}

struct GoLoss {
  const char *component, *kind, *words;
  double limit;  // s, until the fault
  bool obeys = false;
};

TEST_P(UnitreeGo, EachLossIsNamedInTimeAndEndsWithAReset) {
  constexpr double kSeen = 0.01;
  for (const GoLoss& loss :
       {GoLoss{"line", "cut", "has lost its bridge (process 1 ", kLost},
        GoLoss{"bridge", "off", "has lost its bridge", kLost}, GoLoss{"robot", "off", "is silent: no state", kLost},
        GoLoss{"robot", "encrypted", "wrong check sum", kLost},
        GoLoss{"robot", "frozen", "repeats its last state", kLost},
        GoLoss{"line", "answers_shifted", "differs from the drive file", kLost},
        GoLoss{"motor", "not_finite", "sent NaN or infinity", kLost},
        GoLoss{"robot", "other_robot", "sends a state of another robot", kSeen},
        GoLoss{"bridge", "asked", "waits for the motion service of its maker to answer", kSeen},
        GoLoss{"bridge", "second_writer", "it has not sent yet, number of writers, 1 instead of 0", kSeen, true},
        GoLoss{"bridge", "other_commands", "is commanded by another program, with frame LowCmd; stop", kSeen, true},
        GoLoss{"bridge", "other_states", "sends a state of another robot, by a second writer of rt/lowstate", kSeen},
        GoLoss{"motor", "hot", "is too hot: motor of thigh", kSeen, true},
        GoLoss{"robot", "low_battery", "has a low supply: charge in %, 1 instead of 10", kSeen, true}}) {
    SCOPED_TRACE(loss.kind);
    ASSERT_TRUE(turns());
    inject(loss.component, loss.kind);
    EXPECT_LE(time_to_fault(), loss.limit);
    EXPECT_THAT(machine_.warning(), HasSubstr(loss.words));
    run(0.5);
    const bool has_power = loss.component != std::string_view("robot") || loss.kind != std::string_view("off");
    EXPECT_EQ(turns() && has_power, loss.obeys);
    inject(loss.component, "ok");
    EXPECT_EQ(run(1.5).driver_state, DriverState::kFault);
    run(kInFlight);
    machine_.reset();
    EXPECT_EQ(run(1).driver_state, DriverState::kRunning) << machine_.warning();
    EXPECT_TRUE(turns());
  }
}

TEST_P(UnitreeGo, ItWaitsForTheMotionServiceWithItsMode) {
  inject("bridge", "active");
  run(kInFlight);
  machine_.driver().start();
  EXPECT_EQ(run(1).driver_state, DriverState::kStarting);
  EXPECT_THAT(machine_.warning(), AllOf(HasSubstr("to be released (mode mcf)"), HasSubstr("release_service")));
  EXPECT_FALSE(turns());
  inject("bridge", "ok");
  EXPECT_EQ(run(1).driver_state, DriverState::kRunning);
  inject("bridge", "no_answer");
  run(kInFlight);
  machine_.driver().start();
  EXPECT_EQ(run(0.1).driver_state, DriverState::kFault);
  EXPECT_THAT(machine_.warning(), HasSubstr("set has_service: false"));
}

TEST_P(UnitreeGo, ItWaitsUntilItsRobotIsAlone) {
  inject("bridge", "other_states");
  run(kInFlight);
  machine_.driver().start();
  EXPECT_EQ(run(1).driver_state, DriverState::kStarting);
  EXPECT_THAT(machine_.warning(), AllOf(HasSubstr("a state of another robot"), HasSubstr("connect only one robot")));
  EXPECT_FALSE(turns());
  inject("bridge", "ok");
  EXPECT_EQ(run(1).driver_state, DriverState::kRunning);
}

TEST_P(UnitreeGo, AnAbsentBridgeIsAwaited) {
  Go2InAir absent(GetParam());
  EXPECT_EQ(absent.board().inject("bridge", "off"), "");
  absent.driver().start();
  EXPECT_EQ(absent.cycles(100).driver_state, DriverState::kStarting);
  EXPECT_THAT(absent.warning(), AllOf(HasSubstr("has lost its bridge"), HasSubstr("(not started)")));
}

TEST_P(UnitreeGo, WritersThatNeverSendMayBeAllowed) {
  Go2InAir machine(GetParam(), {.other_writers = 1});
  EXPECT_EQ(machine.board().inject("bridge", "second_writer"), "");
  machine.start();
  EXPECT_EQ(machine.cycles(100).driver_state, DriverState::kRunning) << machine.warning();
}

TEST_P(UnitreeGo, ReadAndWriteDoNotAllocate) {
  SensorFrame frame;
  const std::vector<JointCommand> commands(1, kTurns);
  run(0.1);
  for (const char* kind : {"ok", "off"}) {
    inject("bridge", kind);
    run(0.004);
    const AllocationGuard guard;
    for (int i = 0; i < 100; ++i) {
      machine_.driver().read(frame);
      machine_.driver().write(commands);
    }
    EXPECT_EQ(guard.count(), 0U);
  }
}

INSTANTIATE_TEST_SUITE_P(Rates, UnitreeGo, testing::Values(500.0, 1000.0));

/// Mutated datagrams of the bridge pass into the driver.
void expect_no_motion_of_the_go2(int datagrams) {
  Go2InAir machine(500);
  machine.start();
  machine.cycles(10);
  DatagramLine& robot = machine.board().line().device_end();
  go::RandomMessages random(3);
  for (int i = 0; i < datagrams; ++i) {
    std::array<std::uint8_t, go::kReportBytes + go::kStateBytes> bytes{};
    go::write_report({.process = 1, .service = go::MotionService::kFree}, bytes);
    encode(random.state(), std::span(bytes).subspan<go::kReportBytes>());
    for (auto changes = random.raw() % 4; changes > 0; --changes)
      bytes[random.raw() % bytes.size()] ^= static_cast<std::uint8_t>(1U << random.raw() % 8);
    robot.send(std::span(bytes).first(random.raw() % 8 == 0 ? random.raw() % bytes.size() : bytes.size()));
    machine.cycles(1);
    ASSERT_LT(std::abs(machine.joints[0].velocity), 0.1) << i;
    ASSERT_TRUE(std::isfinite(machine.frame().joints[0].position));
    if (i % 100 == 0) machine.reset();
  }
  machine.cycles(20);
  machine.reset();
  EXPECT_EQ(machine.cycles(500).driver_state, DriverState::kRunning) << machine.warning();
}

TEST(UnitreeGoFuzz, MutatedDatagramsMoveNothing) {
  expect_no_motion_of_the_go2(10'000);
}

TEST(UnitreeGoFuzz, NightlyAMillionMutatedDatagramsMoveNothing) {
  expect_no_motion_of_the_go2(1'000'000);
}

}  // namespace robot_control::tests

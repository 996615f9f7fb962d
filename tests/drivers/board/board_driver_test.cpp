#include "drivers/board/board_driver.h"

#include <algorithm>
#include <cmath>

#include "drivers/board/board_machine.h"
#include "drivers/board/mutated_stream.h"
#include "support/allocation_guard.h"
#include "support/matchers.h"
#include "support/message_of.h"

namespace robot_control::tests {

/// The healthy board at 500 Hz, whose wheels turn at 10 rad/s.
struct BoardDriverTest : testing::Test {
  static constexpr double kSpeed = 10;        // rad/s
  static constexpr int kWatchdogCycles = 26;  // 50 ms and one cycle at 500 Hz

  void SetUp() override { begin(); }

  void begin() {
    machine_.start();
    cycles(500);
    ASSERT_EQ(frame_.driver_state, DriverState::kRunning) << machine_.warning();
    ASSERT_NEAR(machine_.joints[0].velocity, kSpeed, 0.5);
  }

  void cycles(int count) { machine_.cycles(count, command_); }

  bool turns() const { return std::abs(machine_.joints[0].velocity) > 1; }

  void inject(const char* component, const char* kind) { ASSERT_EQ(machine_.board().inject(component, kind), ""); }

  BoardMachine machine_{500};
  const SensorFrame& frame_ = machine_.frame();
  const JointCommand command_{.mode = JointMode::kVelocity, .velocity = kSpeed, .damping = 0.2};
};

TEST_F(BoardDriverTest, ReportsPositionAndVelocityOfTheJointAtTheTimeOfRead) {
  SensorFrame frame;
  machine_.read(frame);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(frame.joints[i].position, machine_.joints[i].position, 1.0e-3) << i;  // 2.6 counts
    EXPECT_NEAR(frame.joints[i].velocity, machine_.joints[i].velocity, 0.1) << i;     // 1 count in 4 ms
    EXPECT_EQ(frame.joints[i].valid, kValidMotion) << i;
  }
}

TEST_F(BoardDriverTest, AnEffortThatTheBoardDoesNotMeasureIsNotInvented) {
  machine_.board().sensors().valid = 0;
  cycles(10);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(frame_.joints[i].valid, kValidKinematics) << i;
    EXPECT_TRUE(std::isnan(frame_.joints[i].effort)) << i;
  }
}

TEST_F(BoardDriverTest, TakesTorquesAlone) {
  EXPECT_TRUE(machine_.accepts(JointMode::kEffort));
  EXPECT_FALSE(machine_.accepts(JointMode::kDriveVelocity));
}

TEST_F(BoardDriverTest, NothingOfOneCycleAllocates) {
  SensorFrame frame;
  std::uint64_t count = 0;
  for (int i = 0; i < 100; ++i) {
    const AllocationGuard guard;
    machine_.driver().read(frame);
    count += guard.count();
    cycles(1);
  }
  EXPECT_EQ(count, 0u);
}

TEST_F(BoardDriverTest, ALineThatIsCutBrakesTheBoardByItsWatchdogAndIsAFaultUntilTheReset) {
  inject("line", "cut");
  cycles(kWatchdogCycles + 100);
  EXPECT_FALSE(turns());
  EXPECT_EQ(frame_.faults, kFaultLink);
  EXPECT_EQ(frame_.joints[0].valid, 0u);
  EXPECT_EQ(frame_.links[0].state, LinkState::kDown);
  EXPECT_THAT(machine_.warning(), HasSubstr("is silent: no device on the line"));
  inject("line", "ok");
  cycles(100);
  EXPECT_EQ(frame_.driver_state, DriverState::kFault);
  EXPECT_FALSE(turns()) << "plugged in again it stays braked";
  machine_.reset();
  cycles(500);
  EXPECT_EQ(frame_.driver_state, DriverState::kRunning) << machine_.warning();
  EXPECT_TRUE(turns());
}

TEST_F(BoardDriverTest, StandsHalfASecondAfterItsAnswersFailAndThroughAReset) {
  for (const AnswerFault fault :
       {AnswerFault::kLost, AnswerFault::kDamaged, AnswerFault::kShifted, AnswerFault::kLate}) {
    SCOPED_TRACE(std::string(kAnswerFaults[static_cast<std::size_t>(fault)]));
    machine_.board().line().faults().answers = fault;
    cycles(250);
    EXPECT_FALSE(turns());
    cycles(2000);
    machine_.reset();
    cycles(2000);
    EXPECT_FALSE(turns());
    machine_.board().line().faults().answers = AnswerFault::kNone;
    cycles(1000);
    machine_.reset();
    cycles(1000);
    ASSERT_TRUE(turns()) << machine_.warning();
  }
}

/// At 100 Hz the watchdog of 50 ms expires before 12 reports are missing.
TEST(BoardAt100Hz, NamesABrakeByItselfAlsoIfItsFirstReportIsLost) {
  BoardMachine machine(100);
  machine.start();
  SensorFrame frame;
  const std::vector<JointCommand> commands(2, {.mode = JointMode::kVelocity, .velocity = 5, .damping = 0.1});
  for (int i = 0; i < 107; ++i) {
    ASSERT_EQ(machine.board().inject("line", i < 100 ? "ok" : "stalled"), "");
    ASSERT_EQ(machine.cycles(1, commands[0]).driver_state, DriverState::kRunning) << i << machine.warning();
  }
  ASSERT_EQ(machine.board().inject("line", "answers_lost"), "");
  machine.write(commands);
  ASSERT_EQ(machine.board().inject("line", "ok"), "");
  for (int i = 0; i < 3; ++i) {
    machine.write(commands);
    machine.read(frame);
  }
  EXPECT_EQ(frame.driver_state, DriverState::kFault);
  EXPECT_THAT(machine.warning(), HasSubstr("braked by itself"));
}

/// At 30 Hz a board has restarted before 12 reports are missing.
TEST(BoardAt30Hz, NamesARestartAndNotTheBrakeOfItsStart) {
  BoardMachine machine(30);
  machine.start();
  const JointCommand command{.mode = JointMode::kEffort, .effort = 0};
  ASSERT_EQ(machine.cycles(60, command).driver_state, DriverState::kRunning) << machine.warning();
  ASSERT_EQ(machine.board().inject("board", "brown_out"), "");
  EXPECT_EQ(machine.cycles(20, command).driver_state, DriverState::kFault);
  EXPECT_THAT(machine.warning(), HasSubstr("was switched on again after its supply was too low"));
}

TEST_F(BoardDriverTest, EveryLossIsAFaultWithItsCauseAndStandsUntilTheReset) {
  struct Loss {
    const char* component;
    const char* kind;
    const char* words;
  };
  for (const Loss& loss :
       {Loss{"board", "off", "is silent: no message"}, Loss{"board", "reset", "is silent: no message"},
        Loss{"board", "brown_out", "is silent: no message"},
        Loss{"board", "fault", "reports an error: fault word of right"},
        Loss{"board", "other_protocol", "version of the protocol, 2 instead of 1"},
        Loss{"line", "stalled", "is silent: no message"}}) {
    SCOPED_TRACE(loss.kind);
    inject(loss.component, loss.kind);
    cycles(300);
    EXPECT_EQ(frame_.driver_state, DriverState::kFault);
    EXPECT_TRUE(!turns() || machine_.board().torque(0) == 0) << "braked, or without supply";
    EXPECT_THAT(machine_.warning(), HasSubstr(loss.words));
    inject(loss.component, "ok");
    cycles(300);
    EXPECT_EQ(frame_.driver_state, DriverState::kFault);
    machine_.reset();
    cycles(1000);
    EXPECT_EQ(frame_.driver_state, DriverState::kRunning) << machine_.warning();
    EXPECT_TRUE(turns());
  }
}

TEST_F(BoardDriverTest, ThePressedButtonAndTheBrokenWireAreTheEmergencyStopWithinThreeCycles) {
  EXPECT_EQ(frame_.digital_inputs, 0u);
  for (int trial = 0; trial < 100; ++trial) {
    inject("board", "e_stop");
    int needed = 0;
    while (frame_.digital_inputs != kInputEmergencyStop && needed < 10) {
      cycles(1);
      ++needed;
    }
    ASSERT_LE(needed, 3);
    inject("board", "ok");
    cycles(3 + trial % 3);
    ASSERT_EQ(frame_.digital_inputs, 0u);
  }
}

TEST_F(BoardDriverTest, LostDamagedAndLateMessagesStopNothingAndNoWrongValueIsAccepted) {
  inject("line", "disturbed");
  for (int i = 0; i < 5000; ++i) {
    const double position = machine_.joints[0].position;
    cycles(1);
    ASSERT_EQ(frame_.driver_state, DriverState::kRunning) << machine_.warning();
    // In 8 missing periods of 2 ms at 10 rad/s the velocity's error moves the position by less than 0.01 rad.
    ASSERT_NEAR(frame_.joints[0].position, position, 0.01) << i;
  }
  EXPECT_GT(frame_.links[0].lost, 300u);   // 10 % of 5000
  EXPECT_GT(frame_.links[0].errors, 10u);  // 1 % of those that came
}

TEST_F(BoardDriverTest, ASampleHasItsOwnTimeThoughTheLineIsLateAndTheClockDrifts) {
  inject("line", "late");
  std::vector<double> errors;
  for (int i = 0; i < 5000; ++i) {
    cycles(1);
    const double true_position = machine_.joints[0].position;
    const double reported = frame_.joints[0].position + machine_.joints[0].velocity * machine_.period();
    if (i > 2500) errors.push_back(std::abs(reported - true_position) / kSpeed);
  }
  std::ranges::sort(errors);
  EXPECT_LT(errors[errors.size() / 2], 100.0e-6);
  EXPECT_NEAR(machine_.driver().board_clock().drift(), -1.0e-6 * BoardFront::kClockPpm, 40.0e-6);
}

TEST_F(BoardDriverTest, BatteryTemperatureAndImuReachTheFrame) {
  board_sensors& sensors = machine_.board().sensors();
  sensors.valid = BOARD_HAS_BATTERY | BOARD_HAS_TEMPERATURE | BOARD_HAS_IMU;
  sensors.battery_mv = 24500;
  sensors.battery_ca = -150;
  sensors.temperature_dc = 415;
  sensors.imu.angular_velocity[2] = -250'000;
  sensors.imu.linear_acceleration[2] = 9'806'650;
  cycles(5);
  EXPECT_EQ(frame_.valid, kValidBattery | kValidGyro | kValidAccelerometer);
  EXPECT_DOUBLE_EQ(frame_.battery_voltage, 24.5);
  EXPECT_DOUBLE_EQ(frame_.battery_current, -1.5);
  EXPECT_DOUBLE_EQ(frame_.imu.angular_velocity[2], -0.25);
  EXPECT_NEAR(frame_.imu.linear_acceleration[2], 9.80665, 1.0e-12);
  EXPECT_NEAR(frame_.joints[1].temperature, 41.5, 1.0e-12);
  EXPECT_EQ(frame_.joints[0].valid, kValidPosition | kValidVelocity | kValidTemperature) << "no torque was measured";
}

TEST(BoardCounters, WrapUnnoticed) {
  for (const auto& [bits, zero] : {std::pair{16U, 65000U}, std::pair{32U, 0xFFFFFF00U}}) {
    BoardMachine machine(500, bits, zero);
    machine.start();
    SensorFrame frame;
    const std::vector<JointCommand> commands(2, {.mode = JointMode::kVelocity, .velocity = 50, .damping = 0.2});
    machine.read(frame);
    const double begin = frame.joints[0].position - machine.joints[0].position;
    for (int i = 0; i < 1500; ++i) {
      machine.write(commands);
      machine.read(frame);
      ASSERT_EQ(frame.driver_state, DriverState::kRunning) << machine.warning();
      ASSERT_NEAR(frame.joints[0].position - machine.joints[0].position, begin, 0.02) << bits << ' ' << i;
    }
    EXPECT_GT(machine.joints[0].position, 50);  // 130 000 counts
  }
}

TEST(BoardLine, IsRefusedIfItCannotCarryTheMessages) {
  EXPECT_NO_THROW(BoardMachine(500, 32, 0, 921600));
  EXPECT_THAT(message_of<DriverError>([] { BoardMachine(500, 32, 0, 115200); }),
              AllOf(HasSubstr("115200 bit/s"), HasSubstr("at most 126 Hz")));
}

class MutatedBoard final : public MutatedLine {
 public:
  bool send(std::span<const std::uint8_t> order) noexcept override {
    board_report report{};
    report.wheels = 2;
    report.cycle = static_cast<std::uint16_t>(orders_++);
    report.sensors.valid = BOARD_HAS_EFFORT | BOARD_HAS_IMU;
    std::vector<std::uint8_t> body(BOARD_MAX_BODY);
    std::vector<std::uint8_t> frame(BOARD_MAX_FRAME);
    frame.resize(board_encode(body.data(), board_write_report(&report, body.data()), frame.data()));
    answer(frame);
    board_decoder decoder{};
    for (const std::uint8_t byte : order) {
      const std::uint8_t size = board_decode(&decoder, byte);
      board_order decoded{};
      if (size == 0 || board_read_order(decoder.body, size, &decoded) == 0) continue;
      for (std::size_t i = 0; i < decoded.wheels; ++i) driven += decoded.wheel[i].mode != BOARD_BRAKE ? 1 : 0;
    }
    return true;
  }

 private:
  int orders_ = 1;
};

void expect_no_motion(int streams) {
  BoardParameters parameters{.line = {.address = "none", .e_stop_input = false}, .wheels = {}};
  for (std::uint64_t i = 0; i < 2; ++i) {
    parameters.wheels.push_back(
        {.joint = "joint", .wheel = i, .counts_per_turn = 4096, .torque_limit = 3, .velocity_limit = 30});
  }
  auto owned = std::make_unique<MutatedBoard>();
  const MutatedBoard& line = *owned;
  std::int64_t now_ns = 0;
  BoardDriver driver(parameters, std::vector<Brake>(2, Brake{}), 2, 0.002, std::move(owned), [&] { return now_ns; });
  driver.start();
  SensorFrame frame;
  for (int i = 0; i < streams; ++i) {
    now_ns += 2'000'000;
    driver.read(frame);
    ASSERT_NE(frame.driver_state, DriverState::kRunning) << i;
    ASSERT_EQ(frame.joints[0].valid, 0U) << i;
    driver.write(std::vector<JointCommand>(2, {.mode = JointMode::kEffort, .effort = 1}));
    driver.reset();
  }
  EXPECT_EQ(line.driven, 0);
  EXPECT_GT(frame.links[0].errors, static_cast<std::uint64_t>(streams) / 2);
}

TEST(BoardFuzz, NoStreamOfBytesIsAReportUnlessItIsWhole) {
  expect_no_motion(20'000);
}

TEST(BoardFuzz, NightlyNoneOfAMillionStreamsIsAReport) {
  expect_no_motion(1'000'000);
}

}  // namespace robot_control::tests

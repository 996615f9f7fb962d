#include <array>
#include <cmath>

#include "drivers/board/mutated_stream.h"
#include "drivers/roboclaw/roboclaw_machine.h"
#include "support/allocation_guard.h"
#include "support/matchers.h"

namespace robot_control::tests {

using roboclaw::PacketCommand;

/// The healthy board at 1 kHz, whose wheels turn at 10 rad/s.
struct RoboclawDriverTest : testing::Test {
  static constexpr double kSpeed = 10;  // rad/s

  void SetUp() override {
    machine_.start();
    cycles(1000);
    ASSERT_EQ(frame_.driver_state, DriverState::kRunning) << machine_.warning();
    ASSERT_TRUE(turns());
  }
  void cycles(int count) { machine_.cycles(count, command_); }
  bool turns() const {
    return std::abs(machine_.joints[0].velocity - kSpeed) < 0.5 && std::abs(machine_.joints[1].velocity - kSpeed) < 0.5;
  }
  bool stands() const {
    return std::abs(machine_.joints[0].velocity) < 0.2 && std::abs(machine_.joints[1].velocity) < 0.2;
  }
  void inject(const char* component, const char* kind) { ASSERT_EQ(machine_.board().inject(component, kind), ""); }
  void expect_fault(const char* words) {
    EXPECT_EQ(frame_.driver_state, DriverState::kFault);
    EXPECT_THAT(machine_.warning(), HasSubstr(words));
  }

  RoboclawMachine machine_{1000};
  const SensorFrame& frame_ = machine_.frame();
  JointCommand command_{.mode = JointMode::kDriveVelocity, .velocity = kSpeed};
};

TEST_F(RoboclawDriverTest, PositionAndSpeedAreThoseOfTheJointAndNoTorqueIsInvented) {
  for (int i = 0; i < 100; ++i) {
    const std::vector<JointSample> joints = machine_.joints;
    cycles(1);
    for (std::size_t joint = 0; joint < 2; ++joint) {
      ASSERT_NEAR(frame_.joints[joint].position, joints[joint].position, 0.003);
      ASSERT_NEAR(frame_.joints[joint].velocity, joints[joint].velocity, 0.1);
      ASSERT_TRUE(std::isnan(frame_.joints[joint].effort));
      ASSERT_EQ(frame_.joints[joint].valid & kValidMotion, kValidKinematics);
      ASSERT_LE(frame_.joints[joint].age_ns, 10'000'000);
    }
  }
  EXPECT_NEAR(frame_.battery_voltage, 24.2, 1.0e-9);
  EXPECT_NEAR(frame_.joints[0].temperature, 35.5, 1.0e-9);
}

TEST_F(RoboclawDriverTest, TakesSpeedsAloneAndBrakesWithTheSpeedZero) {
  EXPECT_TRUE(machine_.accepts(JointMode::kDriveVelocity));
  EXPECT_FALSE(machine_.accepts(JointMode::kEffort));
  EXPECT_FALSE(machine_.measures(MachineInput::kJointEffort));
  for (const JointCommand& command :
       {JointCommand{}, JointCommand{.mode = JointMode::kEffort, .velocity = 5, .effort = 1},
        JointCommand{.mode = JointMode::kDriveVelocity, .velocity = std::numeric_limits<double>::quiet_NaN()}}) {
    command_ = command;
    cycles(1500);
    EXPECT_TRUE(stands());
    command_ = {.mode = JointMode::kDriveVelocity, .velocity = kSpeed};
    cycles(1500);
    EXPECT_TRUE(turns());
  }
  machine_.stop();
  cycles(1500);
  EXPECT_TRUE(stands());
}

TEST_F(RoboclawDriverTest, NothingOfOneCycleAllocates) {
  SensorFrame frame;
  std::uint64_t count = 0;
  for (int i = 0; i < 200; ++i) {
    const AllocationGuard guard;
    machine_.driver().read(frame);
    count += guard.count();
    cycles(1);
  }
  EXPECT_EQ(count, 0u);
}

TEST_F(RoboclawDriverTest, AHostThatEndsLeavesTheMotorsStoppedAfterTheBoardsTimeout) {
  for (int i = 0; i < 1000; ++i) machine_.run_board();
  EXPECT_TRUE(stands());
}

TEST_F(RoboclawDriverTest, EveryLossIsAFaultWithItsCauseAndStandsUntilTheReset) {
  struct Loss {
    const char* component;
    const char* kind;
    const char* words;
  };
  for (const Loss& loss :
       {Loss{"line", "cut", "is silent: no device on the line"}, Loss{"line", "stalled", "is silent: no message"},
        Loss{"board", "off", "is silent: no message"}, Loss{"board", "reset", "is silent: no message"},
        Loss{"board", "fault", "reports an error: temperature 1"},
        Loss{"encoder", "stuck", "does not turn although it is driven"}}) {
    SCOPED_TRACE(loss.kind);
    inject(loss.component, loss.kind);
    cycles(1500);
    expect_fault(loss.words);
    EXPECT_TRUE(stands() || machine_.board().torque(0) == 0) << "braked, or without supply";
    inject(loss.component, "ok");
    cycles(500);
    EXPECT_EQ(frame_.driver_state, DriverState::kFault);
    EXPECT_FALSE(turns()) << "plugged in again it stays braked";
    machine_.reset();
    cycles(2500);
    EXPECT_EQ(frame_.driver_state, DriverState::kRunning) << machine_.warning();
    EXPECT_TRUE(turns());
  }
}

TEST_F(RoboclawDriverTest, StandsHalfASecondAfterItsAnswersFailAndAsLongAsTheyDo) {
  for (const AnswerFault fault :
       {AnswerFault::kLost, AnswerFault::kDamaged, AnswerFault::kShifted, AnswerFault::kLate}) {
    for (int phase = 0; phase < 40; ++phase) {
      SCOPED_TRACE(std::string(kAnswerFaults[static_cast<std::size_t>(fault)]) + " in cycle " + std::to_string(phase));
      cycles(phase);
      machine_.board().line().faults().answers = fault;
      cycles(500);
      for (int i = 0; i < 20; ++i) {
        EXPECT_TRUE(stands()) << i;
        cycles(100);
      }
      EXPECT_EQ(frame_.driver_state, DriverState::kFault);
      machine_.board().line().faults().answers = AnswerFault::kNone;
      cycles(1200);
      EXPECT_TRUE(stands()) << "until the reset";
      machine_.reset();
      cycles(1000);
      ASSERT_TRUE(turns()) << machine_.warning();
    }
  }
}

TEST_F(RoboclawDriverTest, ADriverThatStartsWithoutAnswersStopsABoardThatStillTurns) {
  machine_.board().line().faults().answers = AnswerFault::kLost;
  machine_.replace_driver();
  machine_.driver().start();
  cycles(500);
  EXPECT_EQ(frame_.driver_state, DriverState::kStarting);
  EXPECT_TRUE(stands());
}

/// A line that carries all but the acknowledgement of orders, and counts what the driver sends.
class LineWithoutAcknowledgement final : public SerialLine {
 public:
  explicit LineWithoutAcknowledgement(std::unique_ptr<SerialLine> line) : line_(std::move(line)) {}
  bool receive(SerialChunk& chunk) noexcept override {
    if (!line_->receive(chunk)) return false;
    if (lost && chunk.size == 1) return receive(chunk);
    return true;
  }
  bool send(std::span<const std::uint8_t> request) noexcept override {
    const bool question = !roboclaw::is_write(static_cast<PacketCommand>(request[1]));
    questions += question ? 1 : 0;
    orders += question ? 0 : 1;
    return line_->send(request);
  }
  bool connected() const noexcept override { return true; }
  std::string name() const override { return "a line without acknowledgement"; }

  bool lost = false;
  int questions = 0, orders = 0;

 private:
  std::unique_ptr<SerialLine> line_;
};

/// Each question would restart the timeout of a board that receives no order.
TEST_F(RoboclawDriverTest, AsksNothingMoreUntilAnOrderIsAcknowledged) {
  auto owned = std::make_unique<LineWithoutAcknowledgement>(machine_.board().line().driver_end());
  LineWithoutAcknowledgement& line = *owned;
  machine_.replace_driver(std::move(owned));
  machine_.start();
  cycles(1000);
  ASSERT_TRUE(turns()) << machine_.warning();
  line.lost = true;
  line.questions = line.orders = 0;
  cycles(5000);
  EXPECT_LE(line.questions, 1);
  EXPECT_GT(line.orders, 400);
  EXPECT_TRUE(stands());
}

TEST_F(RoboclawDriverTest, ABoardWithoutGainsIsRefusedBeforeAnythingMoves) {
  inject("board", "no_gains");
  inject("line", "cut");
  cycles(1000);
  inject("line", "ok");
  machine_.reset();
  cycles(1000);
  expect_fault("velocity gains of zero, tune them with the maker's tool, of M1");
  EXPECT_TRUE(stands());
}

/// 5 % of the messages are lost, 1 % are damaged, and all are up to 3 ms late.
TEST(RoboclawLosses, StopNothingOnADisturbedLineAndBringNoWrongValue) {
  for (const double rate : {100.0, 250.0, 1000.0}) {
    RoboclawMachine machine(rate);
    machine.start();
    const JointCommand command{.mode = JointMode::kDriveVelocity, .velocity = 10};
    const int at_speed = static_cast<int>(rate);
    for (int i = 0; i < 60 * at_speed; ++i) {
      if (i == at_speed) {
        ASSERT_EQ(machine.board().inject("line", "disturbed"), "");
      }
      const double position = machine.joints[0].position;
      const SensorFrame& frame = machine.cycles(1, command);
      ASSERT_EQ(frame.driver_state, DriverState::kRunning) << rate << " Hz, " << i << machine.warning();
      // The middle of an exchange is up to 3 ms from the counts' instant. The speed, over 28 ms and more, is in error
      // by 6 ms of that span: 2.1 rad/s, for up to 100 ms.
      if (i > at_speed) {
        ASSERT_NEAR(frame.joints[0].position, position, 0.24) << rate << " Hz, " << i;
      }
    }
    EXPECT_GT(machine.frame().links[0].lost, 100u) << rate;
  }
}

/// One in 256 orders ends with the address. A board that holds a stray byte then begins each request with the last byte
/// of the one before.
TEST(RoboclawLosses, AStrayByteIsDiscardedInAPauseWhateverIsOrdered) {
  RoboclawMachine machine(250);
  machine.start();
  const std::array<std::uint8_t, 1> stray{0x80};
  for (int order = 0; order < 4000; ++order) {
    const JointCommand command{.mode = JointMode::kDriveVelocity, .velocity = 5 + 0.001 * order};
    machine.board().line().driver_end()->send(stray);
    for (int i = 0; i < 35; ++i) {
      ASSERT_EQ(machine.cycles(1, command).driver_state, DriverState::kRunning) << order << machine.warning();
    }
  }
}

TEST(RoboclawRates, AreMoreThan100OrdersPerSecondFrom200Hz) {
  for (const double rate : {200.0, 500.0, 1000.0}) {
    RoboclawMachine machine(rate);
    machine.start();
    const JointCommand command{.mode = JointMode::kDriveVelocity, .velocity = 5};
    const std::uint64_t before = machine.cycles(1, command).links[0].sent;
    const SensorFrame& frame = machine.cycles(static_cast<int>(2 * rate), command);
    EXPECT_EQ(frame.driver_state, DriverState::kRunning) << rate << machine.warning();
    EXPECT_GE(frame.links[0].sent - before, 398u) << rate;  // half of them are orders
  }
}

TEST(RoboclawProtocol, CrcAndBytesAreThoseOfTheManual) {
  constexpr std::array<std::uint8_t, 9> kDigits{'1', '2', '3', '4', '5', '6', '7', '8', '9'};
  EXPECT_EQ(roboclaw::crc16(kDigits), 0x31C3);  // of CRC-16/XMODEM
  const roboclaw::Packet speeds = roboclaw::request(0x80, PacketCommand::kSpeeds, 1000, -1000);
  ASSERT_EQ(speeds.size(), 12u);
  EXPECT_EQ(speeds.number(2, 4), 1000u);
  EXPECT_EQ(speeds.number(6, 4), 0xFFFFFC18u);
  EXPECT_EQ(roboclaw::request(0x80, PacketCommand::kEncoders).size(), 2u);
}

struct MutatedRoboclaw final : MutatedLine {
  bool send(std::span<const std::uint8_t> request) noexcept override {
    const auto command = static_cast<PacketCommand>(request[1]);
    driven += command == PacketCommand::kSpeeds ? 1 : 0;
    roboclaw::Packet packet;
    for (std::size_t i = 0; i < roboclaw::answer_size(command); ++i) packet.add(1, 1);
    packet.add(roboclaw::crc16(packet.bytes(), roboclaw::crc16(request)), 2);
    const auto bytes = packet.bytes();
    answer({bytes.begin(), bytes.end()});
    return true;
  }
};

void expect_no_motion_of_the_roboclaw(int streams) {
  auto line = std::make_unique<MutatedRoboclaw>();
  const MutatedRoboclaw& seen = *line;
  std::int64_t now_ns = 0;
  RoboclawDriver driver(RoboclawMachine::parameters(), 2, 0.02, std::move(line), [&now_ns] { return now_ns; });
  driver.start();
  SensorFrame frame;
  const std::vector<JointCommand> commands(2, {.mode = JointMode::kDriveVelocity, .velocity = 5});
  for (int i = 0; i < streams; ++i) {
    driver.write(commands);
    now_ns += 50'000'000;
    driver.read(frame);
    ASSERT_NE(frame.driver_state, DriverState::kRunning) << i;
    if (i % 100 == 0) driver.reset();
  }
  EXPECT_EQ(seen.driven, 0);
}

TEST(RoboclawFuzz, MutatedAnswersMoveNothing) {
  expect_no_motion_of_the_roboclaw(20'000);
}

TEST(RoboclawFuzz, NightlyAMillionMutatedAnswersMoveNothing) {
  expect_no_motion_of_the_roboclaw(1'000'000);
}

}  // namespace robot_control::tests

#include "drivers/line/serial_port.h"

#include <poll.h>

#include <chrono>
#include <filesystem>
#include <list>

#include "drivers/board/board_machine.h"
#include "drivers/driver.h"
#include "drivers/line/awaited_terminal.h"
#include "rt/clock.h"
#include "support/matchers.h"
#include "support/message_of.h"
#include "support/temporary_folder.h"

namespace robot_control::tests {

const RealtimeParameters kThread{.name = "serial", .policy = RealtimePolicy::kOff};

/// Waits at most 10 s, as a loaded machine may need.
bool comes_true(const std::function<bool()>& condition) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  bool is_true = condition();
  while (!is_true && std::chrono::steady_clock::now() < end) {
    poll(nullptr, 0, 1);
    is_true = condition();
  }
  return is_true;
}

struct SerialPortTest : testing::Test {
  bool passes(SerialLine& from, SerialLine& to, const std::string& text) {
    if (!from.send({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()})) return false;
    std::string got;
    SerialChunk chunk;
    return comes_true([&] {
      while (to.receive(chunk)) got.append(chunk.bytes.begin(), chunk.bytes.begin() + static_cast<long>(chunk.size));
      return got == text;
    });
  }

  TemporaryFolder folder_;
  const std::string path_ = (folder_.path() / "usb-Board_1-if00").string();
};

TEST_F(SerialPortTest, CarriesAnyBytesUnchanged) {
  PseudoTerminal device(path_);
  SerialPort port(path_, 921600, kThread, &monotonic_ns);
  const std::string raw("\0\x03\x04\x11\x13\r\n\x7f\xff\x1a", 10);  // what a cooked line would change
  EXPECT_TRUE(passes(port, device, raw));
  EXPECT_TRUE(passes(device, port, raw));
}

TEST_F(SerialPortTest, FindsADeviceAgainUnderAnotherNumberByItsId) {
  PseudoTerminal device(path_);
  const std::string number = std::filesystem::canonical(path_).string();
  SerialPort port(number, 0, kThread, &monotonic_ns, folder_.path());
  EXPECT_EQ(port.name(), path_);
  device.unplug();
  EXPECT_TRUE(comes_true([&] { return !port.connected(); }));
  std::list<PseudoTerminal> others;  // until the number is taken: other programs take and free numbers, too
  while (!std::filesystem::exists(number)) others.emplace_back(path_ + "_" + std::to_string(others.size()));
  device.plug();
  EXPECT_NE(std::filesystem::canonical(path_).string(), number);
  EXPECT_TRUE(comes_true([&] { return port.connected(); }));
  EXPECT_TRUE(passes(port, device, "again"));
  EXPECT_TRUE(passes(device, port, "and back"));
}

TEST_F(SerialPortTest, AwaitsADeviceThatIsAbsent) {
  SerialPort port(path_, 0, kThread, &monotonic_ns);
  EXPECT_FALSE(port.connected());
  EXPECT_FALSE(port.send(std::array<std::uint8_t, 1>{}));
  PseudoTerminal device(path_);
  EXPECT_TRUE(comes_true([&] { return port.connected(); }));
}

TEST_F(SerialPortTest, RefusesAFileAndASecondProgram) {
  EXPECT_THROW(SerialPort("/dev/null", 0, kThread, &monotonic_ns), DriverError);
  const PseudoTerminal device(path_);
  const SerialPort port(path_, 0, kThread, &monotonic_ns);
  EXPECT_THAT(message_of<DriverError>([&] { SerialPort(path_, 0, kThread, &monotonic_ns); }),
              HasSubstr("another program uses it"));
}

TEST_F(SerialPortTest, SendNeverBlocksThoughNothingIsTaken) {
  PseudoTerminal device(path_);
  SerialPort port(path_, 0, kThread, &monotonic_ns);
  bool taken = true;
  for (int i = 0; i < 100'000 && taken; ++i) taken = port.send(std::array<std::uint8_t, 100>{});
  EXPECT_FALSE(taken);
}

TEST_F(SerialPortTest, APseudoTerminalTakesNoLinkInUseAndReplacesOneThatLeadsNowhere) {
  std::filesystem::create_symlink("/dev/pts/none", path_);
  PseudoTerminal device(path_);
  EXPECT_THAT(message_of<DriverError>([&] { PseudoTerminal{path_}; }), HasSubstr("in use"));
  SerialPort port(path_, 0, kThread, &monotonic_ns);
  EXPECT_TRUE(passes(port, device, "still there"));
}

TEST_F(SerialPortTest, TheDriverTurnsTheWheelsOfABoardBehindAPseudoTerminal) {
  const UnderWay bytes = std::make_shared<std::atomic<std::size_t>>(0);
  BoardMachine machine(500, std::make_unique<CountedLine>(path_, bytes),
                       [&] { return std::make_unique<AwaitedLine>(path_, bytes); });
  machine.start();
  const JointCommand command{.mode = JointMode::kVelocity, .velocity = 10, .damping = 0.2};
  for (int i = 0; i < 500; ++i) {
    ASSERT_EQ(machine.cycles(1, command).driver_state, DriverState::kRunning) << machine.warning();
  }
  const SensorFrame& frame = machine.frame();
  EXPECT_NEAR(frame.joints[0].velocity, 10, 0.5);
  EXPECT_NEAR(machine.joints[0].velocity, 10, 0.5);
  EXPECT_EQ(frame.links[0].errors, 0U);
}

}  // namespace robot_control::tests

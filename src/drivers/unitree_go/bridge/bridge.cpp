#include "drivers/unitree_go/bridge/bridge.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <iostream>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "drivers/line/udp_socket.h"
#include "drivers/unitree_go/bridge/command_relay.h"
#include "drivers/unitree_go/bridge/dds_network.h"
#include "drivers/unitree_go/bridge/motion_switcher.h"
#include "drivers/unitree_go/bridge/state_writer.h"
#include "drivers/unitree_go/unitree_go_file.h"
#include "files/message_text.h"
#include "rt/realtime_thread.h"

namespace robot_control::unitree::go {
namespace {

constexpr int kWaitMs = 1;
constexpr std::int64_t kWatchNs = 10'000'000;          // of other writers
constexpr std::int64_t kRememberedNs = 1'000'000'000;  // a command of another program
constexpr std::int64_t kHelloNs = 100'000'000;         // by which a simulated robot learns where states go
constexpr int kLastCommands = 3;

void say(const std::string& text) {
  std::cout << "unitree_bridge: " << text << std::endl;
}

/// The socket for two threads.
class Line {
 public:
  Line(const std::string& peer, std::uint16_t port) : socket_(UdpSocket::host_end(peer, port)) {}

  void wait() const noexcept { socket_->wait(kWaitMs); }
  std::size_t receive(std::span<std::uint8_t> bytes) noexcept {
    const std::lock_guard lock(mutex_);
    return socket_->receive(bytes);
  }
  void send(std::span<const std::uint8_t> bytes) noexcept {
    const std::lock_guard lock(mutex_);
    socket_->send(bytes);
  }

 private:
  std::mutex mutex_;
  std::unique_ptr<UdpSocket> socket_;
};

/// Takes the datagrams that wait.
template <class Use>
void take_all(Line& line, const Use& use) {
  std::array<std::uint8_t, kMaxDatagram> bytes;
  for (int i = 0; i < 1000; ++i) {
    const std::size_t size = line.receive(bytes);
    if (size == 0) return;
    use(std::span(bytes).first(std::min(size, bytes.size())));
  }
}

/// Between the driver and the robot.
class ControllerSide {
 public:
  ControllerSide(const UnitreeGoLine& line, const std::string& driver, std::uint16_t port, BridgeClock clock)
      : clock_(std::move(clock)),
        line_(driver, port),
        relay_(line.damping),
        switcher_(line.has_service, line.release_service),
        network_(DdsSide::kController, line.interface, static_cast<std::uint32_t>(line.domain),
                 [this](std::span<std::uint8_t> state, std::uint64_t writer) { forward(state, writer); }) {
    report_.process = static_cast<std::uint32_t>(getpid());
  }

  void run(const volatile std::sig_atomic_t& ends) {
    std::int64_t last_ns = clock_();
    while (ends == 0) {
      line_.wait();
      const std::int64_t now_ns = clock_();
      relayed_ns_ = now_ns;
      const bool was_stopped = now_ns - last_ns > CommandRelay::kSilenceNs;  // what waits is old
      last_ns = now_ns;
      take_commands(now_ns, was_stopped);
      if (const LowCmd* command = relay_.due(now_ns, may_send(now_ns))) send(*command);
      request_mode(now_ns);
      watch(now_ns);
      report(now_ns);
    }
    const LowCmd* last = relay_.last_command();
    for (int i = 0; last != nullptr && i < kLastCommands; ++i) send(*last);
  }

 private:
  /// A relay that hangs sends no commands: its driver gets no states, and says so. The driver gets the states of one
  /// robot.
  void forward(std::span<std::uint8_t> state, std::uint64_t writer) {
    const std::int64_t now_ns = clock_();
    if (now_ns - relayed_ns_ > CommandRelay::kSilenceNs) return;
    std::array<std::uint8_t, kReportBytes + kStateBytes> datagram;
    const std::lock_guard lock(mutex_);
    if (!robot_.is_of_robot(writer, now_ns)) return;
    report_.robots = robot_.robots(now_ns);
    write_report(report_, datagram);
    std::memcpy(datagram.data() + kReportBytes, state.data(), kStateBytes);
    line_.send(datagram);
    sent_ns_ = clock_();
  }

  void report(std::int64_t now_ns) {
    const std::lock_guard lock(mutex_);
    report_.writers = static_cast<std::uint16_t>(std::min<std::size_t>(writers_, 0xFFFF));
    report_.other_commands = now_ns - other_ns_ < kRememberedNs ? 1 : 0;
    report_.robots = robot_.robots(now_ns);
    report_.service = switcher_.state();
    report_.mode = {};
    switcher_.mode().copy(report_.mode.data(), report_.mode.size() - 1);
    if (now_ns - sent_ns_ < kReportNs) return;
    std::array<std::uint8_t, kReportBytes> datagram;
    write_report(report_, datagram);
    line_.send(datagram);
    sent_ns_ = now_ns;
  }

  /// All robots on a network obey the same topic. One that obeys already is sent the damping of its driver.
  bool may_send(std::int64_t now_ns) {
    if (!switcher_.is_free()) return false;
    const RobotsSeen robots = [&] {
      const std::lock_guard lock(mutex_);
      return robot_.robots(now_ns);
    }();
    if (robots != robots_ && robots == RobotsSeen::kOne) say("one robot sends states");
    if (robots != robots_ && robots == RobotsSeen::kMore) say("a second robot sends states");
    robots_ = robots;
    return robots == RobotsSeen::kOne || relay_.sends();
  }

  void take_commands(std::int64_t now_ns, bool was_stopped) {
    take_all(line_, [&](std::span<const std::uint8_t> bytes) {
      LowCmd command;
      if (was_stopped || decode(bytes, command) != Flaw::kNone) return;
      if (!relay_.has_driver(now_ns)) {
        say("the driver commands");
        switcher_.begin(now_ns);
      }
      relay_.store(command, now_ns);
    });
    if (had_driver_ && !relay_.has_driver(now_ns)) {
      say("the driver is silent; its legs were damped");
      switcher_.begin(now_ns);  // the next driver waits for a new answer
    }
    had_driver_ = relay_.has_driver(now_ns);
  }

  void send(const LowCmd& command) noexcept {
    std::array<std::uint8_t, kCommandBytes> bytes;
    encode(command, bytes);
    network_.send(bytes);
  }

  void request_mode(std::int64_t now_ns) {
    if (!had_driver_) return;
    const MotionService before = switcher_.state();
    if (const auto request = switcher_.due(now_ns)) network_.request(request->id, request->api);
    network_.take_answers([&](std::int64_t id, std::int64_t api, std::int32_t code, std::string_view data) {
      switcher_.accept({.id = id, .api = api}, code, data, now_ns);
    });
    if (switcher_.state() == before) return;
    if (switcher_.state() == MotionService::kActive)
      say("the motion service is active: " + printable(switcher_.mode()));
    if (switcher_.state() == MotionService::kFree) say("the motion service is released");
    if (switcher_.state() == MotionService::kNoAnswer)
      say("the motion service does not answer; set has_service: false for a robot without it, as most simulators");
  }

  void watch(std::int64_t now_ns) {
    if (now_ns - watched_ns_ < kWatchNs) return;
    watched_ns_ = now_ns;
    const std::size_t writers = network_.other_writers();
    if (writers != writers_) say("other writers of rt/lowcmd: " + std::to_string(writers));
    writers_ = writers;
    if (!network_.others_sent()) return;
    if (now_ns - other_ns_ >= kRememberedNs) say("another program sent a command");
    other_ns_ = now_ns;
  }

  const BridgeClock clock_;
  Line line_;
  CommandRelay relay_;
  MotionSwitcher switcher_;
  bool had_driver_ = false;
  std::size_t writers_ = 0;
  std::int64_t watched_ns_ = 0;
  std::int64_t other_ns_ = -kRememberedNs;
  RobotsSeen robots_ = RobotsSeen::kNone;
  std::mutex mutex_;  // of what follows
  StateWriter robot_;
  BridgeReport report_;
  std::int64_t sent_ns_ = 0;
  std::atomic<std::int64_t> relayed_ns_ = clock_();  // when the relay began its last pass
  DdsNetwork network_;                               // its thread uses what stands before it
};

/// Before a simulated robot.
class RobotSide {
 public:
  RobotSide(const UnitreeGoLine& line, BridgeClock clock)
      : clock_(std::move(clock)),
        line_(line.address, static_cast<std::uint16_t>(line.port)),
        network_(DdsSide::kRobot, line.interface, static_cast<std::uint32_t>(line.domain),
                 [this](std::span<std::uint8_t> command, std::uint64_t /*writer*/) { line_.send(command); }) {}

  void run(const volatile std::sig_atomic_t& ends) {
    std::int64_t hello_ns = 0;
    while (ends == 0) {
      line_.wait();
      take_all(line_, [&](std::span<const std::uint8_t> bytes) {
        BridgeReport report;
        if (read_report(bytes, report) && bytes.size() > kReportBytes) network_.send(bytes.subspan(kReportBytes));
      });
      if (clock_() - hello_ns < kHelloNs) continue;
      hello_ns = clock_();
      line_.send(std::array<std::uint8_t, 1>{});
    }
  }

 private:
  const BridgeClock clock_;
  Line line_;
  DdsNetwork network_;
};

/// The driver of `port` at the address of the bridge.
std::string driver_address(const UnitreeGoLine& line) {
  return line.address.substr(0, line.address.find(':') + 1) + std::to_string(line.port);
}

}  // namespace

void run_bridge(const DriveFile& file, DdsSide side, const BridgeClock& clock, const volatile std::sig_atomic_t& ends) {
  const UnitreeGoLine& line = dynamic_cast<const UnitreeGoFile&>(file).line();
  const bool robot = side == DdsSide::kRobot;
  precede_ordinary_threads();
  say((robot ? "a simulated robot at " + line.address : "the driver at " + driver_address(line)) + ", DDS domain " +
      std::to_string(line.domain) + " on " + line.interface);
  if (robot) {
    RobotSide(line, clock).run(ends);
  } else {
    ControllerSide(line, driver_address(line), ntohs(udp_address(line.address)->sin_port), clock).run(ends);
  }
}

}  // namespace robot_control::unitree::go

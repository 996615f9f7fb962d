#pragma once
/// The cost of one cycle of the driver of a board on a serial line: its `read` and its `write`, over a pseudo-terminal.

#include <unistd.h>

#include <atomic>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "bench/programs/rows.h"
#include "drivers/serial/serial_port.h"
#include "rt/clock.h"
#include "simulation/devices/pseudo_terminal.h"
#include "support/allocation_guard.h"

namespace robot_control::bench {

/// The device's end, which counts its bytes.
class CountedEnd final : public SerialLine {
 public:
  CountedEnd(const std::string& path, std::atomic<std::size_t>& sent) : line_(path), sent_(sent) {}
  bool receive(SerialChunk& chunk) noexcept override { return line_.receive(chunk); }
  bool send(std::span<const std::uint8_t> bytes) noexcept override {
    sent_ += bytes.size();
    return line_.send(bytes);
  }
  bool connected() const noexcept override { return line_.connected(); }
  std::string name() const override { return line_.name(); }

 private:
  PseudoTerminal line_;
  std::atomic<std::size_t>& sent_;
};

/// The port of the driver. `await` waits for the bytes of the device, so that the load of the machine changes nothing.
class AwaitedPort final : public SerialLine {
 public:
  AwaitedPort(const std::string& path, std::atomic<std::size_t>& sent)
      : port_(path, 0, {.name = "serial", .policy = RealtimePolicy::kOff}, &latest), sent_(sent) {}
  void await() noexcept {
    while (!has_next_ && taken_ < sent_) {
      has_next_ = port_.receive(next_);
      if (!has_next_) std::this_thread::yield();
    }
  }
  bool receive(SerialChunk& chunk) noexcept override {
    if (std::exchange(has_next_, false)) {
      chunk = next_;
    } else if (!port_.receive(chunk)) {
      return false;
    }
    taken_ += chunk.size;
    return true;
  }
  bool send(std::span<const std::uint8_t> bytes) noexcept override { return port_.send(bytes); }
  bool connected() const noexcept override { return port_.connected(); }
  std::string name() const override { return port_.name(); }

 private:
  /// The driver takes a later time for its own present one.
  static std::int64_t latest() { return std::numeric_limits<std::int64_t>::max(); }

  SerialPort port_;
  SerialChunk next_;
  bool has_next_ = false;
  std::size_t taken_ = 0;
  std::atomic<std::size_t>& sent_;
};

/// Adds the rows of one board, whose machine (tests/drivers) has two wheels in the air.
template <class Machine>
void add_serial_cycle(std::vector<Row>& rows, const std::string& name, const JointCommand& command) {
  constexpr int kCycles = 5'000;
  constexpr int kStart = 500;  // until the board runs
  constexpr double kRate = 500;
  constexpr double kAllowed = 20'000;
  const std::string path = "/tmp/bench_step_" + std::to_string(getpid());
  std::atomic<std::size_t> sent = 0;
  AwaitedPort* port = nullptr;
  Machine machine(kRate, std::make_unique<CountedEnd>(path, sent), [&] {
    auto made = std::make_unique<AwaitedPort>(path, sent);
    port = made.get();
    return made;
  });
  SensorFrame sensors;
  const std::vector<JointCommand> commands(2, command);
  std::vector<double> cycle_ns;
  std::uint64_t allocations = 0;
  machine.driver().start();
  for (int cycle = 0; cycle < kCycles; ++cycle) {
    const std::int64_t start_ns = monotonic_ns();
    {
      const AllocationGuard guard;
      machine.driver().read(sensors);
      machine.driver().write(commands);
      if (cycle >= kStart) allocations += guard.count();
    }
    if (cycle >= kStart) cycle_ns.push_back(static_cast<double>(monotonic_ns() - start_ns));
    machine.run_board();
    port->await();
  }
  if (sensors.driver_state != DriverState::kRunning) throw std::runtime_error(name + ": " + machine.warning());
  rows.push_back({name + " cycle of two wheels", median(cycle_ns), "ns", kAllowed, "what is allowed",
                  median(cycle_ns) / kAllowed});
  rows.push_back({name + " allocations", static_cast<double>(allocations), "per 4500 cycles", 0, "none", 0});
}

}  // namespace robot_control::bench

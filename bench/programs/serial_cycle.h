#pragma once
/// The cost of one cycle of the driver of a board on a serial line: its `read` and its `write`, over a pseudo-terminal.

#include <unistd.h>

#include <atomic>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/programs/rows.h"
#include "drivers/line/awaited_terminal.h"
#include "rt/clock.h"
#include "support/allocation_guard.h"

namespace robot_control::bench {

/// Adds the rows of one board, whose machine (tests/drivers) has two wheels in the air.
template <class Machine>
void add_serial_cycle(std::vector<Row>& rows, const std::string& name, const JointCommand& command) {
  constexpr int kCycles = 5'000;
  constexpr int kStart = 500;  // until the board runs
  constexpr double kRate = 500;
  constexpr double kAllowed = 20'000;
  const std::string path = "/tmp/bench_step_" + std::to_string(getpid());
  const UnderWay bytes = std::make_shared<std::atomic<std::size_t>>(0);
  AwaitedLine* port = nullptr;
  Machine machine(kRate, std::make_unique<CountedLine>(path, bytes), [&] {
    auto made = std::make_unique<AwaitedLine>(path, bytes);
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

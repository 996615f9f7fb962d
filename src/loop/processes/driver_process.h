#pragma once
/// The node that owns the machine and the time: a simulator or a fieldbus master.
///
/// `clock: wall` paces with absolute deadlines; a simulated plant that falls behind lets time slip.
/// `clock: lockstep` waits for state, command and permit k before tick k+1; time stands still while one is
/// missing, and `missing` says which.
///
/// A simulated machine can be paused, stepped, reset and given faults (simulation_services.h). While the loop stands
/// it publishes its last frame ten times a second, as paused; afterwards the wall-clock grid restarts.

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "bus/ring.h"
#include "loop/cycles/driver_cycle.h"
#include "loop/cycles/trace_sink.h"
#include "loop/processes/loop_hold.h"
#include "loop/processes/process.h"
#include "loop/simulation_services.h"
#include "robots/robot.h"

namespace robot_control {

class DriverProcess final : public Process {
 public:
  /// Takes the locks; `open_driver` then (or never).
  DriverProcess(const Parameters& parameters, const Robot& robot, const std::string& bus);
  ~DriverProcess() override;

  /// Starts the machine and announces the first run. Throws DriverError.
  void open_driver(std::unique_ptr<Driver> driver);

  std::vector<std::string> missing() const override;
  const FrameReader<SensorFrame>& sensors() const noexcept { return sensors_.reader; }
  const FrameReader<TruthFrame>& truth() const noexcept { return truth_.reader; }

  /// Any thread: returns whether this frame is of the present run, instead of an earlier process.
  bool is_current(const FrameHead& head) const noexcept {
    return attached_run(sensors_.writer.memory()->head) == head.run;
  }

  /// An ordinary thread: the true state of the next laser scan, in the order of their cycles. False: there is none yet.
  bool next_scanned(TruthFrame& truth) noexcept { return scanned_reader_.read(truth); }

  /// The services of a simulated machine, once it is open; null for hardware.
  SimulationServices* services() noexcept { return services_.get(); }

  /// Simulated over real time since the run began; time held is not counted.
  double real_time_factor() const noexcept { return real_time_factor_.load(); }

 private:
  void poll_channels() override;
  bool ready() override { return cycle_ != nullptr && missing().empty(); }
  void announce_thread(int id) override { trace_.announce_thread(id); }
  void loop() noexcept override;
  void loop_wall() noexcept;
  void loop_lockstep() noexcept;
  bool await_turn() noexcept;
  bool await_chain() noexcept;
  void tick() noexcept;
  bool more() const noexcept { return cycles_ == 0 || cycle_->next_cycle() < cycles_; }

  GateParameters gate_;
  MachineNeeds needs_;
  std::uint64_t cycles_;
  Output<SensorFrame> sensors_;
  Output<TruthFrame> truth_;
  Input<StateFrame> state_;
  Input<CommandFrame> command_;
  Input<Permit> permit_;
  TraceSink<DriverTrace> trace_;
  std::unique_ptr<Driver> driver_;
  std::unique_ptr<DriverCycle> cycle_;
  std::uint64_t scan_cycles_ = 0;  ///< 0: there is no laser
  // States wait here for their scans. Later ones replace them if the ordinary thread is 64 scans late.
  using Scanned = Ring<TruthFrame, std::atomic, 64>;
  std::unique_ptr<Scanned> scanned_ = std::make_unique<Scanned>();
  RingWriter<TruthFrame, std::atomic, 64> scanned_writer_{scanned_.get()};
  RingReader<TruthFrame, std::atomic, 64> scanned_reader_{scanned_.get()};
  LoopHold hold_;
  std::unique_ptr<SimulationServices> services_;
  std::atomic<std::uint64_t> awaited_{0};  ///< lockstep: cycle waited for, plus 1
  std::atomic<double> real_time_factor_{0};
};

}  // namespace robot_control

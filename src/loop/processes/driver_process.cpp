#include "loop/processes/driver_process.h"

#include <algorithm>

#include "loop/gate_setup.h"
#include "loop/mint_number.h"
#include "rt/clock.h"
#include "rt/periodic.h"
#include "signals/robot_kinds.h"
#include "signals/roles.h"

namespace robot_control {
namespace {

constexpr std::int64_t kStopCheck = 100'000'000;  // ns; longest wait before `stopping` is looked at

/// Returns whether a living node waits on the sensors of this run.
template <class Frame>
bool attached(const Input<Frame>& input, std::uint64_t run) {
  const auto* memory = input.channel.memory();
  return memory != nullptr && attached_run(memory->head) == run && input.channel.locked();
}

/// Lockstep: returns whether cycle k has passed on this channel, with or without content.
template <class Frame>
bool published(const FrameReader<Frame>& reader, std::uint64_t run, std::uint64_t cycle) noexcept {
  Frame frame;
  const Lookup found = reader.at(run, cycle, frame);
  // A corrupt frame may be that of 8 cycles ago, in the same slot.
  if (found == Lookup::kCorrupt) return frame.head.run == run && frame.head.cycle == cycle;
  return found != Lookup::kMissing;
}

}  // namespace

DriverProcess::DriverProcess(const Parameters& parameters, const Robot& robot, const std::string& bus)
    : Process(parameters, robot, LoopPriority::kDriver, "driver"),
      gate_(robot.gate()),
      needs_(robot.needs()),
      cycles_(parameters.plant.cycles),
      sensors_(bus, ChannelNames::kSensors),
      truth_(bus, ChannelNames::kTruth),
      state_(bus, ChannelNames::kState),
      command_(bus, ChannelNames::kCommand),
      permit_(bus, ChannelNames::kPermit),
      trace_(bus, TraceRing::kDriver, lockstep()) {}

DriverProcess::~DriverProcess() {
  stop();
  if (driver_ != nullptr) driver_->stop();
}

void DriverProcess::open_driver(std::unique_ptr<Driver> driver) {
  require_needs(*driver, needs_);
  driver->start();
  driver_ = std::move(driver);
  if (const Simulator* const simulator = simulator_of(*driver_)) scan_cycles_ = simulator->scan_cycles();
  cycle_ = std::make_unique<DriverCycle>(
      *driver_, robot_, DriverCycle::Channels{sensors_.writer, truth_.writer, &command_.reader, &permit_.reader},
      loop_parameters().period_ns(), clock(), gate_);
  SensorFrame last;  // of an earlier process; time never goes back
  if (lockstep() && sensors_.reader.newest(last) == Lookup::kFrame) {
    cycle_->set_start(last.head.stamp_ns + loop_parameters().period_ns());
  }
  cycle_->set_driver_instance(mint_number());
  cycle_->begin_run(mint_number());
  if (simulator_of(*driver_) == nullptr) return;
  services_ = std::make_unique<SimulationServices>(robot_, hold_, *driver_, *cycle_, [this] { return last_missing(); });
}

std::vector<std::string> DriverProcess::missing() const {
  std::vector<std::string> names;
  const auto add_those_without = [&](const auto& has) {
    if (!has(state_)) names.emplace_back(program_of(Role::kEstimator));
    if (!has(command_)) names.emplace_back(program_of(Role::kController, programs_));
    if (!has(permit_)) names.emplace_back(program_of(Role::kMonitor));
  };
  const std::uint64_t run = attached_run(sensors_.writer.memory()->head);
  if (loop_parameters().wait_for_nodes || lockstep())
    add_those_without([&](const auto& input) { return attached(input, run); });
  if (loop_parameters().wait_for_telemetry && !trace_.reader_present())
    names.emplace_back(program_of(Role::kTelemetry));
  if (!names.empty() || !lockstep()) return names;
  if (const std::uint64_t awaited = awaited_.load(); awaited != 0)
    add_those_without([&](const auto& input) { return published(input.reader, run, awaited - 1); });
  return names;
}

void DriverProcess::poll_channels() {
  state_.poll();
  command_.poll();
  permit_.poll();
  trace_.poll();
}

void DriverProcess::loop() noexcept {
  hold_.begin();
  if (lockstep()) {
    loop_lockstep();
  } else {
    loop_wall();
  }
  if (!hold_.park_requested()) cycle_->publish_ended();  // while the loop is parked, a reset uses the cycle
  hold_.end();
  finish();
}

void DriverProcess::tick() noexcept {
  cycle_->inject(hold_.faults());
  cycle_->step();
  const TruthFrame& truth = cycle_->trace().truth;
  if (scan_cycles_ != 0 && truth.head.cycle % scan_cycles_ == 0) scanned_writer_.append(truth, nullptr);
  trace_.append(cycle_->trace(), cycle_->snapshot(), stopping());
}

/// Waits while the loop is held. True if it was held: time has passed, and a new run may have begun. When the loop is
/// to end, a reset may still use machine and cycle.
bool DriverProcess::await_turn() noexcept {
  bool held = false;
  while (!stopping().load(std::memory_order_relaxed) && !hold_.may_tick(cycle_->next_cycle())) {
    cycle_->publish_paused();
    hold_.stand(kStopCheck, stopping());
    held = true;
  }
  return held;
}

void DriverProcess::loop_wall() noexcept {
  const std::int64_t period_ns = loop_parameters().period_ns();
  const WhenLate when_late = simulator_of(*driver_) != nullptr ? WhenLate::kSlip : WhenLate::kSkip;
  Periodic schedule(monotonic_ns() + period_ns, period_ns, when_late);
  cycle_->set_start(schedule.deadline_ns());
  while (more()) {
    const bool held = await_turn();
    if (stopping().load(std::memory_order_relaxed)) return;
    if (held) {
      schedule = Periodic(std::max(schedule.deadline_ns(), monotonic_ns()), period_ns, when_late);
      cycle_->set_due(schedule.deadline_ns());
      if (!hold_.paused()) cycle_->count_resume();
    }
    sleep_until(schedule.deadline_ns());
    const std::int64_t slipped_before = schedule.slipped_ns();
    cycle_->skip(static_cast<std::uint64_t>(schedule.begin(monotonic_ns())));
    cycle_->count_slip(schedule.slipped_ns() - slipped_before);
    tick();
    if (!schedule.end(monotonic_ns())) cycle_->count_overrun();
    real_time_factor_.store(cycle_->real_time_factor());
  }
}

/// Lockstep: waits until state, command and permit of the last tick have passed, with or without content. False if the
/// loop is to end or park. It waits for the end of the chain first: the other frames are then present after one
/// wake-up.
bool DriverProcess::await_chain() noexcept {
  if (cycle_->next_cycle() == 0) return true;
  const std::uint64_t run = cycle_->run();
  const std::uint64_t last = cycle_->next_cycle() - 1;
  const auto await = [&](const auto& reader) {
    for (;;) {
      const std::uint32_t seen = reader.sequence();
      if (published(reader, run, last)) return true;
      if (stopping().load(std::memory_order_relaxed) || hold_.park_requested()) return false;
      reader.wait(seen, kStopCheck);
    }
  };
  awaited_.store(last + 1);
  const bool complete = await(command_.reader) && await(permit_.reader) && await(state_.reader);
  awaited_.store(0);
  return complete;
}

void DriverProcess::loop_lockstep() noexcept {
  std::int64_t start_ns = monotonic_ns();  // of the run; later by what was held
  std::uint64_t run = cycle_->run();
  for (;;) {
    const bool complete = await_chain();
    if (stopping().load(std::memory_order_relaxed) || (complete && !more())) return;
    const std::int64_t before_ns = monotonic_ns();
    const double simulated_ns =
        static_cast<double>(cycle_->next_cycle()) * static_cast<double>(loop_parameters().period_ns());
    real_time_factor_.store(simulated_ns / static_cast<double>(before_ns - start_ns + 1));
    const bool held = await_turn();
    if (stopping().load(std::memory_order_relaxed)) return;
    if (held) {
      start_ns += monotonic_ns() - before_ns;
      if (run != cycle_->run()) start_ns = monotonic_ns();
      run = cycle_->run();
    }
    if (held || !complete) continue;  // a loop that parked before the chain was complete still has to wait for it
    tick();
  }
}

}  // namespace robot_control

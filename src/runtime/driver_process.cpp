#include "runtime/driver_process.h"

#include <random>

#include "rt/clock.h"
#include "rt/periodic.h"
#include "runtime/start_check.h"

namespace robot_control {
namespace {

constexpr std::int64_t kStopCheck = 100'000'000;  // ns; longest wait before `stopping` is looked at

std::uint64_t mint() {
  std::random_device device;
  std::uint64_t number = 0;
  while (number == 0) number = (std::uint64_t{device()} << 32) | device();
  return number;
}

/// Does a living node wait on the sensors of this run?
template <class Frame>
bool attached(const Input<Frame>& input, std::uint64_t run) {
  const auto* memory = input.channel.memory();
  return memory != nullptr && attached_run(memory->head) == run && input.channel.locked();
}

/// Lockstep: has cycle k passed on this channel, with or without content?
template <class Frame>
bool published(const FrameReader<Frame>& reader, std::uint64_t run, std::uint64_t cycle) noexcept {
  Frame frame;
  const Lookup found = reader.at(run, cycle, frame);
  // A corrupt frame may be that of 8 cycles ago, in the same slot.
  if (found == Lookup::kCorrupt) return frame.head.run == run && frame.head.cycle == cycle;
  return found != Lookup::kMissing;
}

/// Lockstep: waits until `published`; false when the loop shall end.
template <class Frame>
bool await(const FrameReader<Frame>& reader, std::uint64_t run, std::uint64_t cycle,
           const std::atomic<bool>& stopping) noexcept {
  while (!stopping.load(std::memory_order_relaxed)) {
    const std::uint32_t seen = reader.sequence();
    if (published(reader, run, cycle)) return true;
    reader.wait(seen, kStopCheck);
  }
  return false;
}

}  // namespace

DriverProcess::DriverProcess(const Parameters& parameters, const RobotModel& robot, const std::string& bus)
    : Process(parameters.loop, LoopPriority::kDriver, "driver"),
      robot_(identified(robot, parameters.loop)),
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
  driver->start();
  driver_ = std::move(driver);
  cycle_ = std::make_unique<DriverCycle>(
      *driver_, robot_, DriverCycle::Channels{sensors_.writer, truth_.writer, &command_.reader, &permit_.reader},
      loop_parameters().period_ns(), lockstep() ? nullptr : &monotonic_ns);
  SensorFrame last;  // of an earlier process; time never goes back
  if (lockstep() && sensors_.reader.newest(last) == Lookup::kFrame) {
    cycle_->set_start(last.head.stamp_ns + loop_parameters().period_ns());
  }
  cycle_->set_boot(mint());
  cycle_->begin_run(mint());
}

std::vector<std::string> DriverProcess::missing() const {
  std::vector<std::string> names;
  const std::uint64_t run = cycle_ == nullptr ? 0 : cycle_->run();
  if (loop_parameters().wait_for_nodes || lockstep()) {
    if (!attached(state_, run)) names.emplace_back("state_estimator");
    if (!attached(command_, run)) names.emplace_back("diff_drive_controller");
    if (!attached(permit_, run)) names.emplace_back("safety_monitor");
  }
  if (loop_parameters().wait_for_telemetry && !trace_.reader_present()) names.emplace_back("telemetry");
  if (!names.empty() || !lockstep()) return names;
  if (const std::uint64_t awaited = awaited_.load(); awaited != 0) {
    if (!published(state_.reader, run, awaited - 1)) names.emplace_back("state_estimator");
    if (!published(command_.reader, run, awaited - 1)) names.emplace_back("diff_drive_controller");
    if (!published(permit_.reader, run, awaited - 1)) names.emplace_back("safety_monitor");
  }
  return names;
}

void DriverProcess::poll_channels() {
  state_.poll();
  command_.poll();
  permit_.poll();
  trace_.poll();
}

bool DriverProcess::ready() {
  return cycle_ != nullptr && missing().empty();
}

void DriverProcess::loop() noexcept {
  if (lockstep()) {
    loop_lockstep();
  } else {
    loop_wall();
  }
  finish();
}

/// False after the last cycle of the run.
bool DriverProcess::tick() noexcept {
  cycle_->step();
  trace_.append(cycle_->trace(), stopping());
  return cycles_ == 0 || cycle_->next_cycle() < cycles_;
}

void DriverProcess::loop_wall() noexcept {
  const std::int64_t start_ns = monotonic_ns() + loop_parameters().period_ns();
  cycle_->set_start(start_ns);
  const WhenLate when_late = driver_->simulated() ? WhenLate::kSlip : WhenLate::kSkip;
  Periodic schedule(start_ns, loop_parameters().period_ns(), when_late);
  bool more = true;
  while (more && !stopping().load(std::memory_order_relaxed)) {
    sleep_until(schedule.deadline_ns());
    const std::int64_t slipped_before = schedule.slipped_ns();
    cycle_->skip(static_cast<std::uint64_t>(schedule.begin(monotonic_ns())));
    cycle_->count_slip(schedule.slipped_ns() - slipped_before);
    more = tick();
    if (!schedule.end(monotonic_ns())) cycle_->count_overrun();
    const auto simulated = static_cast<double>(cycle_->next_stamp_ns() - start_ns);
    real_time_factor_.store(simulated / (simulated + static_cast<double>(schedule.slipped_ns())));
  }
}

void DriverProcess::loop_lockstep() noexcept {
  const std::int64_t start_ns = monotonic_ns();
  const std::int64_t first_stamp_ns = cycle_->next_stamp_ns();
  const std::uint64_t run = cycle_->run();
  bool more = true;
  while (more && !stopping().load(std::memory_order_relaxed)) {
    const std::uint64_t cycle = cycle_->next_cycle();
    more = tick();
    awaited_.store(cycle + 1);
    // The end of the chain first: when it has come, the others are there, and one wake-up was enough.
    if (!await(command_.reader, run, cycle, stopping()) || !await(permit_.reader, run, cycle, stopping()) ||
        !await(state_.reader, run, cycle, stopping())) {
      return;
    }
    awaited_.store(0);
    real_time_factor_.store(static_cast<double>(cycle_->next_stamp_ns() - first_stamp_ns) /
                            static_cast<double>(monotonic_ns() - start_ns + 1));
  }
}

}  // namespace robot_control

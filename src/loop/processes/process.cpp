#include "loop/processes/process.h"

#include <cmath>
#include <utility>

#include "signals/checksum.h"

namespace robot_control {
Process::Process(const Parameters& parameters, const Robot& robot, LoopPriority priority, std::string thread_name)
    : robot_(identified(robot.machine(), parameters.loop)),
      programs_(programs_of(parameters, robot.kind())),
      loop_(parameters.loop),
      priority_(priority),
      thread_name_(std::move(thread_name)) {
  if (thread_parameters().policy == RealtimePolicy::kRequired) RealtimeThread(thread_parameters(), [] {});
}

RealtimeParameters Process::thread_parameters() const {
  const bool paced = loop_.clock == ClockMode::kWall;  // lockstep under SCHED_FIFO would starve the rest
  std::optional<std::int32_t> cpu_latency_us;
  if (paced && loop_.cpu_dma_latency) cpu_latency_us = static_cast<std::int32_t>(*loop_.cpu_dma_latency);
  return {.name = thread_name_,
          .policy = paced ? loop_.realtime : RealtimePolicy::kOff,
          .priority = paced ? static_cast<int>(priority_) : 0,
          .core = static_cast<int>(loop_.core),
          .cpu_latency_us = cpu_latency_us};
}

void Process::poll() {
  poll_channels();
  if (thread_ == nullptr && ready()) {
    thread_ = std::make_unique<RealtimeThread>(thread_parameters(), [this] { loop(); });
    announce_thread(thread_->id());
  }
  std::vector<std::string> names = missing();
  const std::lock_guard lock(missing_mutex_);
  last_missing_ = std::move(names);
}

std::vector<std::string> Process::last_missing() const {
  const std::lock_guard lock(missing_mutex_);
  return last_missing_;
}

void Process::stop() noexcept {
  stopping_.store(true);
  thread_.reset();
}

std::vector<std::string> Process::realtime_messages() const {
  return thread_ == nullptr ? std::vector<std::string>{} : thread_->report().refusals;
}

MachineModel identified(MachineModel machine, const LoopParameters& loop) {
  const bool lockstep = loop.clock == ClockMode::kLockstep;
  Checksum sum;
  sum.mix(machine.hash);
  sum.mix(static_cast<std::uint64_t>(loop.period_ns()));
  sum.mix(lockstep ? 1 : 2);
  machine.hash = sum.sum();
  machine.source += " at " + std::to_string(std::lround(loop.rate)) + " Hz, clock " + (lockstep ? "lockstep" : "wall");
  return machine;
}

}  // namespace robot_control

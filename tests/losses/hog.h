#pragma once
/// A program that takes the chain's core, in real time. It needs SCHED_FIFO; the test needs a core for itself.

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/prctl.h>

#include "rt/clock.h"
#include "rt/futex.h"
#include "support/processes/anonymous_memory.h"
#include "support/processes/child_process.h"

namespace robot_control {

inline constexpr double kHogSeconds = 2.0;  // it ends by itself if it is not ended

inline bool may_run_in_real_time() {
  return ChildProcess([] {
           const sched_param wanted{.sched_priority = 1};
           return sched_setscheduler(0, SCHED_FIFO, &wanted);
         }).wait() == 0;
}

inline void stay_on(const cpu_set_t& cores) {
  sched_setaffinity(0, sizeof cores, &cores);
}

/// Spins on the chain's core when signalled.
class Hog {
 public:
  Hog(int priority, std::int64_t core) : process_([this, priority, core] { return spin(priority, core); }) {
    while (!state_->ready.load()) sleep_ns(1'000'000);
  }
  void begin() { state_->go.store(true); }
  void end() { process_.kill(); }

 private:
  struct State {
    std::atomic<bool> ready;
    std::atomic<bool> go;
  };

  int spin(int priority, std::int64_t core) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    cpu_set_t cores;
    CPU_ZERO(&cores);
    CPU_SET(static_cast<std::size_t>(core), &cores);
    stay_on(cores);
    const sched_param wanted{.sched_priority = priority};
    sched_setscheduler(0, SCHED_FIFO, &wanted);
    state_->ready.store(true);
    while (!state_->go.load()) sleep_ns(200'000);
    const std::int64_t end_ns = monotonic_ns() + static_cast<std::int64_t>(kHogSeconds * 1e9);
    while (monotonic_ns() < end_ns) {
    }
    return 0;
  }

  AnonymousMemory<State> state_;
  ChildProcess process_;
};

/// Keeps this thread off core 0, the chain's, for as long as it lives. `problem` says why that is not possible.
class OffTheChain {
 public:
  OffTheChain() {
    if (!may_run_in_real_time()) {
      problem = "SCHED_FIFO is not granted";
      return;
    }
    CPU_ZERO(&before_);
    sched_getaffinity(0, sizeof before_, &before_);
    cpu_set_t others = before_;
    CPU_CLR(0, &others);
    if (CPU_COUNT(&others) == 0) {
      problem = "there is one core only";
      return;
    }
    stay_on(others);
    moved_ = true;
  }
  ~OffTheChain() {
    if (moved_) stay_on(before_);
  }
  OffTheChain(const OffTheChain&) = delete;
  OffTheChain& operator=(const OffTheChain&) = delete;

  const char* problem = nullptr;

 private:
  cpu_set_t before_{};
  bool moved_ = false;
};

}  // namespace robot_control

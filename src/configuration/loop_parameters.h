#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

#include "gate/stop_action.h"
#include "parameters/block.h"
#include "rt/realtime_thread.h"

namespace robot_control {

enum class ClockMode { kWall, kLockstep };

inline std::vector<Word> words_of(ClockMode) {
  return {{"wall", ClockMode::kWall}, {"lockstep", ClockMode::kLockstep}};
}

/// An ordinary thread of each node counts what its real-time thread must not do (timing/realtime_check.h).
enum class RealtimeChecks { kOff, kCount };

inline std::vector<Word> words_of(RealtimeChecks) {
  return {{"off", RealtimeChecks::kOff}, {"count", RealtimeChecks::kCount}};
}

/// Hz, the range of `rate`.
inline constexpr double kMinRate = 20;
inline constexpr double kMaxRate = 2000;

/// Values on which all nodes must agree; they are in the block `robot:`, beside those of the robot itself.
struct LoopParameters {
  double rate = 1000;  ///< Hz, 20 … 2000
  ClockMode clock = ClockMode::kWall;
  RealtimePolicy realtime = RealtimePolicy::kPreferred;
  RealtimeChecks realtime_checks = RealtimeChecks::kCount;
  std::int64_t core = 0;                    ///< core to which the real-time threads are pinned; -1: not pinned
  std::optional<double> cpu_dma_latency;    ///< µs, of idle states of the processors; none: not requested
  StopKind fail_action = StopKind::kBrake;  ///< of every wheel while the gate passes no command
  std::string bus;                          ///< empty: derived from master and namespace
  std::string command_script;               ///< CSV path; empty: none
  bool wait_for_nodes = false;      ///< cycle 0 begins when all four nodes hold their channels; always in lockstep
  bool wait_for_telemetry = false;  ///< … and when telemetry reads

  double period() const { return 1.0 / rate; }                           ///< s
  std::int64_t period_ns() const { return std::llround(1.0e9 / rate); }  ///< ns
};

inline Keys keys(LoopParameters& loop) {
  return {
      {"fail_action", &loop.fail_action},
      {"rate", &loop.rate, "Hz", kMinRate, kMaxRate},
      {"clock", &loop.clock},
      {"realtime", &loop.realtime},
      {"realtime_checks", &loop.realtime_checks},
      {"core", &loop.core, {}, -1, 1023},
      {"cpu_dma_latency", &loop.cpu_dma_latency, "µs", 0, 10000, kOptional},
      {"bus", &loop.bus, {}, 0, 0, kMayBeEmpty},
      {"command_script", &loop.command_script, {}, 0, 0, kPath | kMayBeEmpty},
      {"wait_for_nodes", &loop.wait_for_nodes},
      {"wait_for_telemetry", &loop.wait_for_telemetry},
  };
}

}  // namespace robot_control

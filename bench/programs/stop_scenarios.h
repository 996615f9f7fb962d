#pragma once
/// The facts that the simulated machine can produce, one scenario or more for each cause of a stop.
///
/// These causes have no such fact in one process and in virtual time:
///   e_stop_topic       what e_stop_service is, after its message
///   driver_lost, monitor_restarted, monitor_late, overruns     wall clock and processes: bench_stops
///   driver_fault       a diverged simulation stands still: there is no truth to measure
///   corrupt_frame      no injected fault breaks the checksum of sensors; of commands: gate_refuses
///   wheel_effort       simulated drives keep their limit
///   gate_disobeys      this gate obeys

#include <functional>
#include <string>
#include <vector>

#include "signals/permit.h"
#include "simulation/closed_loop.h"

namespace robot_control::bench {

struct StopScenario {
  StopCause cause;                 ///< the cause that the scenario shows; another one may be faster
  std::string fact;                ///< in words
  double linear = 0, angular = 0;  ///< m/s, rad/s: commanded before and after
  std::vector<Overlay> parameters;
  std::function<void(ClosedLoop&)> begin;  ///< makes the fact true; empty if the first blow does
};

/// s, when `begin` is called, and pushes begin.
inline constexpr double kFactTime = 2.5;

/// For diffbot, at its full speed of 1 m/s.
std::vector<StopScenario> stop_scenarios();

}  // namespace robot_control::bench

#include "loop/simulation_services.h"

#include <algorithm>
#include <exception>
#include <limits>
#include <utility>

#include "loop/mint_number.h"
#include "machine/fault_names.h"
#include "rt/clock.h"
#include "rt/futex.h"

namespace robot_control {
namespace {

constexpr std::int64_t kTimeout = 2'000'000'000;     // ns; a loop that has not stopped by then waits for another node
constexpr std::int64_t kStandstill = 5'000'000'000;  // ns without a cycle; a period is 10 ms at most

ServiceAnswer busy() {
  return {false, "another step or reset is in progress"};
}

std::string before(std::uint64_t cycle) {
  return "before cycle " + std::to_string(cycle);
}

ServiceAnswer ended() {
  return {false, "the run has ended"};
}

}  // namespace

SimulationServices::SimulationServices(const MachineModel& machine, LoopHold& hold, Driver& driver, DriverCycle& cycle,
                                       std::function<std::vector<std::string>()> missing)
    : machine_(machine), hold_(hold), driver_(driver), cycle_(cycle), missing_(std::move(missing)) {}

/// Its caller holds `request_mutex_`.
std::uint64_t SimulationServices::send_request() {
  request_.number = hold_.request(request_);
  return request_.number;
}

std::uint64_t SimulationServices::request_pause(bool pause) {
  const std::lock_guard lock(request_mutex_);
  request_.paused = pause ? 1 : 0;
  request_.step_until = 0;
  return send_request();
}

std::string SimulationServices::waiting_for() const {
  std::string names;
  for (const std::string& name : missing_()) names += (names.empty() ? "; waiting for " : ", ") + name;
  return names;
}

ServiceAnswer SimulationServices::set_pause(bool pause) {
  const std::uint64_t number = request_pause(pause);
  if (!pause) return {true, "running" + waiting_for()};
  if (hold_.await_stand(number, kTimeout)) return {true, "paused " + before(hold_.next_cycle())};
  return {true, "will pause; no cycle runs now" + waiting_for()};
}

ServiceAnswer SimulationServices::step(std::uint64_t cycles) {
  const std::unique_lock exclusive(exclusive_, std::try_to_lock);
  if (!exclusive.owns_lock()) return busy();
  Steps steps;
  const std::int64_t end_ns = monotonic_ns() + kTimeout;
  for (;;) {
    {
      const std::lock_guard lock(request_mutex_);
      if (request_.paused == 0) return {false, "allowed only while paused: call set_pause with true first"};
      if (hold_.stands(request_.number)) {  // and stands until another thread gets this lock
        const std::uint64_t first = hold_.next_cycle();
        request_.step_until = first + std::min(cycles, std::numeric_limits<std::uint64_t>::max() - first);
        steps = {.number = send_request(), .first = first, .target = request_.step_until};
        break;
      }
    }
    if (monotonic_ns() > end_ns) return {false, "the simulated time is already stopped" + waiting_for()};
    sleep_ns(LoopHold::kPollPeriod);
  }
  return await_steps(steps);
}

ServiceAnswer SimulationServices::await_steps(const Steps& steps) {
  std::uint64_t seen = steps.first;
  std::int64_t seen_ns = monotonic_ns();
  while (!hold_.stands(steps.number)) {
    sleep_ns(LoopHold::kPollPeriod);
    if (!hold_.looping()) return ended();
    if (const std::uint64_t next = hold_.next_cycle(); next != seen) {
      seen = next;
      seen_ns = monotonic_ns();
    } else if (monotonic_ns() - seen_ns > kStandstill) {
      request_pause(true);
      return {false, "the simulated time is stopped " + before(next) + waiting_for()};
    }
    const std::lock_guard lock(request_mutex_);
    if (request_.paused == 0) return {false, "resumed meanwhile"};
  }
  const std::uint64_t reached = hold_.next_cycle();
  const std::string done = std::to_string(reached - steps.first) + " cycles done, paused " + before(reached);
  return {reached == steps.target, reached == steps.target ? done : "interrupted: " + done};
}

ServiceAnswer SimulationServices::reset() {
  const std::unique_lock exclusive(exclusive_, std::try_to_lock);
  if (!exclusive.owns_lock()) return busy();
  std::uint64_t number = 0;
  {
    const std::lock_guard lock(request_mutex_);
    request_.parked = hold_.looping() ? 1 : 0;
    request_.step_until = 0;
    request_.faults = {};
    number = send_request();
    if (request_.parked == 0 && hold_.next_cycle() > 0) return ended();
    if (request_.parked == 0) return {true, "no cycle has run yet" + waiting_for()};
  }
  ServiceAnswer answer{true, "a new run begins at cycle 0"};
  if (!hold_.await_stand(number, kTimeout)) {
    answer = hold_.looping() ? ServiceAnswer{false, "the loop did not stop" + waiting_for()} : ended();
  } else {
    try {
      cycle_.inject({});
      driver_.start();
      cycle_.set_start(cycle_.next_stamp_ns());
      cycle_.begin_run(mint_number());
    } catch (const std::exception& error) {
      answer = {false, error.what()};
    }
  }
  const std::lock_guard lock(request_mutex_);
  request_.parked = 0;
  if (answer.success && request_.paused != 0) answer.message += ", paused";
  send_request();
  return answer;
}

ServiceAnswer SimulationServices::inject_fault(const std::string& component, const std::string& kind) {
  const std::lock_guard lock(request_mutex_);
  const std::vector<InjectedFault> found = components_of(machine_, component);
  if (!found.empty() && is_node(found.front().component)) {
    return {false, component +
                       ": a running node has no simulated faults; stop or kill its process (kill -STOP, "
                       "kill -KILL), or call inject_fault of ClosedLoop in Python"};
  }
  std::string problem = set_fault(request_.faults, machine_, component, kind);
  if (!problem.empty()) return {false, std::move(problem)};
  send_request();
  return {true, "injected: " + names_of(request_.faults, machine_)};
}

}  // namespace robot_control

#include "safety/latch/motion_release.h"

#include <algorithm>

namespace robot_control {

bool MotionRelease::Count::grown(const CommandFrame& command) noexcept {
  if (!before) before = command.first_cycle >= after ? 0 : command.zero_requests;
  return command.zero_requests > *before;
}

void MotionRelease::enter_run() noexcept {
  const std::uint64_t starts = starts_ + 1;
  *this = MotionRelease();
  starts_ = starts;
}

void MotionRelease::start(std::uint64_t cycle) noexcept {
  ++starts_;
  released_ = false;
  begin(cycle);
}

void MotionRelease::begin(std::uint64_t cycle) noexcept {
  since_start_.restart(std::max(since_start_.after, cycle));
  since_gap_.restart(std::max(since_gap_.after, since_start_.after));
}

void MotionRelease::update_start(std::optional<std::uint64_t>& known, std::uint64_t first_cycle) noexcept {
  if (known == first_cycle) return;
  known = first_cycle;
  start(first_cycle);
}

void MotionRelease::step(const MonitorInput& input, std::uint64_t elapsed) noexcept {
  const std::uint64_t cycle = input.sensors->head.cycle;
  const CommandFrame* command = input.command;
  const std::uint64_t resumes = input.sensors->resumes;
  if (!resumes_) {
    begin(cycle);
  } else if (*resumes_ != resumes) {
    start(cycle);
  }
  resumes_ = resumes;
  if (input.state != nullptr) update_start(state_first_, input.state->first_cycle);
  if (command != nullptr) update_start(command_first_, command->first_cycle);
  if (elapsed > 1) since_gap_.restart(cycle - 1);
  reset_refusal_ = kRefusalGap;
  if (command != nullptr && input.state != nullptr && command->state_cycle == command->head.cycle) {
    evaluate(*command);
  } else {
    since_gap_.restart(cycle);
  }
}

void MotionRelease::evaluate(const CommandFrame& command) noexcept {
  const bool zero_after_start = since_start_.grown(command);
  const bool zero_after_gap = since_gap_.grown(command);
  const bool in_force = parts_of(command.requested) != 0;
  const bool zeros = !in_force && command.zero_requested != 0;
  const std::uint64_t current_cycles = command.head.cycle - std::min(command.head.cycle, since_gap_.after);
  const std::uint64_t needed = std::max<std::uint64_t>(command.silence_needed, 1);
  const bool quiet = !in_force && command.silent_cycles >= needed;
  const bool silent = quiet && current_cycles >= needed;
  released_ = released_ || zero_after_start || silent;
  if (silent || (zeros && zero_after_gap)) {
    reset_refusal_ = 0;
  } else {
    reset_refusal_ = quiet || zeros ? kRefusalGap : kRefusalCommand;
  }
}

}  // namespace robot_control

#include "safety/supervisor.h"

#include "safety/stop_category.h"

namespace robot_control {

void Supervisor::step(const SupervisorInput& input) noexcept {
  latch(input);

  TriggerSet triggers;
  if (input.reset_requested) {
    reset_refusal_ = refusal(input);
    if (reset_refusal_ == 0 && causes() != 0) {
      repair_ = brake_ = ramp_ = first_cause_ = 0;
      triggers.add(input.missing == 0 ? Trigger::kResetComplete : Trigger::kResetIncomplete);
    }
  }
  triggers.add(Trigger::kRepairCause, repair_ != 0);
  triggers.add(Trigger::kBrakeCause, brake_ != 0);
  triggers.add(Trigger::kRampCause, ramp_ != 0);
  triggers.add(Trigger::kRampEnded, input.standing || input.cycle >= ramp_until_);
  triggers.add(Trigger::kComplete, input.missing == 0);
  triggers.add(Trigger::kMotion, input.requested || input.moving);
  triggers.add(Trigger::kRest, !input.requested && input.standing);

  const SupervisorState next = next_state(state_, triggers);
  if (next == state_) return;
  state_ = next;
  since_cycle_ = input.cycle;
  ramp_until_ = state_ == SupervisorState::kStopping ? input.cycle + ramp_cycles_ : 0;
}

void Supervisor::enter_run() noexcept {
  state_ = latched_state();
  since_cycle_ = 0;
  ramp_until_ = 0;
}

void Supervisor::restore(std::uint64_t causes, std::uint64_t first_cause, StopCause cause,
                         std::uint64_t cycle) noexcept {
  if (first_cause_ == 0) first_cause_ = first_cause;
  causes &= kAllCauses;
  latch({.repair = for_repair(causes), .brake = causes & ~for_repair(causes)});
  latch({.brake = cause});
  state_ = latched_state();
  since_cycle_ = cycle;
}

void Supervisor::latch(const SupervisorInput& input) noexcept {
  const std::uint64_t active = input.repair | input.brake | input.ramp;
  if (first_cause_ == 0) first_cause_ = active & (~active + 1);  // the lowest bit names one of several
  repair_ |= input.repair;
  brake_ |= input.brake;
  ramp_ |= input.ramp;
}

std::uint64_t Supervisor::refusal(const SupervisorInput& input) const noexcept {
  std::uint64_t refusal = 0;
  if (causes() == 0) {
    if (state_ == SupervisorState::kInit && input.missing != 0) refusal |= kRefusalInit;
    return refusal;
  }
  if ((input.repair | input.brake | input.ramp) != 0) refusal |= kRefusalCauseActive;
  if (input.requested) refusal |= kRefusalCommand;
  if (!input.standing || state_ == SupervisorState::kStopping) refusal |= kRefusalMoving;
  if (input.sliding) refusal |= kRefusalSliding;
  return refusal;
}

SupervisorState Supervisor::latched_state() const noexcept {
  if (repair_ != 0) return SupervisorState::kFault;
  return causes() != 0 ? SupervisorState::kStopped : SupervisorState::kInit;
}

}  // namespace robot_control

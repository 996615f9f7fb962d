#include "safety/latch/supervisor.h"

#include "safety/latch/fixed_reactions.h"

namespace robot_control {

void Supervisor::step(const SupervisorInput& input) noexcept {
  latch(input);

  const bool complete = input.missing == 0 && input.released;
  TriggerSet triggers;
  if (input.reset_requested) {
    reset_refusal_ = refusal(input);
    if (reset_refusal_ == 0 && causes() != 0) {
      fault_ = brake_ = ramp_ = first_cause_ = 0;
      triggers.add(complete ? Trigger::kResetComplete : Trigger::kResetIncomplete);
    }
  }
  triggers.add(Trigger::kFaultCause, fault_ != 0);
  triggers.add(Trigger::kBrakeCause, brake_ != 0);
  triggers.add(Trigger::kRampCause, ramp_ != 0);
  triggers.add(Trigger::kRampEnded, input.standing || input.cycle >= ramp_until_);
  triggers.add(Trigger::kComplete, complete);
  triggers.add(Trigger::kUnreleased, !input.released);
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

void Supervisor::restore(std::uint64_t causes, std::uint64_t first_cause) noexcept {
  if (first_cause_ == 0) first_cause_ = first_cause;
  causes &= kAllCauses;
  latch({.fault = leading_to_fault(causes), .brake = causes & ~leading_to_fault(causes)});
  state_ = latched_state();
}

void Supervisor::latch(const SupervisorInput& input) noexcept {
  const std::uint64_t active = input.fault | input.brake | input.ramp;
  if ((active & ~causes()) != 0) ++stops_;
  if (first_cause_ == 0) first_cause_ = active & (~active + 1);  // the lowest bit names one of several
  fault_ |= input.fault;
  brake_ |= input.brake;
  ramp_ |= input.ramp;
}

std::uint64_t Supervisor::refusal(const SupervisorInput& input) const noexcept {
  std::uint64_t refusal = 0;
  if (causes() == 0) {
    if (state_ == SupervisorState::kInit && input.missing != 0) refusal |= kRefusalInit;
    return refusal;
  }
  if ((input.fault | input.brake | input.ramp) != 0) refusal |= kRefusalCauseActive;
  refusal |= input.motion_refusal;
  if (!input.standing || state_ == SupervisorState::kStopping) refusal |= kRefusalMoving;
  if (input.sliding) refusal |= kRefusalSliding;
  return refusal;
}

SupervisorState Supervisor::latched_state() const noexcept {
  if (fault_ != 0) return SupervisorState::kFault;
  return causes() != 0 ? SupervisorState::kStopped : SupervisorState::kInit;
}

}  // namespace robot_control

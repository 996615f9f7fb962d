#include "safety/supervisor.h"

#include "safety/stop_category.h"

namespace robot_control {

void Supervisor::step(const SupervisorInput& input) noexcept {
  latch(input.active);

  TriggerSet triggers;
  if (input.reset_requested) {
    reset_refusal_ = refusal(input);
    if (reset_refusal_ == 0 && causes_ != 0) {
      causes_ = 0;
      first_cause_ = 0;
      triggers.add(input.missing == 0 ? Trigger::kResetComplete : Trigger::kResetIncomplete);
    }
  }
  triggers.add(Trigger::kRepairCause, (causes_ & causes_of(StopCategory::kBrakeForRepair)) != 0);
  triggers.add(Trigger::kBrakeCause, (causes_ & causes_of(StopCategory::kBrake)) != 0);
  triggers.add(Trigger::kRampCause, (causes_ & causes_of(StopCategory::kRamp)) != 0);
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
  first_cause_ = first_cause_ == 0 ? first_cause : first_cause_;
  causes_ |= causes & kAllCauses;
  latch(cause);
  state_ = latched_state();
  since_cycle_ = cycle;
}

void Supervisor::latch(std::uint64_t active) noexcept {
  if (first_cause_ == 0) first_cause_ = active & (~active + 1);  // the lowest bit names one of several
  causes_ |= active;
}

std::uint64_t Supervisor::refusal(const SupervisorInput& input) const noexcept {
  std::uint64_t refusal = 0;
  if (causes_ == 0) {
    if (state_ == SupervisorState::kInit && input.missing != 0) refusal |= kRefusalInit;
    return refusal;
  }
  if (input.active != 0) refusal |= kRefusalCauseActive;
  if (input.requested) refusal |= kRefusalCommand;
  if (!input.standing || state_ == SupervisorState::kStopping) refusal |= kRefusalMoving;
  return refusal;
}

SupervisorState Supervisor::latched_state() const noexcept {
  if ((causes_ & causes_of(StopCategory::kBrakeForRepair)) != 0) return SupervisorState::kFault;
  return causes_ != 0 ? SupervisorState::kStopped : SupervisorState::kInit;
}

}  // namespace robot_control

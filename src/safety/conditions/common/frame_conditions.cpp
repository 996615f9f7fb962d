#include "safety/conditions/common/frame_conditions.h"

#include "safety/measurements/finite.h"

namespace robot_control {
namespace {

void add_if_persistent(StopCause cause, std::uint64_t cycles, std::uint64_t joint, ActiveCauses& out) noexcept {
  if (cycles < FrameConditions::kPersistence) return;
  out.add(cause, Reaction::kBrake,
          {.beyond = true,
           .value = static_cast<double>(cycles),
           .limit = static_cast<double>(FrameConditions::kPersistence),
           .joint = joint});
}

}  // namespace

void FrameConditions::step(const MonitorInput& input, ActiveCauses& out) noexcept {
  if (input.sensors == nullptr) return add_if_persistent(kCauseCorruptFrame, input.corrupt, kMaxJoints, out);
  corrupt_ = input.corrupt != 0 ? corrupt_ + 1 : 0;
  const bool numbers_finite = finite(*input.sensors) && (input.command == nullptr || finite(*input.command));
  not_finite_ = numbers_finite ? 0 : not_finite_ + 1;
  add_if_persistent(kCauseCorruptFrame, corrupt_, kMaxJoints, out);
  if (!numbers_finite) add_if_persistent(kCauseNotFinite, not_finite_, not_finite_joint(*input.sensors), out);
}

}  // namespace robot_control

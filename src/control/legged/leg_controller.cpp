#include "control/legged/leg_controller.h"

#include <algorithm>
#include <cmath>

namespace robot_control {
namespace {

bool usable(const ControlInput& input) noexcept {
  return input.state != nullptr && input.state->head.cycle == input.sensors->head.cycle &&
         (input.state->base.flags & kStateValid) != 0;
}

}  // namespace

LegController::LegController(const LegModel& robot, const LegControllerParameters& parameters, double period)
    : period_(period),
      lie_down_after_(parameters.lie_down_after),
      gathering_(robot),
      joint_bounds_(joint_bounds(robot)),
      stand_(robot, period),
      walk_(robot, parameters, period),
      state_(CommandWatch(parameters.request_timeout, period, kExecutable)) {}

void LegController::enter_run(const VelocityCommand& inbox, bool with_zero) noexcept {
  CommandWatch watch = state_.watch;
  watch.enter_run(inbox, with_zero);
  state_ = State(watch);
}

void LegController::step(const ControlInput& input, CommandFrame& out) noexcept {
  const SensorFrame& sensors = *input.sensors;
  const std::uint64_t cycle = sensors.head.cycle;
  out = {};
  out.joint_count = kLegsJoints;
  out.requested = state_.watch.step(input.request, cycle);
  out.reasons = state_.watch.reasons();
  state_.watch.report(cycle, out);
  if (input.state != nullptr) out.state_cycle = input.state->head.cycle;
  if (input.permit != nullptr) out.permit_cycle = input.permit->head.cycle;
  const bool measured = joints_have(sensors, kLegsJoints, kValidPosition) &&
                        std::all_of(sensors.joints.begin(), sensors.joints.begin() + kLegsJoints,
                                    [](const JointSample& joint) { return std::isfinite(joint.position); });
  const bool braked = input.permit == nullptr || input.permit->action == PermitAction::kBrake;
  if (input.permit == nullptr) out.reasons |= kReasonNoPermit;
  if (input.permit != nullptr && braked) out.reasons |= kReasonPermitBrake;
  if (!measured) out.reasons |= kReasonBadSensors;
  if (input.permit != nullptr && braked) state_ = State(state_.watch);
  if (braked || !measured) return pause();
  Request request = out.requested;
  if (input.permit->action == PermitAction::kRamp) {
    out.reasons |= kReasonPermitRamp;
    request = {.twist = {}, .posture = {}, .mode = {ModeKind::kLie}};
  }
  if (state_.phase != LegPhase::kWalking) state_.gap = 0;
  note_ignored(request, out.reasons);
  const LegsValues before = state_.stand.angles;
  const bool began = advance(request, input, out.reasons);
  if (state_.phase == LegPhase::kWalking) return walk(input, request, out);
  report(out);
  if (state_.phase == LegPhase::kLying) {
    out.reasons |= kReasonHolding;
    return;
  }
  LegsValues rates{};
  for (std::size_t i = 0; i < kLegsJoints && !began; ++i) rates[i] = (state_.stand.angles[i] - before[i]) / period_;
  stand_.command(state_.stand, rates, out);
}

/// Names what the present posture does not allow.
void LegController::note_ignored(const Request& request, std::uint64_t& reasons) const noexcept {
  const ModeKind kind = request.mode.kind;
  const bool of_joints = kind == ModeKind::kJoints;
  const bool lifts = lifted_by(request.mode) != kLegs;
  const bool of_standing = !of_joints && ((parts_of(request) & kPose) != 0 || lifts);
  const bool stands = state_.phase == LegPhase::kStanding || (state_.phase == LegPhase::kWalking && !lifts);
  if (of_standing && !stands && !walk_.requested(request)) reasons |= kReasonNotStanding;
  const bool known = kind == ModeKind::kGait ? walk_.has_gait(request.mode.index) : kind < ModeKind::kGait;
  if (!known || (kind == ModeKind::kLift && !lifts)) reasons |= kReasonPartIgnored;
  const bool lies = state_.phase == LegPhase::kLying || state_.phase == LegPhase::kJoints;
  if (of_joints && !lies) reasons |= kReasonNotLying;
}

/// All joints brake in this cycle.
void LegController::pause() noexcept {
  if (++state_.gap > kMaxGap) state_ = State(state_.watch);
}

/// Returns true if the joints begin to move in this cycle.
bool LegController::advance(const Request& request, const ControlInput& input, std::uint64_t& reasons) noexcept {
  Stand::State& stand = state_.stand;
  state_.elapsed += period_;
  const ModeKind wanted = request.mode.kind;
  const bool down = wanted == ModeKind::kLie, walks = walk_.requested(request);
  const bool up = wanted == ModeKind::kStand || walks;
  switch (state_.phase) {
    case LegPhase::kLying:
      if (!up && wanted != ModeKind::kJoints) return false;
      if (up && state_.steep != 0 && !gathering_.stands_up_here(input.state, stand.up, reasons)) return false;
      for (std::size_t i = 0; i < kLegsJoints; ++i) stand.angles[i] = input.sensors->joints[i].position;
      state_.joints.begin(stand.angles);
      enter(up ? LegPhase::kGathering : LegPhase::kJoints);
      return true;
    case LegPhase::kJoints:
      state_.joints.step(request, state_.watch.request_cycle(), joint_bounds_, period_, reasons);
      for (std::size_t i = 0; i < kLegsJoints; ++i) stand.angles[i] = state_.joints.axes[i].value;
      if (up) enter(LegPhase::kGathering);
      if (down) enter(LegPhase::kLying);
      return false;
    case LegPhase::kGathering:
      gather(input, reasons);
      if (down) state_.phase = LegPhase::kLying;
      return false;
    case LegPhase::kRising:
      stand_.rise(stand, state_.elapsed, reasons);
      if (down) {
        enter(LegPhase::kLowering, stand_.rise_time() - state_.elapsed);
        state_.sinks = 1;
      } else if (state_.elapsed >= stand_.rise_time()) {
        enter(LegPhase::kStanding);
        stand_.set_margin(stand);
      }
      return false;
    case LegPhase::kStanding:
      stand_.step(stand, request, walks, input.permit->speed_limit, reasons);
      state_.idle = parts_of(request) == 0 ? state_.idle + period_ : 0;
      if (walks && stand.lifted == kLegs && usable(input) && walk_.begin(state_.walk, input, stand_.lean(stand)))
        enter(LegPhase::kWalking);
      if (down || state_.lies_next != 0 || (lie_down_after_ > 0 && state_.idle >= lie_down_after_))
        enter(LegPhase::kLowering);
      return false;
    case LegPhase::kWalking:
      return false;
    case LegPhase::kLowering:
      if (state_.sinks != 0) {
        stand_.sink(stand, stand_.rise_time() - state_.elapsed, reasons);
        if (state_.elapsed >= stand_.rise_time()) enter(LegPhase::kLying);
      } else {
        state_.elapsed = 0;
        state_.sinks = stand_.settle(stand, reasons) ? 1 : 0;
      }
      if (up && state_.phase == LegPhase::kLowering)
        enter(state_.sinks != 0 ? LegPhase::kRising : LegPhase::kStanding, stand_.rise_time() - state_.elapsed);
      return false;
  }
  return false;
}

void LegController::gather(const ControlInput& input, std::uint64_t& reasons) noexcept {
  if (!gathering_.step(state_.gathering, state_.elapsed, state_.stand.angles)) return;
  const bool stands_up = gathering_.stands_up_here(input.state, state_.stand.up, reasons);
  enter(stands_up ? LegPhase::kRising : LegPhase::kLying);
  state_.steep = stands_up ? 0 : 1;
  stand_.begin(state_.stand);
}

void LegController::walk(const ControlInput& input, const Request& request, CommandFrame& out) noexcept {
  if (!usable(input)) {
    out.reasons |= kReasonNoState;
    return pause();
  }
  out.legged.phase = LegPhase::kWalking;
  out.stop_profile = kStopWalking;
  state_.gap = 0;
  if (request.mode.kind == ModeKind::kLie) state_.lies_next = 1;
  if (request.mode.kind == ModeKind::kStand || walk_.requested(request)) state_.lies_next = 0;
  if (walk_.step(state_.walk, input, request, out)) return;
  const std::uint64_t lies_next = state_.lies_next;
  enter(LegPhase::kStanding);
  state_.lies_next = lies_next;
  stand_.begin(state_.stand, walk_.walker().measure(*input.sensors, *input.state), state_.walk.walker.ground);
}

void LegController::enter(LegPhase phase, double elapsed) noexcept {
  state_.phase = phase;
  state_.elapsed = std::max(0.0, elapsed);
  state_.sinks = 0;
  state_.idle = 0;
  state_.lies_next = state_.steep = 0;
  if (phase == LegPhase::kGathering) state_.gathering.from = state_.stand.angles;
}

void LegController::report(CommandFrame& out) const noexcept {
  const Stand::State& stand = state_.stand;
  out.legged.phase = state_.phase;
  out.legged.lifted = state_.phase >= LegPhase::kStanding && stand.lifted != kLegs ? stand.lifted + 1 : 0;
  for (std::size_t leg = 0; leg < kLegs; ++leg) out.contact_schedule[leg] = stand.share[leg] > 0 ? 0.5 : 0;
  if (state_.phase == LegPhase::kStanding) stand_.report(stand, out.legged);
  if (state_.phase == LegPhase::kRising || state_.phase == LegPhase::kStanding || state_.phase == LegPhase::kLowering)
    out.legged.slope = {stand.up[0] / stand.up[2], stand.up[1] / stand.up[2]};
}

}  // namespace robot_control

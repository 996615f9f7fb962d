#pragma once
/// The state machine of the supervisor as data: from state `from`, if `trigger` holds, to state `to`. The first
/// matching row wins, so within a state the severest trigger stands first. At most one transition per cycle; if no row
/// matches, the state stays.
///
///                 complete          motion
///         INIT ◄───────────► READY ◄──────► DRIVE          any brake cause ─► STOPPED
///          ▲    unreleased     │     rest     │            any fault cause ─► FAULT
///          │ reset, incomplete └──── ramp ────┘
///          │                          ▼
///       STOPPED, FAULT ◄── ended ── STOPPING
///          └── reset, complete ──► READY

#include <array>
#include <cstddef>
#include <cstdint>

#include "signals/permit.h"

namespace robot_control {

enum class Trigger : std::uint8_t {
  kFaultCause,       ///< a latched cause with FixedReaction::kFault
  kBrakeCause,       ///< a latched cause that brakes at once
  kRampCause,        ///< a latched cause that ramps
  kRampEnded,        ///< standing, or the ramp's last cycle is reached
  kUnreleased,       ///< a node was started, and no zero velocity was requested since then (motion_release.h)
  kResetIncomplete,  ///< a reset was accepted, but something is still missing (MissingNode) or motion is not released
  kResetComplete,    ///< a reset was accepted, nothing is missing in this run, and motion is released
  kComplete,         ///< nothing is missing in this run, and motion is released
  kMotion,           ///< motion is requested, or the robot moves
  kRest,             ///< no motion is requested, and the robot stands
};
inline constexpr std::size_t kTriggers = 10;

struct Transition {
  SupervisorState from;
  Trigger trigger;
  SupervisorState to;
};

inline constexpr auto kTransitions = std::to_array<Transition>({
    {SupervisorState::kInit, Trigger::kFaultCause, SupervisorState::kFault},
    {SupervisorState::kInit, Trigger::kBrakeCause, SupervisorState::kStopped},
    {SupervisorState::kInit, Trigger::kRampCause, SupervisorState::kStopped},
    {SupervisorState::kInit, Trigger::kComplete, SupervisorState::kReady},

    {SupervisorState::kReady, Trigger::kFaultCause, SupervisorState::kFault},
    {SupervisorState::kReady, Trigger::kBrakeCause, SupervisorState::kStopped},
    {SupervisorState::kReady, Trigger::kRampCause, SupervisorState::kStopping},
    {SupervisorState::kReady, Trigger::kUnreleased, SupervisorState::kInit},
    {SupervisorState::kReady, Trigger::kMotion, SupervisorState::kDrive},

    {SupervisorState::kDrive, Trigger::kFaultCause, SupervisorState::kFault},
    {SupervisorState::kDrive, Trigger::kBrakeCause, SupervisorState::kStopped},
    {SupervisorState::kDrive, Trigger::kRampCause, SupervisorState::kStopping},
    {SupervisorState::kDrive, Trigger::kUnreleased, SupervisorState::kInit},
    {SupervisorState::kDrive, Trigger::kRest, SupervisorState::kReady},

    {SupervisorState::kStopping, Trigger::kFaultCause, SupervisorState::kFault},
    {SupervisorState::kStopping, Trigger::kBrakeCause, SupervisorState::kStopped},
    {SupervisorState::kStopping, Trigger::kUnreleased, SupervisorState::kStopped},
    {SupervisorState::kStopping, Trigger::kRampEnded, SupervisorState::kStopped},

    {SupervisorState::kStopped, Trigger::kFaultCause, SupervisorState::kFault},
    {SupervisorState::kStopped, Trigger::kBrakeCause, SupervisorState::kStopped},
    {SupervisorState::kStopped, Trigger::kRampCause, SupervisorState::kStopped},
    {SupervisorState::kStopped, Trigger::kResetIncomplete, SupervisorState::kInit},
    {SupervisorState::kStopped, Trigger::kResetComplete, SupervisorState::kReady},

    {SupervisorState::kFault, Trigger::kFaultCause, SupervisorState::kFault},
    {SupervisorState::kFault, Trigger::kBrakeCause, SupervisorState::kFault},
    {SupervisorState::kFault, Trigger::kRampCause, SupervisorState::kFault},
    {SupervisorState::kFault, Trigger::kResetIncomplete, SupervisorState::kInit},
    {SupervisorState::kFault, Trigger::kResetComplete, SupervisorState::kReady},
});

/// The triggers that hold in one cycle.
class TriggerSet {
 public:
  constexpr void add(Trigger trigger, bool holds = true) noexcept {
    if (holds) bits_ |= std::uint32_t{1} << static_cast<unsigned>(trigger);
  }
  constexpr bool holds(Trigger trigger) const noexcept { return (bits_ >> static_cast<unsigned>(trigger) & 1U) != 0; }

 private:
  std::uint32_t bits_ = 0;
};

constexpr SupervisorState next_state(SupervisorState state, TriggerSet triggers) noexcept {
#pragma GCC unroll 32  // more than the rows: each is a constant
  for (const Transition& row : kTransitions) {
    if (triggers.holds(row.trigger) && row.from == state) return row.to;
  }
  return state;
}

/// The permit of each state.
constexpr PermitAction action_in(SupervisorState state) noexcept {
  switch (state) {
    case SupervisorState::kReady:
    case SupervisorState::kDrive:
      return PermitAction::kDrive;
    case SupervisorState::kStopping:
      return PermitAction::kRamp;
    case SupervisorState::kInit:
    case SupervisorState::kStopped:
    case SupervisorState::kFault:
      return PermitAction::kBrake;
  }
  return PermitAction::kBrake;
}

}  // namespace robot_control

#pragma once
/// Causes → latch → state. Holds what outlives a cycle and a run: the latched causes, how each stops, which came first.
///
/// A cause once active stays in `causes` until a reset is accepted; nothing else clears it. A reset is refused
/// while a cause is active, there is no evidence that no motion is requested (motion_release.h), a wheel turns, the
/// body may still slide or a node is missing in INIT; during STOPPING it counts as moving. Where nothing is latched
/// (READY, DRIVE) a reset is accepted without effect. The ramp of STOPPING ends at the cycle fixed when it began, or at
/// standstill.
///
/// INIT ends when every node of this run was seen and motion is released (motion_release.h). A start that takes the
/// release back ends READY and DRIVE in INIT and STOPPING in STOPPED: the robot brakes, and no cause is latched for it.

#include <cstdint>

#include "safety/latch/supervisor_table.h"
#include "signals/permit.h"

namespace robot_control {

struct SupervisorInput {
  std::uint64_t cycle = 0;
  std::uint64_t repair = 0;          ///< StopCause bits true in this cycle that brake and wait for a repair
  std::uint64_t brake = 0;           ///< … that brake
  std::uint64_t ramp = 0;            ///< … that ramp
  std::uint64_t missing = 0;         ///< MissingNode bits of this run
  bool released = false;             ///< zero first is satisfied
  bool requested = false;            ///< the controller asks for a motion
  bool no_motion_requested = false;  ///< there is evidence that nothing does
  bool moving = false;               ///< a joint turns in this very cycle
  bool standing = false;             ///< every joint has been slow for a while
  bool sliding = false;              ///< … but the body may still slide
  bool reset_requested = false;
};

class Supervisor {
 public:
  /// `ramp_cycles`: length of the longest category-1 ramp.
  explicit Supervisor(std::uint64_t ramp_cycles) noexcept : ramp_cycles_(ramp_cycles) {}

  void step(const SupervisorInput& input) noexcept;

  /// A new run: INIT, or where a cause is latched STOPPED or FAULT.
  void enter_run() noexcept;

  /// Takes over what an earlier monitor had latched: STOPPED, or FAULT. All of it brakes from now on.
  void restore(std::uint64_t causes, std::uint64_t first_cause) noexcept;

  SupervisorState state() const noexcept { return state_; }
  std::uint64_t causes() const noexcept { return repair_ | brake_ | ramp_; }
  std::uint64_t first_cause() const noexcept { return first_cause_; }
  std::uint64_t since_cycle() const noexcept { return since_cycle_; }
  std::uint64_t ramp_until() const noexcept { return ramp_until_; }
  std::uint64_t reset_refusal() const noexcept { return reset_refusal_; }

 private:
  void latch(const SupervisorInput& input) noexcept;
  std::uint64_t refusal(const SupervisorInput& input) const noexcept;
  SupervisorState latched_state() const noexcept;

  std::uint64_t ramp_cycles_;
  SupervisorState state_ = SupervisorState::kInit;
  std::uint64_t repair_ = 0;  ///< latched
  std::uint64_t brake_ = 0;   ///< latched
  std::uint64_t ramp_ = 0;    ///< latched
  std::uint64_t first_cause_ = 0;
  std::uint64_t since_cycle_ = 0;
  std::uint64_t ramp_until_ = 0;
  std::uint64_t reset_refusal_ = 0;
};

}  // namespace robot_control

#pragma once
/// Causes → latch → state. Holds what outlives a cycle and a run: the latched causes, the reaction to each, the first
/// cause.
///
/// A latched cause stays in `causes` until a reset is accepted; nothing else clears it. A reset is refused while
///   a cause is active,
///   there is no evidence that no motion is requested (motion_release.h),
///   a wheel turns or the state is STOPPING,
///   the body may still slide, or
///   something is missing in INIT (MissingNode).
/// In READY and DRIVE, where nothing is latched, a reset is accepted without effect. The ramp of STOPPING ends at the
/// cycle that was fixed when it began, or at standstill.
///
/// INIT ends when nothing is missing in this run and motion is released (motion_release.h). A node start
/// withdraws the release: READY and DRIVE become INIT, STOPPING becomes STOPPED. The robot brakes, and no cause is
/// latched for it.

#include <cstdint>

#include "safety/latch/supervisor_table.h"
#include "signals/permit.h"

namespace robot_control {

struct SupervisorInput {
  std::uint64_t cycle = 0;
  std::uint64_t fault = 0;                     ///< StopCause bits active in this cycle, with FixedReaction::kFault
  std::uint64_t brake = 0;                     ///< … that brake at once
  std::uint64_t ramp = 0;                      ///< … that ramp
  std::uint64_t missing = 0;                   ///< MissingNode bits of this run
  bool released = false;                       ///< zero first is satisfied
  bool requested = false;                      ///< the controller requests motion
  std::uint64_t motion_refusal = kRefusalGap;  ///< MotionRelease::reset_refusal
  bool moving = false;                         ///< a joint turns in this cycle
  bool standing = false;                       ///< all joints have been slow for the standing time
  bool sliding = false;                        ///< standing, but the body may still slide
  bool reset_requested = false;
};

class Supervisor {
 public:
  /// `ramp_cycles`: length of the longest ramp.
  explicit Supervisor(std::uint64_t ramp_cycles) noexcept : ramp_cycles_(ramp_cycles) {}

  void step(const SupervisorInput& input) noexcept;

  /// A new run: INIT, or where a cause is latched STOPPED or FAULT.
  void enter_run() noexcept;

  /// Takes over the latched causes of an earlier monitor: STOPPED, or FAULT. All of them brake at once.
  void restore(std::uint64_t causes, std::uint64_t first_cause) noexcept;

  SupervisorState state() const noexcept { return state_; }
  std::uint64_t causes() const noexcept { return fault_ | brake_ | ramp_; }
  std::uint64_t first_cause() const noexcept { return first_cause_; }
  std::uint64_t since_cycle() const noexcept { return since_cycle_; }
  std::uint64_t ramp_until() const noexcept { return ramp_until_; }
  std::uint64_t reset_refusal() const noexcept { return reset_refusal_; }
  std::uint64_t stops() const noexcept { return stops_; }  ///< how often a cause latched that was not

 private:
  void latch(const SupervisorInput& input) noexcept;
  std::uint64_t refusal(const SupervisorInput& input) const noexcept;
  SupervisorState latched_state() const noexcept;

  std::uint64_t ramp_cycles_;
  SupervisorState state_ = SupervisorState::kInit;
  std::uint64_t fault_ = 0;  ///< latched
  std::uint64_t brake_ = 0;  ///< latched
  std::uint64_t ramp_ = 0;   ///< latched
  std::uint64_t first_cause_ = 0;
  std::uint64_t since_cycle_ = 0;
  std::uint64_t ramp_until_ = 0;
  std::uint64_t reset_refusal_ = 0;
  std::uint64_t stops_ = 0;
};

}  // namespace robot_control

#pragma once
/// The controller of a robot on four legs: it lies, stands up, moves its body while it stands, lifts one foot, walks,
/// and lies down. While it lies, its joints can be moved one by one. It chooses the law of the phase:
///
///   lying ─► gathering ─► rising ─► standing ─► lowering ─► lying
///   lying ─► joints ─► gathering or lying        standing ─► walking ─► standing
///
///   lying      every joint brakes
///   gathering  the joints move to the lying posture. There the slope of the ground is measured, and on one that is too
///              steep the robot lies again (kReasonTooSteep; posture/gathering.h)
///   rising     the body rises within rise_time (stand/stand.h)
///   standing   the body follows the request, and one foot may be in the air (stand/stand.h)
///   lowering   body and foot return to the nominal pose, then the body sinks (stand/stand.h)
///   joints     the joints follow Request::joints (joints/joint_motion.h)
///   walking    the robot follows a twist (walk/walk.h). A twist lets it stand up, too
///
/// Without a permit, an angle of each joint or, while it walks, a state of this cycle, every joint brakes. The robot
/// goes on where it was if that ends within kMaxGap; else, and after a permit to brake, it lies. A Request::mode that
/// the present posture does not allow has no effect.
///
/// Gains and times follow from mass m and leg length l: stiffness ∝ m l, damping ∝ m l^1.5, times ∝ √l.

#include <cstdint>

#include "control/common/command_watch.h"
#include "control/common/control_input.h"
#include "control/legged/joints/joint_motion.h"
#include "control/legged/leg_controller_parameters.h"
#include "control/legged/posture/gathering.h"
#include "control/legged/stand/stand.h"
#include "control/legged/walk/walk.h"
#include "machine/legs/leg_model.h"
#include "signals/command_frame.h"

namespace robot_control {

inline constexpr std::uint64_t kMaxGap = 20;  ///< cycles; the monitor latches a longer loss

class LegController {
 public:
  static constexpr std::uint64_t kPose = kPartHeight | kPartRoll | kPartPitch | kPartX | kPartY | kPartYaw;
  static constexpr std::uint64_t kExecutable = kPose | Walk::kParts | kPartMode | kPartJoints;  ///< of RequestPart

  /// `period` s.
  LegController(const LegModel& robot, const LegControllerParameters& parameters, double period);

  void enter_run(const VelocityCommand& inbox, bool with_zero) noexcept;

  /// Fills everything but `out.head`. It is real-time safe.
  void step(const ControlInput& input, CommandFrame& out) noexcept;

  LegPhase phase() const noexcept { return state_.phase; }

  struct State {
    explicit State(const CommandWatch& empty) : watch(empty) {}

    CommandWatch watch;
    LegPhase phase = LegPhase::kLying;
    std::uint64_t gap = 0;        ///< cycles in which it could not command, up to the present one
    double elapsed = 0;           ///< s, in this phase
    double idle = 0;              ///< s without a request of motion, while it stands
    std::uint64_t sinks = 0;      ///< 1: lowering, and the body has begun to sink
    std::uint64_t lies_next = 0;  ///< 1: it lies down when the walk has ended
    std::uint64_t steep = 0;      ///< 1: it lies as gathered, on a slope that is too steep
    Gathering::State gathering;
    JointMotion joints;
    Stand::State stand;
    Walk::State walk;
  };
  const State& state() const noexcept { return state_; }
  void set_state(const State& state) noexcept { state_ = state; }

 private:
  void note_ignored(const Request& request, std::uint64_t& reasons) const noexcept;
  bool advance(const Request& request, const ControlInput& input, std::uint64_t& reasons) noexcept;
  void gather(const ControlInput& input, std::uint64_t& reasons) noexcept;
  void walk(const ControlInput& input, const Request& request, CommandFrame& out) noexcept;
  void pause() noexcept;
  void enter(LegPhase phase, double elapsed = 0) noexcept;
  void report(CommandFrame& out) const noexcept;

  double period_;
  double lie_down_after_;  ///< s; 0: never
  Gathering gathering_;
  AllJointBounds joint_bounds_;
  Stand stand_;
  Walk walk_;
  State state_;
};

}  // namespace robot_control

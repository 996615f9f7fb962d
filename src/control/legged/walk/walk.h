#pragma once
/// A robot walks: the gait and the pose that its legs carry, and how the walk begins and ends.
///
/// A twist other than zero, or a requested gait, begins the walk. Before that the body comes within its ranges, so that
/// the legs carry it on the spot. A zero ends the walk: steps in place set the feet on their places, then all feet
/// stand for kAllDown.
///
/// Another gait begins when its legs carry the body at the twist of then. Until then the twist is limited by both gaits
/// (walking_speed.h). Meanwhile the body takes height, roll and pitch of the request within half of their ranges. It
/// takes no more than the legs carry on the spot (leg_use.h). The twist is limited to what they carry in the pose in
/// force and in the requested one. The body waits before a pose in which they do not carry the twist of now.

#include <array>
#include <cstdint>

#include "control/common/control_input.h"
#include "control/legged/leg_controller_parameters.h"
#include "control/legged/leg_tuning.h"
#include "control/legged/tracked_axis.h"
#include "control/legged/walk/leg_use.h"
#include "control/legged/walk/twist_limiter.h"
#include "control/legged/walk/walker.h"
#include "control/legged/walk/walking_speed.h"
#include "signals/command_frame.h"

namespace robot_control {

class Walk {
 public:
  static constexpr std::uint64_t kParts = kPartLinearX | kPartLinearY | kPartAngularZ;  ///< of RequestPart

  /// The part of a twist that the legs carry, in two poses and two gaits.
  struct CarriedTwist {
    WalkingTwist twist{};
    std::array<CarriedBody, 2> bodies{};
    std::array<std::uint64_t, 2> gaits{};
    double part = 1;  ///< 0 … 1

    bool operator==(const CarriedTwist&) const = default;
  };

  struct State {
    Walker::State walker;
    TwistLimiter::State twist;
    std::array<TrackedAxis, 3> carried{};  ///< of CarriedBody
    CarriedBody lean_wanted{};             ///< what was requested last, within the ranges
    CarriedBody lean_target{};             ///< what the legs carry of it on the spot
    CarriedTwist carried_twist;            ///< of the last cycle
    std::uint64_t gait = kStandGait;       ///< the last one that was chosen
    double idle = 0;                       ///< s without a request of motion
  };

  /// `period` s.
  Walk(const LegModel& robot, const LegControllerParameters& parameters, double period);

  /// Returns true if this gait can be requested.
  bool has_gait(std::uint64_t gait) const noexcept { return gait != kStandGait && gait < fastest_.size(); }

  /// Returns true if this request asks the robot to walk.
  bool requested(const Request& request) const noexcept;

  /// Begins to walk with this body (CarriedBody). Returns false until that is possible.
  bool begin(State& state, const ControlInput& input, const std::array<TrackedAxis, 3>& body) const noexcept;

  /// Fills the command; `input.state` is valid. Returns false when the walk has ended.
  bool step(State& state, const ControlInput& input, const Request& request, CommandFrame& out) noexcept;

  const Walker& walker() const noexcept { return walker_; }

 private:
  std::uint64_t choose_gait(State& state, const Request& request, const WalkingTwist& target) const noexcept;
  double pace_of(const WalkingTwist& twist) const noexcept;
  WalkingTwist capable(const State& state, std::uint64_t wanted) const noexcept;
  bool may_end(const State& state, const ControlInput& input) const noexcept;
  bool carries(const State& state, std::uint64_t gait, const WalkingTwist& twist) const noexcept;
  double used(const State& state, const WalkingTwist& twist, const CarriedBody& body, std::uint64_t wanted,
              const CarriedBody& rates = {}) const noexcept;
  double carried_part(State& state, const WalkingTwist& twist, std::uint64_t wanted) const noexcept;
  void lean(State& state, const Posture& posture, std::uint64_t wanted, std::uint64_t& reasons) const noexcept;

  double period_;
  LegTuning tuning_;
  std::array<AxisBounds, 3> motion_;  ///< of CarriedBody
  TwistLimiter limiter_;
  Walker walker_;
  LegUse leg_use_;
  Speeds fastest_;     ///< by gait
  double time_scale_;  ///< √(l / kReferenceLeg): times and speeds of robots of equal Froude number are as these
  double foot_distance_ = 0;  ///< m, of the farthest foot from the centre of gravity
  double placed_;             ///< m, of each foot from its nominal place, where the robot can lie down
};

}  // namespace robot_control

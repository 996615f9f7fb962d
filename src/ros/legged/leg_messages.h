#pragma once
/// These functions convert requests and commands of robots on legs to and from messages. They are pure.

#include <robot_control/BodyPose.h>
#include <robot_control/FootTarget.h>
#include <robot_control/LegState.h>
#include <robot_control/SetGait.h>
#include <robot_control/SetGaitRequest.h>
#include <robot_control/SetGaitResponse.h>
#include <robot_control/SetPosture.h>
#include <robot_control/SetPostureRequest.h>
#include <robot_control/SetPostureResponse.h>
#include <ros/time.h>

#include <optional>
#include <string>

#include "control/legged/walk/gait.h"
#include "machine/legs/leg_model.h"
#include "ros/messages/bounded_message.h"
#include "signals/command_frame.h"
#include "signals/permit.h"
#include "signals/robot_kinds.h"
#include "signals/sensor_frame.h"
#include "signals/state_frame.h"

namespace robot_control {

inline constexpr std::uint32_t kMaxFootName = 64;  ///< bytes
using BoundedBodyPose = Bounded<BodyPose, 48>;
using BoundedFootTarget = Bounded<FootTarget, 28, 28 + kMaxFootName>;

Posture posture_of(const BodyPose& message);

/// Returns the request that lifts this foot, and the zero request for no name. Returns none for an unknown foot.
std::optional<Request> request_of(const FootTarget& message);

/// Returns "front_left, front_right, rear_left, rear_right".
std::string foot_names();

/// Returns the mode of a posture of set_posture, the default one for an unknown posture.
Mode mode_of(const std::string& posture);

/// Returns the gait of a mode that mode_of_gait returns, as set_gait takes it.
std::string gait_of_mode(const Mode& mode, const Gaits& gaits);

/// Returns the mode that walks with the gait of set_gait, the default one for "auto". Returns none for an unknown gait.
std::optional<Mode> mode_of_gait(const std::string& gait, const Gaits& gaits);

/// Keeps which feet of this run were lifted over an obstacle or found no ground within the last kShown. A foot finds no
/// ground for a few cycles, and a page shows every fiftieth one.
class MetGround {
 public:
  static constexpr std::int64_t kShown = 200'000'000;  ///< ns

  /// `risers` and `reaches` as in LeggedCommand, of cycles up to now.
  void add(std::uint64_t risers, std::uint64_t reaches, const FrameHead& now) noexcept;

  bool met_riser(std::size_t leg) const noexcept { return shown(risers_ns_[leg]); }
  bool reaching(std::size_t leg) const noexcept { return shown(reaches_ns_[leg]); }

 private:
  bool shown(std::int64_t at_ns) const noexcept { return std::abs(now_ns_ - at_ns) <= kShown; }

  static constexpr std::array<std::int64_t, kLegs> kNever{-kShown - 1, -kShown - 1, -kShown - 1, -kShown - 1};
  std::array<std::int64_t, kLegs> risers_ns_ = kNever, reaches_ns_ = kNever;
  std::uint64_t run_ = 0;
  std::int64_t now_ns_ = 0;
};

/// The inputs of a LegState. `plan` is the command two cycles before `command`; an ideal joint now has its angles.
struct LegReport {
  const CommandFrame& command;
  const CommandFrame& plan;
  const SensorFrame& sensors;
  const StateFrame& state;
  const Gaits& gaits;
  std::uint64_t reasons;  ///< CommandReason bits
  const MetGround& met;
};

/// Fills everything but the senders and the chosen gait.
LegState leg_state(const LegReport& report, const LegModel& robot, ros::Time stamp);

/// Returns how the ground below a robot on its feet rises, in words: "rises 10.2 deg to the front". "": it is level.
std::string ground_words(const LeggedCommand& command);

/// Returns the measured slope of the ground in words where it is a reason; else "".
std::string slope_words(std::uint64_t reasons, const StateFrame& state, const LegModel& robot);

/// Returns why no motion is permitted, and what to do, or "" if it is. `found` says whether there is a live permit.
std::string no_permission(bool found, const Permit& permit, const MachineModel& robot, const Programs& programs);

}  // namespace robot_control

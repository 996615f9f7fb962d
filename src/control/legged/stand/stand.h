#pragma once
/// A robot rises, stands and sinks on its feet. While it stands, its body or one foot in the air follows the request.
///
///   rising     the feet go down to the ground where they lie. The body rises to the nominal height, with its centre of
///              gravity amid the feet along the vertical
///   body       moves to the posture of the request, from the nominal pose. Where no request is in force any more
///              (kNoRequest), it stops where it is
///   foot       moves to the posture of the request, from where it stood: x, y, and height above the ground. The body
///              has its nominal attitude. Without a request the foot is set down again
///
/// To lift a foot, the body first moves its centre of gravity above the other feet. Then this foot's share of the
/// weight goes to zero, and it goes up. It carries again after it was set down.
///
/// Every axis of the body and of the foot is limited in speed, acceleration and range. The axes of the body share their
/// acceleration (tracked_axis.h), and roll and pitch share their range. So a request that steps on all axes does not
/// unload a foot. The body stops before a pose for which a joint meets the end of its range (kReasonOutOfReach). It
/// also stops before a pose with an almost straight knee, or with a knee on the ground. To lie down it returns from any
/// pose.
///
/// If the speed of the base is limited to v, body and lifted foot follow the request at v/V of their speeds
/// (kReasonPermitSlow). V is the largest speed of the body to the front. At v = 0 both stay where they are. Standing
/// up, setting a foot down and lying down are not limited.

#include <array>
#include <cstdint>

#include "control/legged/stand/stance.h"
#include "signals/velocity_command.h"

namespace robot_control {

struct WalkingBody;

inline constexpr double kLoadTime = 0.2;  ///< s, in which a foot's share of the weight comes and goes

/// Returns the leg whose foot this mode lifts; kLegs: none.
std::uint64_t lifted_by(const Mode& mode) noexcept;

class Stand : public Stance {
 public:
  struct State : Stance::State {
    std::array<double, 2> home{};  ///< m, x and y of the standing body: its centre of gravity is amid its feet
    Pose held{};                   ///< from the nominal pose, what the body moves to
    std::uint64_t follows = 0;     ///< 1: `held` is that of a request in force
    double margin = 0;             ///< of `spare`, which the body keeps: kMargin, or that of the nominal pose
    std::uint64_t blocked = 0;     ///< 1: the body brakes before a pose that it does not enter
    Pose blocked_target{};         ///< what was requested then
    Vector3 foot_target{};         ///< m
  };

  /// `period` s.
  Stand(const LegModel& robot, double period);

  /// Begins to rise from the lying posture.
  void begin(State& state) const noexcept;

  /// Begins to stand where a walk has ended. `ground`: m, its height below the base, and its slopes to the front and
  /// left.
  void begin(State& state, const WalkingBody& body, const Vector3& ground) const noexcept;

  /// Sets how far the body may go from the pose in which it begins to stand.
  void set_margin(State& state) const noexcept;

  /// Puts the body where it is `elapsed` s after it began to rise.
  void rise(State& state, double elapsed, std::uint64_t& reasons) const noexcept;

  /// Puts the body where it is `left` s before it lies.
  void sink(State& state, double left, std::uint64_t& reasons) const noexcept;

  /// Follows the request in force; a body that shall walk returns to the nominal pose. `speed_limit` m/s.
  void step(State& state, const Request& request, bool walks, double speed_limit,
            std::uint64_t& reasons) const noexcept;

  /// Returns body and foot to the nominal pose. Returns true once they are there.
  bool settle(State& state, std::uint64_t& reasons) const noexcept;

  /// Height above the nominal one in m, roll and pitch in rad.
  std::array<TrackedAxis, 3> lean(const State& state) const noexcept;

  /// Fills the pose of the body from the nominal one, and the slope of the ground.
  void report(const State& state, LeggedCommand& out) const noexcept;

  double rise_time() const noexcept { return tuning_.rise_time; }

 private:
  void find_home(State& state) const noexcept;
  Pose nominal_pose(const State& state) const noexcept;
  void choose_pose(State& state, const Posture& to, std::uint64_t& reasons) const noexcept;
  void limit_lean(State& state, std::uint64_t& reasons) const noexcept;
  bool move(State& state, const Pose& target, double pace, std::uint64_t& reasons) const noexcept;
  void move_foot(State& state, const Posture* wanted, bool supported, double pace,
                 std::uint64_t& reasons) const noexcept;

  std::array<AxisBounds, 6> body_motion_;
};

}  // namespace robot_control

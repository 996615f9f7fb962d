#pragma once
/// Brings a robot to a goal: plans, drives, watches, waits and gives up. It reads no clock and knows no ROS;
/// follow_path drives the velocities and paths that it requests.
///
///   planning   the first plan of a goal; a goal that the map alone does not allow is refused at once
///   driving    while the cost to the goal is above kApproach, a LocalController chooses the velocity. The costs are
///              computed again every kReplanPeriod, of large maps less often; those that do not reach the robot are not used, because an obstacle
///              may go away. The rest is a path, which ends exactly at the goal. A path also replaces the
///              LocalController if the robot came no nearer for kStuckTime, and nothing moved within kEvadeDistance of
///              it. It does so for kStuckTime, and until the cost is below that of the place: the costs may lead
///              through a gap that no outline passes
///   waiting    nothing is driven: there is no path, it is blocked within kStopDistance, or the laser, the map or the
///              pose cannot be trusted. The goal is given up after kNoProgressTime; before the first path, after
///              kFirstPathTime
///
/// After follow_path has given up, a path is planned again, kAttempts times without kMinProgress in between. No later
/// path from standstill restarts these times. follow_path refuses what a stop of the robot has revoked. While it is
/// paused, it keeps what it has.

#include <limits>
#include <optional>
#include <string>

#include "navigation/goals/local_controller.h"
#include "navigation/goals/planner.h"

namespace robot_control::navigation {

inline constexpr double kNoProgressTime = 20;  ///< s
inline constexpr double kFirstPathTime = 2;    ///< s, in which a map, a scan and tf arrive after a start
inline constexpr double kReplanPeriod = 1;     ///< s
inline constexpr double kStopDistance = 0.6;   ///< m
inline constexpr double kApproach = 0.8;       ///< m of cost to the goal
inline constexpr double kStuckTime = 4;        ///< s
inline constexpr double kEvadeDistance = 2;    ///< m
inline constexpr double kNarrowFactor = 5;     ///< of the costs where the robot cannot turn
inline constexpr double kMinProgress = 0.3;    ///< m
inline constexpr int kAttempts = 3;

/// The state of the last path that was sent to follow_path.
struct PathReport {
  enum class State { kNone, kActive, kPaused, kDone, kFailed };
  State state = State::kNone;
  std::string reason;  ///< of a failure
};

struct NavigatorInput {
  double now = 0;           ///< s of a clock that does not turn back
  std::string problem;      ///< why map, scan or place cannot be trusted now; then `pose` may be old
  std::string explanation;  ///< what the reason of a failure ends with
  std::string slowed_by;    ///< what slows the robot, if something does: why it may not come nearer
  PlanarPose pose;          ///< of the base in the map
  PlanarMotion motion;      ///< as measured
  PathReport path;
  DriveLimits limits;                                      ///< of the robot; zones and the goal's speed reduce them
  std::vector<MovingObject> objects;                       ///< in the map
  double speed = std::numeric_limits<double>::infinity();  ///< m/s of the goal
};

enum class NavigatorState { kIdle, kPlanning, kDriving, kWaiting, kReached, kFailed };

/// Returns "idle", "planning", "driving", "waiting", "reached" or "failed".
const char* name_of(NavigatorState state);

struct NavigatorOutput {
  NavigatorState state = NavigatorState::kIdle;
  std::string reason;        ///< why it waits, failed or does not come nearer
  double remaining = 0;      ///< m of the path, of which those near obstacles count up to twice
  std::optional<Plan> path;  ///< to be sent to follow_path in place of what it drives
  double speed = 0;          ///< m/s, of that path
  std::optional<PlanarMotion>
      request;          ///< the velocity to be driven; that path, and those before it, only show the way
  bool cancel = false;  ///< follow_path is to stop
};

class Navigator {
 public:
  /// Begins a goal, in place of the one before, whose path is driven until the new one is planned or refused.
  void begin(const PlanarPose& goal, double now);

  /// Ends the goal.
  void end() { *this = Navigator(); }

  /// `costmap` is null without a map, and then `input.problem` says so.
  NavigatorOutput step(const NavigatorInput& input, Costmap* costmap);

  bool active() const noexcept {
    return state_ == NavigatorState::kPlanning || state_ == NavigatorState::kDriving ||
           state_ == NavigatorState::kWaiting;
  }

 private:
  void wait(const std::string& reason, NavigatorOutput& out);
  void fail(const std::string& reason, NavigatorOutput& out);
  void plan(const NavigatorInput& input, Costmap& costmap, NavigatorOutput& out);
  void drive(const NavigatorInput& input, Costmap& costmap, NavigatorOutput& out);
  bool begin_steering(const NavigatorInput& input, Costmap& costmap, const Plan& way, NavigatorOutput& out);
  void steer(const NavigatorInput& input, Costmap& costmap, NavigatorOutput& out);
  double update_costs(const NavigatorInput& input, const Costmap& costmap);
  void note_progress(const NavigatorInput& input, double left);
  double remaining(const PlanarPose& pose) const;

  NavigatorState state_ = NavigatorState::kIdle;
  PlanarPose goal_;
  bool sent_ = false;  // follow_path has a path, of this goal or of the one before
  Plan path_;
  std::size_t passed_ = 0;                        // poses of path_
  bool driven_ = false;                           // a path of this goal was sent
  double progress_at_ = 0;                        // s, when the robot last came nearer or began a path
  double least_remaining_ = 0;                    // m
  double planned_at_ = -1e9, updated_at_ = -1e9;  // s
  int attempts_ = 0;
  std::optional<LocalController> controller_;
  CostsToGoal to_goal_;
  bool steering_ = false;
  double costs_at_ = -1e9, steered_at_ = -1e9, path_until_ = -1e9;  // s
  double costs_period_ = 0;                                         // s
  double stuck_at_ = std::numeric_limits<double>::infinity();       // m of cost to the goal
  std::string reason_;
};

}  // namespace robot_control::navigation

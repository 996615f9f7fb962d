#include "navigation/goals/navigator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "navigation/goals/straightening.h"
#include "signals/formatted_text.h"

namespace robot_control::navigation {
namespace {

/// s between two updates of the distances: 20 ns a cell are 5 % of one processor at most.
double update_period(const Costmap& costmap) {
  return 4e-7 * static_cast<double>(costmap.grid().cells.size());
}

constexpr double kCostsPeriod = 2e-6;  // s a cell: 0.2 µs are 10 % of one processor at most

/// Returns whether something moves within kEvadeDistance.
bool near(const std::vector<MovingObject>& objects, const PlanarPose& pose) {
  return std::ranges::any_of(objects, [&](const MovingObject& object) {
    return std::hypot(object.points[0].x - pose.x, object.points[0].y - pose.y) < kEvadeDistance;
  });
}

bool is_paused(const NavigatorInput& input) {
  return input.path.state == PathReport::State::kPaused;
}

/// Returns the limits of the robot at this place.
DriveLimits limits_at(const NavigatorInput& input, const Costmap& costmap, const PlanarPose& pose) {
  DriveLimits limits = input.limits;
  const double speed =
      std::min(input.speed, costmap.zones().speed_limit({pose.x, pose.y}, limits.forward, limits.linear_acceleration));
  for (double* const limit : {&limits.forward, &limits.reverse, &limits.lateral}) *limit = std::min(*limit, speed);
  return limits;
}

/// Returns the speed that is allowed everywhere on the path.
double speed_on(const Plan& plan, const NavigatorInput& input, const Costmap& costmap) {
  double speed = std::min(input.speed, input.limits.forward);
  for (const PlanarPose& pose : plan.poses) speed = std::min(speed, limits_at(input, costmap, pose).forward);
  return speed;
}

}  // namespace

const char* name_of(NavigatorState state) {
  constexpr std::array kNames = {"idle", "planning", "driving", "waiting", "reached", "failed"};
  return kNames[static_cast<std::size_t>(state)];
}

void Navigator::begin(const PlanarPose& goal, double now) {
  const bool sent = sent_;
  *this = Navigator();
  sent_ = sent;
  state_ = NavigatorState::kPlanning;
  goal_ = goal;
  progress_at_ = now;
}

void Navigator::wait(const std::string& reason, NavigatorOutput& out) {
  out.cancel = std::exchange(sent_, false);
  if (driven_) state_ = NavigatorState::kWaiting;
  steering_ = false;
  reason_ = reason;
}

void Navigator::fail(const std::string& reason, NavigatorOutput& out) {
  out = {};
  out.cancel = std::exchange(sent_, false);
  state_ = NavigatorState::kFailed;
  reason_ = reason;
}

NavigatorOutput Navigator::step(const NavigatorInput& input, Costmap* costmap) {
  NavigatorOutput out;
  if (active()) {
    if (!input.problem.empty() && is_paused(input)) {
      reason_ = input.problem;
    } else if (!input.problem.empty()) {
      wait(input.problem, out);
    } else if (costmap->let_out(input.pose); state_ == NavigatorState::kDriving) {
      drive(input, *costmap, out);
    } else if (input.now - planned_at_ >= kReplanPeriod) {
      plan(input, *costmap, out);
    }
    const double longest = driven_ ? kNoProgressTime : kFirstPathTime, waited = input.now - progress_at_;
    if (active() && waited > longest)
      fail((reason_.empty() ? "the robot does not move" : reason_) + formatted(" (for %.0f s)", waited), out);
  }
  out.state = state_;
  if (state_ == NavigatorState::kFailed) reason_ += input.explanation;
  if (state_ != NavigatorState::kReached) out.reason = reason_;
  if (state_ == NavigatorState::kDriving) out.remaining = steering_ ? least_remaining_ : remaining(input.pose);
  return out;
}

void Navigator::plan(const NavigatorInput& input, Costmap& costmap, NavigatorOutput& out) {
  planned_at_ = input.now;
  costmap.update(input.now);
  Plan found = plan_path(costmap, input.pose, goal_);
  if (!found.problem.empty()) {
    const std::string blocked = found.problem;
    if (!driven_) {
      costmap.update(std::numeric_limits<double>::infinity());  // the map alone
      found = plan_path(costmap, input.pose, goal_);
      costmap.update(input.now);
      if (!found.problem.empty()) return fail(found.problem, out);
      driven_ = true;  // there is a path once the obstacle has gone
    }
    return wait(blocked, out);
  }
  if (begin_steering(input, costmap, found, out)) return;
  if (state_ != NavigatorState::kDriving && attempts_++ <= kAttempts) progress_at_ = input.now;
  state_ = NavigatorState::kDriving;
  driven_ = sent_ = true;
  steering_ = false;
  passed_ = 0;
  path_ = found;
  least_remaining_ = found.length;
  reason_.clear();
  out.speed = speed_on(found, input, costmap);
  out.path = std::move(found);
}

/// Returns false if the robot is near the goal, or stuck.
bool Navigator::begin_steering(const NavigatorInput& input, Costmap& costmap, const Plan& way, NavigatorOutput& out) {
  if (input.now < path_until_) return false;
  costmap.update(input.now, false);
  costs_at_ = -1e9;
  const double left = update_costs(input, costmap);
  if (left < kApproach || left >= stuck_at_) return false;
  stuck_at_ = std::numeric_limits<double>::infinity();
  if (state_ == NavigatorState::kPlanning) progress_at_ = input.now;
  if (state_ != NavigatorState::kDriving) ++attempts_;
  state_ = NavigatorState::kDriving;
  driven_ = sent_ = steering_ = true;
  steered_at_ = input.now;
  least_remaining_ = left;
  reason_.clear();
  if (!controller_) controller_.emplace(costmap.footprint());
  controller_->reset();
  out.speed = speed_on(way, input, costmap);
  out.path = way;
  steer(input, costmap, out);
  return true;
}

void Navigator::steer(const NavigatorInput& input, Costmap& costmap, NavigatorOutput& out) {
  if (input.now - updated_at_ >= update_period(costmap)) {
    updated_at_ = input.now;
    costmap.update(input.now, false);
  }
  const double left = update_costs(input, costmap);
  note_progress(input, left);
  const bool paused = is_paused(input);
  if (paused || near(input.objects, input.pose)) steered_at_ = input.now;
  const bool stuck = input.now - std::max(progress_at_, steered_at_) > kStuckTime;
  if (!paused && (left < kApproach || stuck)) {
    path_until_ = input.now + kStuckTime;
    if (stuck) stuck_at_ = left;
    return plan(input, costmap, out);
  }
  const DriveLimits limits = limits_at(input, costmap, input.pose);
  out.request = controller_->step(limits, costmap, to_goal_, input.pose, input.motion, input.objects);
  reason_ = input.now - progress_at_ > kReplanPeriod ? input.slowed_by : "";
}

double Navigator::update_costs(const NavigatorInput& input, const Costmap& costmap) {
  if (input.now - costs_at_ >= std::max(kReplanPeriod, costs_period_)) {
    costs_at_ = input.now;
    CostsToGoal found = costs_to(costmap, goal_, kNarrowFactor, Point{input.pose.x, input.pose.y});
    costs_period_ = kCostsPeriod * static_cast<double>(found.settled);
    if (to_goal_.costs.empty() || std::isfinite(found.at(input.pose.x, input.pose.y))) to_goal_ = std::move(found);
  }
  return to_goal_.at(input.pose.x, input.pose.y);
}

void Navigator::drive(const NavigatorInput& input, Costmap& costmap, NavigatorOutput& out) {
  if (input.path.state == PathReport::State::kFailed) {
    if (attempts_ > kAttempts) return fail(input.path.reason, out);
    state_ = NavigatorState::kWaiting;
    steering_ = false;
    reason_ = input.path.reason;
    return;
  }
  const bool paused = is_paused(input);
  if (!paused && is_outside(costmap, goal_)) return plan(input, costmap, out);  // of a map that was replaced
  if (steering_) return steer(input, costmap, out);
  if (input.path.state == PathReport::State::kDone) {
    state_ = path_.partial ? NavigatorState::kWaiting : NavigatorState::kReached;
    return;
  }
  const double left = update_costs(input, costmap);
  if (!paused && input.now >= path_until_ && left < stuck_at_ && left > 2 * kApproach) return plan(input, costmap, out);
  if (input.now - updated_at_ >= update_period(costmap)) {
    updated_at_ = input.now;
    costmap.update(input.now);
  }
  const bool blocked = free_distance(costmap, path_.poses, input.pose, passed_) < kStopDistance;
  note_progress(input, remaining(input.pose));
  if (blocked && !paused) {
    if (input.now - planned_at_ >= kReplanPeriod) plan(input, costmap, out);
    if (state_ == NavigatorState::kDriving && !out.path) wait("the path is blocked", out);
  } else {
    reason_ = input.now - progress_at_ > kReplanPeriod ? input.slowed_by : "";
  }
}

void Navigator::note_progress(const NavigatorInput& input, double left) {
  if (left < least_remaining_ - kMinProgress) {
    least_remaining_ = left;
    attempts_ = 0;
    progress_at_ = input.now;
  }
}

double Navigator::remaining(const PlanarPose& pose) const {
  double left = 0;
  if (passed_ < path_.poses.size()) {
    const std::size_t next = std::min(passed_ + 1, path_.poses.size() - 1);
    left = std::hypot(path_.poses[next].x - pose.x, path_.poses[next].y - pose.y);
    for (std::size_t i = next + 1; i < path_.poses.size(); ++i) {
      left += std::hypot(path_.poses[i].x - path_.poses[i - 1].x, path_.poses[i].y - path_.poses[i - 1].y);
    }
  }
  return left;
}

}  // namespace robot_control::navigation

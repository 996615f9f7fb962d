#include "navigation/navigator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "signals/formatted_text.h"

namespace robot_control::navigation {
namespace {

/// s between two updates of the distances: 20 ns a cell are 5 % of one processor at most.
double update_period(const Costmap& costmap) {
  return std::max(0.2, 4e-7 * static_cast<double>(costmap.grid().cells.size()));
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
  reason_ = reason;
}

void Navigator::fail(const std::string& reason, NavigatorOutput& out) {
  out.cancel = std::exchange(sent_, false);
  state_ = NavigatorState::kFailed;
  reason_ = reason;
}

NavigatorOutput Navigator::step(const NavigatorInput& input, Costmap* costmap) {
  NavigatorOutput out;
  if (active()) {
    if (!input.problem.empty()) {
      wait(input.problem, out);
    } else if (state_ == NavigatorState::kDriving) {
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
  if (input.limits.forward > 0 && input.now >= path_until_) {
    costmap.update(input.now, false);
    to_goal_ = costs_to(costmap, goal_, kNarrowFactor);
    costs_at_ = input.now;
    const double left = cost_at(costmap, input.pose);
    steering_ = std::isfinite(left) && left > kApproach;
    if (steering_) {
      if (state_ == NavigatorState::kPlanning) progress_at_ = input.now;
      out.cancel = state_ == NavigatorState::kPlanning && sent_;
      state_ = NavigatorState::kDriving;
      driven_ = sent_ = true;
      least_remaining_ = left;
      reason_.clear();
      if (!controller_) controller_.emplace(costmap.footprint());
      return steer(input, costmap, out);
    }
  }
  steering_ = false;
  costmap.update(input.now);
  const PlanarPose stop = stop_pose(input.pose, input.motion), start = costmap.free(stop) ? stop : input.pose;
  Plan found = plan_path(costmap, start, goal_);
  if (!found.problem.empty()) {
    const std::string blocked = found.problem;
    if (state_ == NavigatorState::kDriving) {  // the present path may still be free for a while
      reason_ = blocked;
      return;
    }
    if (!driven_) {
      costmap.update(std::numeric_limits<double>::infinity());  // the map alone
      found = plan_path(costmap, start, goal_);
      costmap.update(input.now);
      if (!found.problem.empty()) return fail(found.problem, out);
      driven_ = true;  // there is a path once the obstacle has gone
    }
    return wait(blocked, out);
  }
  if (state_ != NavigatorState::kDriving && attempts_++ <= kAttempts) progress_at_ = input.now;
  state_ = NavigatorState::kDriving;
  driven_ = sent_ = true;
  passed_ = 0;
  path_ = found;
  least_remaining_ = found.length;
  reason_.clear();
  out.path = std::move(found);
}

void Navigator::steer(const NavigatorInput& input, Costmap& costmap, NavigatorOutput& out) {
  costmap.update(input.now, false);
  if (input.now - costs_at_ >= kReplanPeriod) {
    to_goal_ = costs_to(costmap, goal_, kNarrowFactor);
    costs_at_ = input.now;
  }
  const double left = cost_at(costmap, input.pose);
  if (std::isfinite(left)) note_progress(input, left);
  const bool stuck = input.now - progress_at_ > kStuckTime;
  if (!std::isfinite(left) || left < kApproach || stuck) {
    path_until_ = input.now + kStuckTime;
    return plan(input, costmap, out);
  }
  out.request = controller_->step(input.limits, costmap, to_goal_, input.pose, input.motion, input.objects);
  reason_ = input.now - progress_at_ > kReplanPeriod ? input.slowed_by : "";
}

double Navigator::cost_at(const Costmap& costmap, const PlanarPose& pose) const {
  return to_goal_[costmap.grid().index(costmap.grid().cell_at(pose.x, pose.y))];
}

void Navigator::drive(const NavigatorInput& input, Costmap& costmap, NavigatorOutput& out) {
  if (steering_) return steer(input, costmap, out);
  if (input.limits.forward > 0 && input.now >= path_until_ && cost_at(costmap, input.pose) > 2 * kApproach)
    return plan(input, costmap, out);
  if (input.path.state == PathReport::State::kDone) {
    state_ = path_.partial ? NavigatorState::kWaiting : NavigatorState::kReached;
    return;
  }
  if (input.path.state == PathReport::State::kFailed) {
    if (attempts_ > kAttempts) return fail(input.path.reason, out);
    state_ = NavigatorState::kWaiting;
    reason_ = input.path.reason;
    return;
  }
  if (input.now - updated_at_ >= update_period(costmap)) {
    updated_at_ = input.now;
    costmap.update(input.now);
  }
  const double free = free_distance(costmap, path_.poses, input.pose, passed_);
  note_progress(input, remaining(input.pose));
  const bool blocked = free < kMinFreeDistance;
  const bool ends = path_.partial && remaining(input.pose) < kWindow / 4;
  if ((blocked || ends) && input.now - planned_at_ >= kReplanPeriod) plan(input, costmap, out);
  if (blocked && !out.path && free < kStopDistance) wait(reason_.empty() ? "the path is blocked" : reason_, out);
  if (!blocked) reason_ = input.now - progress_at_ > kReplanPeriod ? input.slowed_by : "";
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

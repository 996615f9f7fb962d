#include "ros/legged/joint_trajectory.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <utility>

#include "files/ascii.h"
#include "machine/description/wording.h"
#include "parameters/block.h"

namespace robot_control {
namespace {

constexpr double kSamePlace = 0.05;  // rad, from a point at time 0 to where the joint is
constexpr double kWritten = 1e-6;    // rad, and part of a speed, by which a number that was written as text may be off

/// The path of one joint between two points: p(t) = a + b t + c t² + d t³ for 0 ≤ t ≤ `time`.
struct Cubic {
  double a = 0, b = 0, c = 0, d = 0;
  double time = 0;  // s

  Cubic(double from, double leaving, double to, double arriving, double duration)
      : a(from), b(leaving), time(duration) {
    const double slope = (to - from) / time;
    c = (3 * slope - 2 * leaving - arriving) / time;
    d = (leaving + arriving - 2 * slope) / (time * time);
  }
  double position(double t) const { return a + t * (b + t * (c + t * d)); }
  double speed(double t) const { return b + t * (2 * c + 3 * t * d); }

  double largest_speed() const {
    double largest = std::max(std::abs(speed(0)), std::abs(speed(time)));
    if (d == 0) return largest;
    const double turn = -c / (3 * d);
    return turn > 0 && turn < time ? std::max(largest, std::abs(speed(turn))) : largest;
  }

  /// Returns the smallest and the largest position.
  std::pair<double, double> extent() const {
    auto [low, high] = std::minmax({position(0), position(time)});
    const double root = std::sqrt(std::max(0.0, c * c - 3 * d * b));
    for (const double t : {d != 0 ? (-c + root) / (3 * d) : -b / (2 * c), d != 0 ? (-c - root) / (3 * d) : 0.0}) {
      if (!(t > 0 && t < time)) continue;
      low = std::min(low, position(t));
      high = std::max(high, position(t));
    }
    return {low, high};
  }
};

std::string joint_names(const LegModel& robot) {
  std::string names;
  for (const JointModel& joint : robot.joints) names.append(names.empty() ? "" : ", ").append(joint.name);
  return names;
}

/// Sets the index of each named joint. Returns "", or the problem.
std::string find_joints(const trajectory_msgs::JointTrajectory& message, const LegModel& robot,
                        std::vector<std::size_t>& joints) {
  if (message.joint_names.empty()) return "it names no joint; name some of " + joint_names(robot);
  for (const std::string& name : message.joint_names) {
    const auto found = std::ranges::find(robot.joints, name, &JointModel::name);
    if (found == robot.joints.end())
      return "there is no joint '" + ascii(name) + "'; name some of " + joint_names(robot);
    const auto index = static_cast<std::size_t>(found - robot.joints.begin());
    if (std::ranges::find(joints, index) != joints.end()) return "it names the joint " + name + " twice";
    joints.push_back(index);
  }
  return "";
}

std::string check_numbers(const trajectory_msgs::JointTrajectoryPoint& point, std::size_t joints) {
  const std::initializer_list<std::pair<const char*, const std::vector<double>*>> lists{
      {"positions", &point.positions}, {"velocities", &point.velocities}, {"accelerations", &point.accelerations}};
  for (const auto& [name, values] : lists) {
    if (values->size() != joints && (values == &point.positions || !values->empty()))
      return "it has " + std::to_string(values->size()) + " " + name + " for " + std::to_string(joints) + " joints";
    for (const double value : *values) {
      if (!std::isfinite(value)) return std::string("one of its ") + name + " is " + shortest(value);
    }
  }
  if (!point.effort.empty()) return "it has efforts, which are not executed: leave them out";
  return "";
}

}  // namespace

std::string JointTrajectory::read(const trajectory_msgs::JointTrajectory& message, const LegModel& robot,
                                  const Positions& start) {
  std::vector<std::size_t> joints;
  if (std::string problem = find_joints(message, robot, joints); !problem.empty()) return problem;
  const AllJointBounds bounds = joint_bounds(robot);
  std::vector<Point> points{{.time = 0, .positions = start}};
  for (std::size_t number = 1; number <= message.points.size(); ++number) {
    const trajectory_msgs::JointTrajectoryPoint& given = message.points[number - 1];
    const std::string which = "point " + std::to_string(number) + ": ";
    if (std::string problem = check_numbers(given, joints.size()); !problem.empty()) return which + problem;
    Point& last = points.back();
    const double time = given.time_from_start.toSec();
    const bool begins = number == 1 && time == 0;
    if (!begins && time <= last.time) {
      return which + "its time_from_start " + shortest(time) + " s is not after " + shortest(last.time) +
             " s, the time before it";
    }
    Point point{.time = time, .positions = last.positions};
    for (std::size_t k = 0; k < joints.size(); ++k) {
      const std::size_t i = joints[k];
      const double to = given.positions[k], from = last.positions[i];
      const std::string joint = which + "the joint " + robot.joints[i].name;
      if (begins) {
        if (std::abs(to - from) <= kSamePlace) continue;
        return joint + " is at " + shortest(from) + " rad and not at " + shortest(to) +
               " rad; begin there, or with a time above 0";
      }
      const bool straight = given.velocities.empty();
      point.arriving[i] = straight ? (to - from) / (time - last.time) : given.velocities[k];
      last.leaving[i] = straight ? point.arriving[i] : last.arriving[i];
      point.positions[i] = to;
      const Cubic path(from, last.leaving[i], to, point.arriving[i], time - last.time);
      const JointRange& range = bounds[i].range;
      const auto [low, high] = path.extent();
      const bool above = low >= range.lower - kWritten;
      if (!above || !(high <= range.upper + kWritten)) {
        return joint + " would be at " + robot_control::number(above ? high : low) + " rad; its range is " +
               shortest(range.lower) + " to " + shortest(range.upper) + " rad";
      }
      const double speed = path.largest_speed();
      if (!(speed <= bounds[i].motion.speed * (1 + kWritten))) {
        return joint + " would move at " + robot_control::number(speed) + " rad/s on its path; at most " +
               shortest(bounds[i].motion.speed) + " rad/s are allowed: give it more time";
      }
    }
    if (!begins) points.push_back(point);
  }
  if (points.size() == 1) return "point 1: its time_from_start is 0 s and there is no other; give it time to move";
  points_ = std::move(points);
  return "";
}

JointTrajectory::Positions JointTrajectory::at(double time) const {
  if (time >= duration()) return points_.back().positions;
  const auto next = std::ranges::upper_bound(points_, std::max(0.0, time), {}, &Point::time);
  const Point& to = *next;
  const Point& from = *std::prev(next);
  Positions result{};
  for (std::size_t i = 0; i < kLegsJoints; ++i) {
    const Cubic path(from.positions[i], from.leaving[i], to.positions[i], to.arriving[i], to.time - from.time);
    result[i] = path.position(std::max(0.0, time) - from.time);
  }
  return result;
}

}  // namespace robot_control

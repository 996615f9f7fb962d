#include "robots/wheeled/retuning.h"

#include <algorithm>

#include "control/wheeled/control_problems.h"
#include "control/wheeled/derived_tuning.h"
#include "parameters/problem_list.h"
#include "robots/wheeled/safety_limits.h"
#include "safety/derived_limits.h"
#include "signals/formatted_text.h"
#include "signals/roles.h"

namespace robot_control {
namespace {

const std::string kBlock{program_of(Role::kController)};

bool stops(const Condition& condition) {
  return condition.limit && (condition.reaction == Reaction::kRamp || condition.reaction == Reaction::kBrake);
}

double smallest_radius(const DriveTrain& robot) {
  return std::ranges::min_element(robot.wheels, {}, &WheelModel::radius)->radius;
}

/// Derived values as if they had been set.
DriveControllerParameters spelled_out(DriveControllerParameters given, const DriveTuning& tuning) {
  const auto fill = [](std::optional<double>& value, double derived) { value = value.value_or(derived); };
  const WheelTuning& wheel = tuning.wheels.front();
  fill(given.max_linear_deceleration, tuning.linear.deceleration);
  fill(given.min_linear_speed, -tuning.linear.reverse_speed);
  fill(given.max_linear_acceleration_reverse, tuning.linear.reverse_acceleration);
  fill(given.max_linear_deceleration_reverse, tuning.linear.reverse_deceleration);
  fill(given.max_angular_deceleration, tuning.angular.deceleration);
  fill(given.pid_kp, wheel.kp);
  fill(given.pid_ki, wheel.ki);
  fill(given.tracking_bandwidth, tuning.tracking_bandwidth);
  fill(given.feed_forward.mass, tuning.mass);
  fill(given.feed_forward.yaw_inertia, tuning.yaw_inertia);
  fill(given.feed_forward.wheel_inertia, wheel.inertia);
  fill(given.feed_forward.wheel_damping, wheel.damping);
  fill(given.feed_forward.wheel_friction, wheel.friction);
  return given;
}

}  // namespace

Retuning::Retuning(const Parameters& parameters, const DriveTrain& robot, LatestValue<LiveTuning>& inbox)
    : parameters_(parameters),
      robot_(robot),
      commanded_at_start_(commanded_wheel_speed(parameters.controller, robot)),
      wheel_speed_(safety_limits(parameters, robot).wheel_speed),
      inbox_(inbox) {}

Retuning::Retuning(const Retuning& other, LatestValue<LiveTuning>& inbox)
    : parameters_(other.in_force()),
      robot_(other.robot_),
      commanded_at_start_(other.commanded_at_start_),
      wheel_speed_(other.wheel_speed_),
      inbox_(inbox),
      count_(other.count_) {}

std::unique_ptr<Retuner> Retuning::clone(LatestValue<LiveTuning>& inbox) const {
  return std::unique_ptr<Retuner>(new Retuning(*this, inbox));
}

void Retuning::expect_monitor(const Parameters& monitor) {
  const std::lock_guard lock(mutex_);
  wheel_speed_ = safety_limits(monitor, robot_).wheel_speed;
}

std::string Retuning::monitor_problem(const DriveControllerParameters& wanted) const {
  const double asked = commanded_wheel_speed(wanted, robot_);
  const double needed = least_wheel_speed_limit(asked);
  if (!stops(wheel_speed_) || asked <= commanded_at_start_) return "";
  if (needed <= *wheel_speed_.limit) return "";
  return formatted(
      "%s: max_linear_speed %.4g m/s with max_angular_speed %.4g rad/s turns a wheel at %.4g rad/s. %s, whose "
      "wheel_speed limit was fixed at its start, stops the robot beyond %.4g rad/s; needed is %.4g. Set "
      "max_linear_speed + %.4g m·max_angular_speed to at most %.4g m/s, or set both in the YAML file and restart all "
      "nodes.",
      kBlock.c_str(), wanted.max_linear_speed, wanted.max_angular_speed, asked,
      std::string(program_of(Role::kMonitor)).c_str(), *wheel_speed_.limit, needed, robot_.effective_wheel_base() / 2,
      smallest_radius(robot_) * fastest_within(*wheel_speed_.limit));
}

Retuned Retuning::set(const std::string& request) {
  const std::lock_guard lock(mutex_);
  LiveChange change = read_live(parameters_, kBlock, request);
  const DriveControllerParameters& wanted = change.parameters.controller;
  std::ranges::move(control_problems(wanted, robot_, parameters_.loop.period()), std::back_inserter(change.problems));
  if (std::string problem = monitor_problem(wanted); !problem.empty()) change.problems.push_back(std::move(problem));
  if (!change.problems.empty()) {
    throw ParameterError(listing("set_parameters refused, nothing is changed", change.problems));
  }
  DriveTuning tuning = drive_tuning(wanted, robot_, parameters_.loop.period());
  tuning.count = ++count_;
  inbox_.store(tuning_of(tuning));
  parameters_ = std::move(change.parameters);
  return {.count = count_, .values = std::move(change.values)};
}

std::vector<LiveParameter> Retuning::live() const {
  const std::lock_guard lock(mutex_);
  Parameters parameters = parameters_;
  const DriveTuning tuning = drive_tuning(parameters.controller, robot_, parameters.loop.period());
  parameters.controller = spelled_out(parameters.controller, tuning);
  return live_parameters(parameters, kBlock);
}

Parameters Retuning::in_force() const {
  const std::lock_guard lock(mutex_);
  return parameters_;
}

}  // namespace robot_control

#include "bridge/command_report.h"

#include <array>
#include <cstdio>

#include "control/drive_limits.h"

namespace robot_control {
namespace {

constexpr std::uint64_t kNoWish = kReasonNoCommand | kReasonTimedOut | kReasonRefused | kReasonManySenders;

template <class... Values>
std::string format(const char* pattern, Values... values) {
  std::array<char, 200> text{};
  std::snprintf(text.data(), text.size(), pattern, values...);
  return text.data();
}

}  // namespace

CommandReport::CommandReport(const RobotModel& robot, const DriveControllerParameters& parameters)
    : kinematics_(robot), limits_(speed_limits(parameters)), timeout_(parameters.cmd_vel_timeout) {}

void CommandReport::limit(const DriveControllerParameters& parameters) {
  limits_ = speed_limits(parameters);
  timeout_ = parameters.cmd_vel_timeout;
}

std::string CommandReport::speeds(const PlanarTwist& wish) const {
  const double scale = kinematics_.wheel_speed_scale(wish);
  const PlanarTwist twist = within_speed({scale * wish.linear, scale * wish.angular}, limits_);
  const SidePair rims = kinematics_.rim_speeds(twist);
  std::string text = format("left %.2f m/s, right %.2f m/s (cmd_vel %g m/s, %g rad/s", rims.left, rims.right,
                            wish.linear, wish.angular);
  if (twist.linear != wish.linear || twist.angular != wish.angular) {
    text += format(", limited to %.3g m/s, %.3g rad/s", twist.linear, twist.angular);
  }
  return text + ")";
}

std::vector<ReportLine> CommandReport::look(const CommandFrame& command) {
  std::vector<ReportLine> lines;
  if (command.head.run != run_) {
    run_ = command.head.run;
    received_ = refused_ = timeouts_ = 0;
    told_ = refusing_ = false;
  }
  const bool timed_out = command.timeouts > timeouts_;
  const std::uint64_t not_finite = command.requests_refused - command.requests_stale - command.requests_crowded;
  const bool refused = not_finite > refused_;
  const bool received = command.requests_received > received_;
  const bool valid = (command.reasons & kNoWish) == 0;
  if (timed_out && told_ && (linear_ != 0 || angular_ != 0)) {
    lines.push_back({true, format("cmd_vel is silent for %g s: ramping down to standstill", timeout_)});
    told_ = false;
  }
  if (refused && !refusing_) {
    lines.push_back({true, "cmd_vel holds NaN or infinity: refused, ramping down to standstill"});
    told_ = false;
  }
  refusing_ = refusing_ || refused;
  if (received && valid) {
    const double linear = command.twist_requested.linear[0];
    const double angular = command.twist_requested.angular[2];
    if (!told_ || linear != linear_ || angular != angular_) {
      lines.push_back({false, speeds({linear, angular})});
    }
    told_ = true;
    refusing_ = false;
    linear_ = linear;
    angular_ = angular;
  }
  received_ = command.requests_received;
  refused_ = not_finite;
  timeouts_ = command.timeouts;
  return lines;
}

}  // namespace robot_control

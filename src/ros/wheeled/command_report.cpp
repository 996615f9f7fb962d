#include "ros/wheeled/command_report.h"

#include <cmath>

#include "control/wheeled/limits/drive_limits.h"
#include "signals/formatted_text.h"
#include "signals/names.h"

namespace robot_control {
namespace {

constexpr std::uint64_t kNoRequestInForce = kReasonNoCommand | kReasonTimedOut | kReasonRefused | kReasonManySenders;
constexpr std::uint64_t kNoEffect = kReasonNoPermit | kReasonPermitBrake | kReasonPermitRamp | kReasonBadSensors;
constexpr std::uint64_t kHindrances = kNoEffect | kReasonPermitSlow | kReasonPartIgnored;

/// Returns the text of the request. Speeds below kShownAsZero, remains of a sender's arithmetic, are shown as zero.
std::string requested_text_of(const PlanarTwist& requested) {
  constexpr double kShownAsZero = 1e-6;  // m/s and rad/s
  const auto shown = [](double speed) { return std::abs(speed) < kShownAsZero ? 0.0 : speed; };
  return formatted("cmd_vel %.4g m/s, %.4g rad/s", shown(requested.linear), shown(requested.angular));
}

std::string sentence_of(std::uint64_t reasons) {
  return sentences_of(kCommandReasonNames, reasons, {.kind = kWheeledKind});
}

PlanarTwist requested_twist(const CommandFrame& command) {
  return {command.requested.twist.linear[0], command.requested.twist.angular[2]};
}

}  // namespace

CommandReport::CommandReport(const DriveTrain& robot, const DriveControllerParameters& parameters)
    : kinematics_(robot), limits_(speed_limits(parameters)), timeout_(parameters.cmd_vel_timeout) {}

void CommandReport::limit(const DriveControllerParameters& parameters) {
  limits_ = speed_limits(parameters);
  timeout_ = parameters.cmd_vel_timeout;
}

void CommandReport::enter_run(const CommandFrame& command) {
  run_ = command.head.run;
  timeouts_ = 0;
  reported_.reset();
  line_gap_ = timeout_gap_ = {};
}

CommandReport::Report CommandReport::made_of(const CommandFrame& command) const {
  const PlanarTwist requested = requested_twist(command);
  const double scale = kinematics_.wheel_speed_scale(requested);
  const PlanarTwist twist = within_speed({scale * requested.linear, scale * requested.angular}, limits_);
  return {.rims = kinematics_.rim_speeds(twist),
          .zero = requested.linear == 0 && requested.angular == 0 && command.ignored == 0,
          .limited = twist.linear != requested.linear || twist.angular != requested.angular,
          .hindrance = command.reasons & kHindrances};
}

bool CommandReport::same(const Report& one, const Report& other) {
  if (one.hindrance != other.hindrance || one.zero != other.zero) return false;
  return std::abs(one.rims.left - other.rims.left) < kSpeedStep &&
         std::abs(one.rims.right - other.rims.right) < kSpeedStep && one.limited == other.limited;
}

std::string CommandReport::text(const Report& report, const CommandFrame& command) const {
  const PlanarTwist requested = requested_twist(command);
  std::string requested_text = requested_text_of(requested);
  if ((report.hindrance & kNoEffect) != 0) {
    const std::uint64_t why = report.hindrance & kNoEffect;
    return requested_text + " has no effect: " + sentence_of(why & (~why + 1));
  }
  if (command.ignored != 0) requested_text += ", " + names_of(kRequestPartNames, command.ignored);
  if (report.hindrance != 0) return requested_text + ", but " + sentence_of(report.hindrance);
  if (report.limited) {
    const double scale = kinematics_.wheel_speed_scale(requested);
    const PlanarTwist twist = within_speed({scale * requested.linear, scale * requested.angular}, limits_);
    requested_text += formatted(", limited to %.3g m/s, %.3g rad/s", twist.linear, twist.angular);
  }
  return formatted("left %.2f m/s, right %.2f m/s (%s)", report.rims.left, report.rims.right, requested_text.c_str());
}

std::vector<ReportLine> CommandReport::update(const CommandFrame& command) {
  std::vector<ReportLine> lines;
  if (command.head.run != run_) enter_run(command);
  const std::int64_t now_ns = command.head.stamp_ns;
  const bool timed_out = command.timeouts > timeouts_;
  const bool stands = (command.reasons & kNoEffect) != 0;
  timeouts_ = command.timeouts;

  if (timed_out) {
    const bool moved = reported_ && !reported_->zero && !stands;
    if (moved && timeout_gap_.over(now_ns)) {
      lines.push_back({true, formatted("no cmd_vel for %g s: ramping down to standstill", timeout_)});
      timeout_gap_.begin(now_ns);
    }
    reported_.reset();
  }
  if ((command.reasons & kReasonRefused) != 0) reported_.reset();
  if ((command.reasons & kNoRequestInForce) != 0 || command.requests_received == 0) return lines;

  const Report made = made_of(command);
  if (made.hindrance != hindrance_) hindered_since_ns_ = now_ns;
  hindrance_ = made.hindrance;
  const bool settled = !reported_ || made.hindrance == reported_->hindrance || now_ns - hindered_since_ns_ >= kSettle;
  if ((reported_ && same(made, *reported_)) || !settled || !line_gap_.over(now_ns)) return lines;
  const bool stood = !reported_ || reported_->zero;
  reported_ = made;
  if (made.zero && (stood || made.hindrance != 0)) return lines;  // the robot stands as requested
  lines.push_back({made.hindrance != 0, text(made, command)});
  line_gap_.begin(now_ns);
  return lines;
}

}  // namespace robot_control

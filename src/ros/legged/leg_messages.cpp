#include "ros/legged/leg_messages.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "control/legged/posture/ground_slope.h"
#include "control/legged/walk/own_gaits.h"
#include "parameters/block.h"
#include "ros/messages/status_messages.h"
#include "ros/reports/name_list.h"
#include "signals/names.h"
#include "signals/roles.h"

namespace robot_control {
namespace {

std::string in_degrees(double angle) {
  return shortest(std::round(angle * 1800 / std::numbers::pi) / 10) + " deg";
}

}  // namespace

Posture posture_of(const BodyPose& message) {
  return {.height = message.height,
          .roll = message.roll,
          .pitch = message.pitch,
          .x = message.x,
          .y = message.y,
          .yaw = message.yaw};
}

std::optional<Request> request_of(const FootTarget& message) {
  if (message.foot.empty()) return Request{};
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    if (message.foot != name_of(static_cast<LegPlace>(leg))) continue;
    return Request{
        .twist = {}, .posture = {.height = message.z, .x = message.x, .y = message.y}, .mode = {ModeKind::kLift, leg}};
  }
  return std::nullopt;
}

std::string foot_names() {
  std::string names;
  for (std::size_t leg = 0; leg < kLegs; ++leg)
    names.append(names.empty() ? "" : ", ").append(name_of(static_cast<LegPlace>(leg)));
  return names;
}

Mode mode_of(const std::string& posture) {
  if (posture == name_of(LegPhase::kStanding)) return {ModeKind::kStand};
  return {posture == name_of(LegPhase::kLying) ? ModeKind::kLie : ModeKind::kStay};
}

std::optional<Mode> mode_of_gait(const std::string& gait, const Gaits& gaits) {
  if (gait == "auto") return Mode{};
  for (std::size_t i = 1; i < gaits.size(); ++i)
    if (gait == gaits[i].name.data()) return Mode{ModeKind::kGait, i};
  return std::nullopt;
}

std::string gait_of_mode(const Mode& mode, const Gaits& gaits) {
  return mode.kind == ModeKind::kGait && mode.index < gaits.size() ? gaits[mode.index].name.data() : "auto";
}

void MetGround::add(std::uint64_t risers, std::uint64_t reaches, const FrameHead& now) noexcept {
  if (now.run != run_) risers_ns_ = reaches_ns_ = kNever;
  run_ = now.run;
  now_ns_ = now.stamp_ns;
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    if ((risers >> leg & 1) != 0) risers_ns_[leg] = now_ns_;
    if ((reaches >> leg & 1) != 0) reaches_ns_[leg] = now_ns_;
  }
}

LegState leg_state(const LegReport& report, const LegModel& robot, ros::Time stamp) {
  const CommandFrame& command = report.command;
  LegState message;
  message.header.stamp = stamp;
  message.posture = name_of(command.legged.phase);
  if (command.legged.lifted != 0) message.lifted = name_of(static_cast<LegPlace>(command.legged.lifted - 1));
  if (command.legged.phase == LegPhase::kWalking && command.legged.gait < report.gaits.size()) {
    message.gait = report.gaits[command.legged.gait].name.data();
    message.gait_phase = command.legged.gait_phase;
  }
  message.gaits = gait_words(report.gaits);
  const auto& [x, y, height, roll, pitch, yaw] = command.legged.body;
  message.body.x = x;
  message.body.y = y;
  message.body.height = height;
  message.body.roll = roll;
  message.body.pitch = pitch;
  message.body.yaw = yaw;
  message.slope_ahead = command.legged.slope[0];
  message.slope_left = command.legged.slope[1];
  for (const BitName& row : kCommandReasonNames) {
    if ((report.reasons & row.bit) == 0) continue;
    message.reasons.emplace_back(row.name);
    message.sentences.push_back(sentences_of({&row, 1}, row.bit, {.kind = kLeggedKind}));
  }
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const ContactState& contact = report.state.contacts[leg];
    message.foot.emplace_back(name_of(static_cast<LegPlace>(leg)));
    message.bears.push_back(contact.probability > 0.5 ? 1 : 0);
    message.load.push_back(contact.load);
    message.slip.push_back(contact.slip);
    message.met_riser.push_back(report.met.met_riser(leg) ? 1 : 0);
    message.reaching.push_back(report.met.reaching(leg) ? 1 : 0);
  }
  for (std::size_t i = 0; i < robot.joints.size(); ++i) {
    const JointCommand& plan = report.plan.joints[i];
    const bool brakes = plan.mode == JointMode::kBrake;
    message.name.push_back(robot.joints[i].name);
    message.wanted.push_back(brakes ? std::numeric_limits<double>::quiet_NaN() : plan.position);
    message.actual.push_back(report.sensors.joints[i].position);
    message.effort.push_back(command.joints[i].effort);
  }
  return message;
}

std::string ground_words(const LeggedCommand& command) {
  const auto [ahead, left] = command.slope;
  const double angle = std::atan(std::hypot(ahead, left));
  if (!(angle >= kLevelSlope)) return "";
  static constexpr std::array kSides{"front", "front left", "left",  "rear left",
                                     "rear",  "rear right", "right", "front right"};
  const double eighths = std::atan2(left, ahead) * 4 / std::numbers::pi;
  return "rises " + in_degrees(angle) + " to the " + kSides[static_cast<std::size_t>(std::lround(eighths) + 8) % 8];
}

std::string slope_words(std::uint64_t reasons, const StateFrame& state, const LegModel& robot) {
  if ((reasons & kReasonTooSteep) == 0) return "";
  const double up = vertical_over_ground(state.base.attitude, robot.lying_pitch).z();
  return " (by " + in_degrees(std::acos(std::clamp(up, -1.0, 1.0))) + ", at most " + in_degrees(kMaxSlope) + ")";
}

std::string no_permission(bool found, const Permit& permit, const MachineModel& robot, const Programs& programs) {
  if (!found) return "no permit from the safety monitor: start " + std::string(program_of(Role::kMonitor));
  if (permit.action == PermitAction::kDrive) return "";
  if (permit.causes != 0) {
    const std::uint64_t cause = permit.first_cause != 0 ? permit.first_cause : permit.causes & (~permit.causes + 1);
    const std::string measured = detail(permit, cause, robot);
    return "the robot is stopped: " + sentences_of(kStopCauseNames, cause, programs) +
           (measured.empty() ? "" : " (" + measured + ")") + "; then call e_stop_reset";
  }
  if (permit.missing != 0)
    return "the safety monitor waits: " + sentences_of(kMissingNodeNames, permit.missing, programs);
  if (permit.unreleased != 0) {
    return "a node was started or the simulation was reset: stop all requests for request_timeout, or publish a " +
           std::string(names_of_kind(programs.kind).request) + " of zero, then call again";
  }
  return "the safety monitor permits no motion: check safety_status";
}

}  // namespace robot_control

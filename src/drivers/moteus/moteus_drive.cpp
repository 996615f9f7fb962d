#include "drivers/moteus/moteus_drive.h"

#include <cmath>
#include <utility>

#include "signals/formatted_text.h"

namespace robot_control::moteus {
namespace {

constexpr double kTrialAngle = 0.05 * kTurn;    // rad, from the position
constexpr double kTrialVelocity = 0.2 * kTurn;  // rad/s: the target moves on by 0.4 % of the angle in 1 ms
constexpr double kTrialStiffness = 0.25;        // of kp: less than the part of kd, which must not depend on it

constexpr std::pair<std::uint64_t, const char*> kFaults[] = {
    {33, "motor driver"},  {34, "over-voltage"},
    {35, "encoder"},       {36, "not calibrated"},
    {38, "too hot"},       {39, "outside servopos.position_min and position_max"},
    {40, "under-voltage"}, {47, "servo.bemf_feedforward is not 0"}};

MitJoint with_gains(const MoteusParameters& parameters) {
  MitJoint joint = parameters;
  joint.ranges = parameters.ranges_of_orders();
  return joint;
}

}  // namespace

MoteusDrive::MoteusDrive(const MoteusParameters& parameters, double period)
    : MitDrive(with_gains(parameters), period), motor_gear_(parameters.motor_gear), timeout_(parameters.timeout) {}

std::vector<PlannedFrames> MoteusDrive::plan() const {
  return {{.fd = true, .extended = true, .data_bytes = 48, .per_cycle = 1},
          {.fd = true, .extended = node() << 8U > CAN_SFF_MASK, .data_bytes = 24, .per_cycle = 1}};
}

void MoteusDrive::forget_motor() noexcept {
  reply_ = {};
  trial_ = {};
  identified_ = gains_agree_ = false;
  trials_ = 0;
  set_motor_gear(motor_gear_);
}

void MoteusDrive::receive(const can_frame& frame, std::int64_t now_ns) noexcept {
  if (commands(frame, node())) return fail(DriveCause::kForeignCommander, "", frame.can_id & CAN_EFF_MASK);
  const auto reply = decode_reply(frame, node());
  if (!reply) return;
  reply_ = *reply;
  if (is_in(Mode::kTimeout) && running()) return fail(DriveCause::kOwnBrake);
  if (reply->details && setting_up() && !identified_) identify(*reply);
  if (reply->details && is_in(Mode::kPosition) && !gains_agree_) judge_gains(*reply);
  accept_position(reply->position, reply->velocity, now_ns);
  accept_motor_torque(reply->torque, now_ns);
  accept_temperature(reply->temperature);
  accept_voltage(reply->voltage);
}

void MoteusDrive::identify(const Reply& reply) noexcept {
  accept_answer();
  compare("version of its registers (102h)", reply.map_version, kMapVersion);
  if (!(reply.home >= 1)) fail(DriveCause::kDiffers, "reference of its position (register 00Ch)", 0, reply.home, 1);
  if (reply.home > 1) set_motor_gear(1);
  identified_ = true;
}

void MoteusDrive::judge_gains(const Reply& reply) noexcept {
  const double kp = std::abs(reply.proportional / (kTrialStiffness * (reply.position - trial_.position)));
  const double kd = std::abs(reply.derivative / (reply.velocity - trial_.velocity));
  const auto agrees = [](double found, double expected) { return std::abs(found - expected) <= kTolerance * expected; };
  const bool kp_agrees = agrees(kp, ranges().stiffness);
  const bool kd_agrees = agrees(kd, ranges().damping);
  gains_agree_ = kp_agrees && kd_agrees && reply.integral == 0;
  if (gains_agree_ || ++trials_ < kTrials) return;
  if (!kp_agrees)
    return fail(DriveCause::kDiffers, "kp, or a limit of its position", 0, kTurn * kp, kTurn * ranges().stiffness);
  if (!kd_agrees) return fail(DriveCause::kDiffers, "kd", 0, kTurn * kd, kTurn * ranges().damping);
  fail(DriveCause::kDiffers, "integral, for which set servo.pid_position.ilimit to 0", 0, reply.integral);
}

can_frame MoteusDrive::enable() noexcept {
  if (trial_.damping == 0)
    trial_ = {.position = reply_.position + kTrialAngle,
              .velocity = kTrialVelocity,
              .stiffness = kTrialStiffness * ranges().stiffness,
              .damping = ranges().damping};
  return encode(node(), ranges(), {.mode = Mode::kPosition, .command = trial_, .timeout = timeout_, .details = true});
}

can_frame MoteusDrive::order(const MitCommand& command) noexcept {
  return encode(node(), ranges(),
                {.mode = Mode::kPosition, .command = command, .max_torque = ranges().torque, .timeout = timeout_});
}

std::uint64_t MoteusDrive::state_code() const noexcept {
  const auto code = [](double number) { return static_cast<std::uint64_t>(static_cast<int>(number)) & 0xFFU; };
  return code(reply_.fault) << 8U | code(reply_.mode);
}

std::string MoteusDrive::code_words(const DriveStatus& status) const {
  if (status.cause == DriveCause::kForeignCommander)
    return formatted("0x%llX", static_cast<unsigned long long>(status.code));
  const std::uint64_t mode = status.code & 0xFFU, fault = status.code >> 8U;
  if (status.cause == DriveCause::kReleased) return mode == 0 ? "stopped" : "mode " + std::to_string(mode);
  if (status.cause != DriveCause::kDriveError) return "";
  for (const auto& [code, words] : kFaults) {
    if (code == fault) return words;
  }
  return "number " + std::to_string(fault);
}

}  // namespace robot_control::moteus

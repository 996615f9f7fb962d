#include "drivers/ak/ak_drive.h"

#include <algorithm>
#include <cmath>

#include "signals/formatted_text.h"

namespace robot_control::ak {
namespace {

constexpr const char* kErrors[] = {
    "none", "too hot", "over-current", "over-voltage", "under-voltage", "encoder", "unbalanced phase currents"};

}  // namespace

AkDrive::AkDrive(const AkParameters& parameters, double period)
    : MitDrive(parameters, period), temperature_offset_(parameters.temperature_offset) {}

std::vector<PlannedFrames> AkDrive::plan() const {
  return {{.data_bytes = 8, .per_cycle = 2}};
}

void AkDrive::forget_motor() noexcept {
  error_ = Error::kNone;
  ordered_ = {};
  enables_ = false;
  released_ = false;
  answers_ = 0;
}

void AkDrive::receive(const can_frame& frame, std::int64_t now_ns) noexcept {
  if (commands(frame, node())) return fail(DriveCause::kForeignCommander, "", frame.can_id & CAN_EFF_MASK);
  const auto reply = decode_reply(frame, ranges());
  if (!reply || reply->node != node()) return;
  if (enables_) answers_ = std::min(answers_ + 1, kAnswers);
  if (reply->health) {
    error_ = reply->health->error;
    accept_temperature(reply->health->temperature + temperature_offset_);
  }
  judge_release(*reply, now_ns);
  check_scale(reply->position, reply->velocity, now_ns);
  accept_position(reply->position, reply->velocity, now_ns);
  accept_motor_torque(reply->torque, now_ns);
}

void AkDrive::judge_release(const Reply& reply, std::int64_t now_ns) noexcept {
  const double needed = mit_torque(ordered_, reply.position, reply.velocity);
  const bool shows = running() && std::abs(needed) > kNeeded * ranges().torque;
  if (!shows || std::abs(reply.torque) > kNoTorque * ranges().torque) obeyed_ns_ = now_ns;
  released_ = released_ || now_ns - obeyed_ns_ > kReleasedNs;
}

can_frame AkDrive::enable() noexcept {
  enables_ = true;
  return encode_request(node(), MitRequest::kEnable);
}

can_frame AkDrive::release() noexcept {
  enables_ = false;
  answers_ = 0;
  zeros_ = !zeros_;
  return zeros_ ? order({}) : encode_request(node(), MitRequest::kRelease);
}

can_frame AkDrive::order(const MitCommand& command) noexcept {
  ordered_ = command;
  return encode_mit(static_cast<canid_t>(node()), ranges(), command);
}

std::string AkDrive::code_words(const DriveStatus& status) const {
  if (status.cause == DriveCause::kForeignCommander)
    return formatted("0x%llX", static_cast<unsigned long long>(status.code));
  if (status.cause == DriveCause::kReleased) return "no torque";
  if (status.cause != DriveCause::kDriveError) return "";
  return status.code < std::size(kErrors) ? kErrors[status.code] : "number " + std::to_string(status.code);
}

}  // namespace robot_control::ak

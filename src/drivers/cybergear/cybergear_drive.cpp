#include "drivers/cybergear/cybergear_drive.h"

#include <cmath>
#include <utility>

#include "signals/formatted_text.h"

namespace robot_control::cybergear {
namespace {

constexpr double kOrderMode = 0;  // of Parameter::kRunMode
/// Bits of state_code: 0–5 of a feedback, from 8 on those of a frame kFaults.
struct FaultBits {
  std::uint64_t bits;
  const char* words;
};
constexpr FaultBits kFaults[] = {{1U << 0U | 1U << 10U, "under-voltage"},
                                 {1U << 1U | 0x10030ULL << 8U, "over-current"},
                                 {1U << 2U | 1U << 8U, "too hot"},
                                 {1U << 3U, "encoder"},
                                 {1U << 4U, "Hall sensor or overload"},
                                 {1U << 5U | 1U << 15U, "not calibrated"},
                                 {1U << 9U, "driver chip"},
                                 {1U << 11U, "over-voltage"},
                                 {0xFF00ULL << 8U, "overload"}};
constexpr const char* kModes[] = {"mode reset", "mode calibration", "mode run", "mode 3"};

}  // namespace

CybergearDrive::CybergearDrive(const CybergearParameters& parameters, double period)
    : MitDrive(parameters, period),
      timeout_(static_cast<std::uint32_t>(std::lround(parameters.timeout / kTimeoutUnit))) {}

std::vector<PlannedFrames> CybergearDrive::plan() const {
  return {{.extended = true, .data_bytes = 8, .per_cycle = 2}};
}

void CybergearDrive::forget_motor() noexcept {
  mode_ = Mode::kReset;
  faults_ = 0;
  details_ = 0;
  asked_ = 0;
  writes_ = false;
  written_ = 0;
}

void CybergearDrive::receive(const can_frame& frame, std::int64_t now_ns) noexcept {
  const auto id = identifier_of(frame);
  if (!id) return;
  if (commands(*id, node())) return fail(DriveCause::kForeignCommander, "", frame.can_id & CAN_EFF_MASK);
  const bool is_its = (id->data & 0xFFU) == node();
  if (id->type == Type::kFaults && (is_its || id->target == node())) {
    details_ |= static_cast<std::uint32_t>(data_word(frame));
  }
  if (!is_its) return;
  if (id->type == Type::kRead && setting_up() && !is_set_up()) {
    const ParameterAccess answer = decode_parameter(frame);
    if (answer.index == kRead[asked_] && id->data >> 8U == 0) receive_parameter(answer);
  }
  if (id->type != Type::kFeedback) return;
  const Feedback feedback = decode_feedback(frame, ranges());
  mode_ = feedback.mode;
  faults_ = feedback.faults;
  check_scale(feedback.position, feedback.velocity, now_ns);
  accept_position(feedback.position, feedback.velocity, now_ns);
  accept_motor_torque(feedback.torque, now_ns);
  accept_temperature(feedback.temperature);
}

void CybergearDrive::receive_parameter(const ParameterAccess& answer) noexcept {
  accept_answer();
  switch (answer.index) {
    case Parameter::kRunMode:
      compare("mode of control (run_mode)", answer.value & 0xFFU, kOrderMode);
      break;
    case Parameter::kTorqueLimit:
      if (!(answer.real() <= ranges().torque * 1.001))
        fail(DriveCause::kDiffers, "torque_range (limit_torque)", 0, answer.real(), ranges().torque);
      break;
    case Parameter::kTimeout:
      if (answer.value == timeout_) return end_set_up(true);
      if (written_ == kWrites) return end_set_up(false);
      writes_ = true;
      return;
  }
  ++asked_;
}

/// An older motor does not answer what it does not have.
void CybergearDrive::end_unanswered() noexcept {
  if (kRead[asked_] == Parameter::kTimeout) return end_set_up(false);
  fail(DriveCause::kNoAnswer, "its parameters");
}

void CybergearDrive::end_set_up(bool takes_timeout) noexcept {
  asked_ = kRead.size();
  if (takes_timeout) know_reaction(SilenceReaction::kCoasts, ReactionEvidence::kRead);
}

can_frame CybergearDrive::set_up() noexcept {
  if (is_set_up()) return release();
  const bool writes = std::exchange(writes_, false);
  if (writes) ++written_;
  return encode({.type = writes ? Type::kWrite : Type::kRead, .data = kHost, .target = number()},
                {.index = kRead[asked_], .value = writes ? timeout_ : 0});
}

can_frame CybergearDrive::clear() noexcept {
  details_ = 0;
  return encode_request(Type::kRelease, number(), 1);
}

std::uint64_t CybergearDrive::state_code() const noexcept {
  return std::uint64_t{details_} << 8U | static_cast<std::uint64_t>(mode_) << 6U | faults_;
}

std::string CybergearDrive::code_words(const DriveStatus& status) const {
  if (status.cause == DriveCause::kForeignCommander)
    return formatted("0x%llX", static_cast<unsigned long long>(status.code));
  if (status.cause == DriveCause::kReleased) return kModes[status.code >> 6U & 3U];
  if (status.cause != DriveCause::kDriveError) return "";
  std::string words;
  for (const FaultBits& fault : kFaults) {
    if ((status.code & fault.bits) != 0) words += (words.empty() ? "" : ", ") + std::string(fault.words);
  }
  return words;
}

}  // namespace robot_control::cybergear

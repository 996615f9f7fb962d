#include "drivers/cia402/sdo_client.h"

namespace robot_control::canopen {

void SdoClient::begin(const SdoMessage& request) noexcept {
  request_ = request;
  result_ = Result::kPending;
  tries_ = 0;
}

void SdoClient::receive(const can_frame& frame) noexcept {
  const auto answer = decode_sdo(SdoSide::kResponse, node_, frame);
  if (!answer || result_ != Result::kPending || tries_ == 0 || answer->object != request_.object) return;
  if (answer->command == SdoCommand::kAbort) {
    abort_code_ = answer->abort_code;
    result_ = Result::kAborted;
  } else if (answer->command == request_.command) {
    constexpr std::uint32_t kNotExpedited = 0x0607'0012;  // of a read: the value is longer than 4 bytes
    const bool too_long = request_.command == SdoCommand::kUpload && !answer->expedited;
    value_ = expedited_value(*answer);
    abort_code_ = too_long ? kNotExpedited : 0;
    result_ = too_long ? Result::kAborted : Result::kDone;
  }
}

void SdoClient::step(std::int64_t now_ns, FrameBatch& send) noexcept {
  if (result_ != Result::kPending || (tries_ > 0 && now_ns - sent_ns_ < kTimeoutNs)) return;
  if (tries_++ == kTries) {
    result_ = Result::kNoAnswer;
  } else {
    sent_ns_ = now_ns;
    send.add(encode_sdo(SdoSide::kRequest, node_, request_));
  }
}

}  // namespace robot_control::canopen

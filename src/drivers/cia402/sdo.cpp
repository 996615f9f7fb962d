#include "drivers/cia402/sdo.h"

#include <algorithm>
#include <iterator>

namespace robot_control::canopen {
namespace {

constexpr std::uint8_t kToggle = 0x10, kExpedited = 0x02, kSizeIndicated = 0x01, kLast = 0x01;

// The three highest bits of the first byte, in the order of SdoCommand.
constexpr std::uint8_t kRequestBits[] = {1, 0, 2, 3, 4};
constexpr std::uint8_t kResponseBits[] = {3, 1, 2, 0, 4};

canid_t cob_id(SdoSide side, std::uint8_t node) noexcept {
  return (side == SdoSide::kRequest ? kSdoRequest : kSdoResponse) + node;
}

const std::uint8_t (&command_bits(SdoSide side) noexcept)[5] {
  return side == SdoSide::kRequest ? kRequestBits : kResponseBits;
}

bool is_segment(SdoCommand command) noexcept {
  return command == SdoCommand::kDownloadSegment || command == SdoCommand::kUploadSegment;
}

/// Whether the frame carries a part of the value: downloads in requests, uploads in responses.
bool carries_value(SdoSide side, SdoCommand command) noexcept {
  return side == SdoSide::kRequest ? command == SdoCommand::kDownload || command == SdoCommand::kDownloadSegment
                                   : command == SdoCommand::kUpload || command == SdoCommand::kUploadSegment;
}

std::uint32_t number_in(const std::uint8_t* bytes) noexcept {
  return static_cast<std::uint32_t>(bytes[0] | bytes[1] << 8U | bytes[2] << 16U) | static_cast<std::uint32_t>(bytes[3])
                                                                                       << 24U;
}

void put_number(std::uint32_t number, std::uint8_t* bytes) noexcept {
  for (unsigned i = 0; i < 4; ++i) bytes[i] = static_cast<std::uint8_t>(number >> (8 * i));
}

void put_segment(SdoSide side, const SdoMessage& message, can_frame& frame) noexcept {
  frame.data[0] |= message.toggle ? kToggle : 0;
  if (!carries_value(side, message.command)) return;
  const auto length = std::min<std::uint8_t>(message.length, 7);
  frame.data[0] |= static_cast<std::uint8_t>((7 - length) << 1U | (message.last ? kLast : 0));
  std::copy_n(message.data.begin(), length, frame.data + 1);
}

void put_first(SdoSide side, const SdoMessage& message, can_frame& frame) noexcept {
  frame.data[1] = static_cast<std::uint8_t>(message.object.index);
  frame.data[2] = static_cast<std::uint8_t>(message.object.index >> 8U);
  frame.data[3] = message.object.sub;
  if (message.command == SdoCommand::kAbort) {
    put_number(message.abort_code, frame.data + 4);
  } else if (carries_value(side, message.command) && message.expedited) {
    const auto length = std::clamp<std::uint8_t>(message.length, 1, 4);
    frame.data[0] |= static_cast<std::uint8_t>((4 - length) << 2U | kExpedited | kSizeIndicated);
    std::copy_n(message.data.begin(), length, frame.data + 4);
  } else if (carries_value(side, message.command) && message.size != 0) {
    frame.data[0] |= kSizeIndicated;
    put_number(message.size, frame.data + 4);
  }
}

void read_segment(SdoSide side, const can_frame& frame, SdoMessage& message) noexcept {
  message.toggle = (frame.data[0] & kToggle) != 0;
  if (!carries_value(side, message.command)) return;
  message.length = static_cast<std::uint8_t>(7 - (frame.data[0] >> 1U & 7U));
  message.last = (frame.data[0] & kLast) != 0;
  std::copy_n(frame.data + 1, message.length, message.data.begin());
}

void read_first(SdoSide side, const can_frame& frame, SdoMessage& message) noexcept {
  message.object = {.index = static_cast<std::uint16_t>(frame.data[1] | frame.data[2] << 8U), .sub = frame.data[3]};
  if (message.command == SdoCommand::kAbort) message.abort_code = number_in(frame.data + 4);
  if (!carries_value(side, message.command)) return;
  const bool sized = (frame.data[0] & kSizeIndicated) != 0;
  message.expedited = (frame.data[0] & kExpedited) != 0;
  if (message.expedited) {
    message.length = static_cast<std::uint8_t>(sized ? 4 - (frame.data[0] >> 2U & 3U) : 4);
    std::copy_n(frame.data + 4, message.length, message.data.begin());
  } else if (sized) {
    message.size = number_in(frame.data + 4);
  }
}

struct AbortWords {
  std::uint32_t code;
  const char* words;
};

constexpr AbortWords kAbortWords[] = {
    {0x05030000, "toggle bit not alternated"},
    {0x05040000, "SDO protocol timed out"},
    {0x05040001, "command specifier not valid or unknown"},
    {0x05040002, "invalid block size"},
    {0x05040003, "invalid sequence number"},
    {0x05040004, "CRC error"},
    {0x05040005, "out of memory"},
    {0x06010000, "unsupported access to an object"},
    {0x06010001, "attempt to read a write-only object"},
    {0x06010002, "attempt to write a read-only object"},
    {0x06020000, "object does not exist in the object dictionary"},
    {0x06040041, "object cannot be mapped to the PDO"},
    {0x06040042, "number and length of the mapped objects exceed the length of a PDO"},
    {0x06040043, "general parameter incompatibility"},
    {0x06040047, "general internal incompatibility in the device"},
    {0x06060000, "access failed due to a hardware error"},
    {0x06070010, "data type does not match: length of the parameter"},
    {0x06070012, "data type does not match: parameter too long"},
    {0x06070013, "data type does not match: parameter too short"},
    {0x06090011, "sub-index does not exist"},
    {0x06090030, "invalid value for the parameter"},
    {0x06090031, "value of the parameter too high"},
    {0x06090032, "value of the parameter too low"},
    {0x06090036, "maximum value is less than minimum value"},
    {0x060A0023, "resource not available: SDO connection"},
    {0x08000000, "general error"},
    {0x08000020, "data cannot be transferred or stored"},
    {0x08000021, "data cannot be transferred or stored because of local control"},
    {0x08000022, "data cannot be transferred or stored because of the present state of the device"},
    {0x08000023, "object dictionary not present or its dynamic generation failed"},
    {0x08000024, "no data available"},
};

}  // namespace

can_frame encode_sdo(SdoSide side, std::uint8_t node, const SdoMessage& message) noexcept {
  can_frame frame = word_frame(cob_id(side, node), 0, 8);
  frame.data[0] = static_cast<std::uint8_t>(command_bits(side)[static_cast<std::size_t>(message.command)] << 5U);
  is_segment(message.command) ? put_segment(side, message, frame) : put_first(side, message, frame);
  return frame;
}

std::optional<SdoMessage> decode_sdo(SdoSide side, std::uint8_t node, const can_frame& frame) noexcept {
  if (!is_standard_data(frame) || frame.can_id != cob_id(side, node) || frame.len != 8) return std::nullopt;
  const auto& bits = command_bits(side);
  const auto* const found = std::ranges::find(bits, frame.data[0] >> 5U);
  if (found == std::end(bits)) return std::nullopt;
  SdoMessage message{.command = static_cast<SdoCommand>(found - std::begin(bits))};
  is_segment(message.command) ? read_segment(side, frame, message) : read_first(side, frame, message);
  return message;
}

SdoMessage expedited_download(const ObjectAddress& object, std::uint32_t value, std::uint8_t bytes) noexcept {
  SdoMessage message{.command = SdoCommand::kDownload, .object = object, .expedited = true, .length = bytes};
  put_number(value, message.data.data());
  return message;
}

std::uint32_t expedited_value(const SdoMessage& message) noexcept {
  return number_in(message.data.data());
}

const char* abort_words(std::uint32_t code) noexcept {
  const auto* const found = std::ranges::find(kAbortWords, code, &AbortWords::code);
  return found == std::end(kAbortWords) ? "unknown abort code" : found->words;
}

}  // namespace robot_control::canopen

#include "drivers/cia402/canopen.h"

#include <algorithm>
#include <iterator>

namespace robot_control::canopen {
namespace {

/// Returns the node of a frame with the function code, 0 if it is another frame.
std::uint8_t node_of(const can_frame& frame, canid_t function) noexcept {
  if (!is_standard_data(frame) || (frame.can_id & ~canid_t{kMaxNode}) != function) return 0;
  return static_cast<std::uint8_t>(frame.can_id & kMaxNode);
}

/// The words for all codes whose bits under the mask are `code`.
struct ErrorWords {
  std::uint16_t mask, code;
  const char* words;
};

// The more special entry comes first.
constexpr ErrorWords kErrorWords[] = {
    {0xFFFF, 0x2310, "continuous over-current"},
    {0xFFFF, 0x2320, "short circuit or earth leakage"},
    {0xFFFF, 0x3110, "mains over-voltage"},
    {0xFFFF, 0x3120, "mains under-voltage"},
    {0xFFFF, 0x3210, "DC link over-voltage"},
    {0xFFFF, 0x3220, "DC link under-voltage"},
    {0xFFFF, 0x4210, "excess temperature of the device"},
    {0xFFFF, 0x4310, "excess temperature of the drive"},
    {0xFFFF, 0x5441, "contacts: enable input is off"},
    {0xFFFF, 0x6320, "parameter error"},
    {0xFFFF, 0x7121, "motor blocked"},
    {0xFFFF, 0x7122, "motor error or commutation malfunction"},
    {0xFFFF, 0x7305, "incremental sensor 1 fault"},
    {0xFFFF, 0x7306, "incremental sensor 2 fault"},
    {0xFFFF, 0x8110, "CAN overrun, messages were lost"},
    {0xFFFF, 0x8120, "CAN controller in error passive mode"},
    {0xFFFF, 0x8130, "heartbeat or life guard error: the host was silent"},
    {0xFFFF, 0x8140, "recovered from bus-off"},
    {0xFFFF, 0x8150, "COB-ID collision: two nodes send the same identifier"},
    {0xFFFF, 0x8210, "PDO not processed because of its length"},
    {0xFFFF, 0x8220, "PDO longer than its mapping"},
    {0xFFFF, 0x8240, "unexpected length of SYNC"},
    {0xFFFF, 0x8250, "RPDO timeout"},
    {0xFFFF, 0x8611, "following error"},
    {0xFFFF, 0x8612, "reference limit"},
    {0xFF00, 0x0000, "error reset or no error"},
    {0xFF00, 0x1000, "generic error"},
    {0xFF00, 0x2100, "current on the device's input side"},
    {0xFF00, 0x2200, "current inside the device"},
    {0xFF00, 0x2300, "current on the device's output side"},
    {0xF000, 0x2000, "current"},
    {0xFF00, 0x3100, "mains voltage"},
    {0xFF00, 0x3200, "voltage inside the device"},
    {0xFF00, 0x3300, "output voltage"},
    {0xF000, 0x3000, "voltage"},
    {0xFF00, 0x4100, "ambient temperature"},
    {0xFF00, 0x4200, "temperature of the device"},
    {0xF000, 0x4000, "temperature"},
    {0xF000, 0x5000, "device hardware"},
    {0xFF00, 0x6100, "internal software"},
    {0xFF00, 0x6200, "user software"},
    {0xFF00, 0x6300, "data set"},
    {0xF000, 0x6000, "device software"},
    {0xF000, 0x7000, "additional modules"},
    {0xFF00, 0x8100, "communication"},
    {0xFF00, 0x8200, "protocol error"},
    {0xF000, 0x8000, "monitoring"},
    {0xFF00, 0x9000, "external error"},
    {0xFF00, 0xF000, "additional functions"},
    {0xFF00, 0xFF00, "device specific"},
};

}  // namespace

can_frame encode_nmt(const NmtRequest& request) noexcept {
  const std::uint8_t data[] = {static_cast<std::uint8_t>(request.command), request.node};
  return data_frame(kNmt, data);
}

std::optional<NmtRequest> decode_nmt(const can_frame& frame) noexcept {
  if (!is_standard_data(frame) || frame.can_id != kNmt || frame.len != 2) return std::nullopt;
  return NmtRequest{.command = NmtCommand{frame.data[0]}, .node = frame.data[1]};
}

can_frame encode_heartbeat(const Heartbeat& heartbeat) noexcept {
  return word_frame(kHeartbeat + heartbeat.node, static_cast<std::uint64_t>(heartbeat.state), 1);
}

std::optional<Heartbeat> decode_heartbeat(const can_frame& frame) noexcept {
  const std::uint8_t node = node_of(frame, kHeartbeat);
  if (node == 0 || frame.len != 1) return std::nullopt;
  return Heartbeat{.node = node, .state = NmtState{static_cast<std::uint8_t>(frame.data[0] & 0x7FU)}};
}

can_frame sync_frame() noexcept {
  return word_frame(kSync, 0, 0);
}

can_frame encode_emergency(const Emergency& emergency) noexcept {
  can_frame frame = word_frame(kEmergency + emergency.node,
                               emergency.code | static_cast<std::uint64_t>(emergency.error_register) << 16U, 8);
  std::ranges::copy(emergency.specific, frame.data + 3);
  return frame;
}

std::optional<Emergency> decode_emergency(const can_frame& frame) noexcept {
  const std::uint8_t node = node_of(frame, kEmergency);
  if (node == 0 || frame.len != 8) return std::nullopt;
  Emergency emergency{
      .node = node, .code = static_cast<std::uint16_t>(data_word(frame) & 0xFFFFU), .error_register = frame.data[2]};
  std::copy_n(frame.data + 3, emergency.specific.size(), emergency.specific.begin());
  return emergency;
}

const char* error_code_words(std::uint16_t code) noexcept {
  const auto found =
      std::ranges::find_if(kErrorWords, [code](const ErrorWords& each) { return (code & each.mask) == each.code; });
  return found == std::end(kErrorWords) ? "unknown error" : found->words;
}

}  // namespace robot_control::canopen

#pragma once
/// CANopen without its services for data: network management (NMT), heartbeat, SYNC and emergency (EMCY). The service
/// data objects are in sdo.h, the process data objects in pdo.h.
///
/// Every object has a COB-ID: an 11-bit identifier, for most objects a function code plus the node, 1 … 127.
/// Source: CiA 301, version 4.2.0: 7.2.5 (SYNC), 7.2.7 (EMCY), 7.2.8 (NMT), 7.3.3 (identifiers).

#include <array>
#include <cstdint>
#include <optional>

#include "drivers/line/can_frame.h"

namespace robot_control::canopen {

inline constexpr std::uint8_t kMaxNode = 127;
inline constexpr canid_t kNmt = 0x000, kSync = 0x080;
inline constexpr canid_t kEmergency = 0x080, kSdoResponse = 0x580, kSdoRequest = 0x600, kHeartbeat = 0x700;  ///< + node

/// An entry of the object dictionary.
struct ObjectAddress {
  std::uint16_t index = 0;
  std::uint8_t sub = 0;

  bool operator==(const ObjectAddress&) const = default;
};

enum class NmtCommand : std::uint8_t {
  kStart = 0x01,
  kStop = 0x02,
  kEnterPreOperational = 0x80,
  kResetNode = 0x81,
};

struct NmtRequest {
  NmtCommand command = NmtCommand::kEnterPreOperational;
  std::uint8_t node = 0;  ///< 0: all nodes
};

can_frame encode_nmt(const NmtRequest& request) noexcept;
std::optional<NmtRequest> decode_nmt(const can_frame& frame) noexcept;

enum class NmtState : std::uint8_t { kBootUp = 0x00, kStopped = 0x04, kOperational = 0x05, kPreOperational = 0x7F };

struct Heartbeat {
  std::uint8_t node = 0;
  NmtState state = NmtState::kBootUp;
};

/// The highest bit of a heartbeat is reserved: it is the toggle bit of the older node guarding.
can_frame encode_heartbeat(const Heartbeat& heartbeat) noexcept;
std::optional<Heartbeat> decode_heartbeat(const can_frame& frame) noexcept;

/// Value of 1016:n, the node whose heartbeat a node expects and the time after which it is lost, ms.
constexpr std::uint32_t heartbeat_consumer(std::uint8_t node, std::uint16_t timeout_ms) noexcept {
  return static_cast<std::uint32_t>(node) << 16U | timeout_ms;
}

/// SYNC without a counter (1019 is 0).
can_frame sync_frame() noexcept;

struct Emergency {
  std::uint8_t node = 0;
  std::uint16_t code = 0;  ///< 0000: an error was reset or no error is left
  std::uint8_t error_register = 0;
  std::array<std::uint8_t, 5> specific{};  ///< defined by the maker
};

can_frame encode_emergency(const Emergency& emergency) noexcept;
std::optional<Emergency> decode_emergency(const can_frame& frame) noexcept;

/// Returns an error code of EMCY or 603F in words; the words of its class where the code itself is the maker's.
/// Sources: CiA 301, table 26; CiA 402-2, table of error codes.
const char* error_code_words(std::uint16_t code) noexcept;

}  // namespace robot_control::canopen

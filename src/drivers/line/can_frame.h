#pragma once
/// Classic CAN frames, in the layout of Linux (struct can_frame: 32-bit identifier with flags, length, 8 bytes of
/// data).
///
/// The identifier holds 11 bits, or 29 bits with CAN_EFF_FLAG. CAN_RTR_FLAG marks a remote transmission request, which
/// has a length and no data. CAN_ERR_FLAG marks an error message of the controller, which never was on the wire.
/// Source: linux/can.h, linux/can/error.h.

#include <linux/can.h>

#include <algorithm>
#include <cstdint>
#include <span>

namespace robot_control {

inline bool is_extended(const can_frame& frame) noexcept {
  return (frame.can_id & CAN_EFF_FLAG) != 0;
}

inline bool is_remote_request(const can_frame& frame) noexcept {
  return (frame.can_id & CAN_RTR_FLAG) != 0;
}

inline bool is_error(const can_frame& frame) noexcept {
  return (frame.can_id & CAN_ERR_FLAG) != 0;
}

/// Returns whether the frame carries data under an identifier of 11 bits.
inline bool is_standard_data(const can_frame& frame) noexcept {
  return (frame.can_id & ~CAN_SFF_MASK) == 0 && frame.len <= CAN_MAX_DLEN;
}

/// Returns whether the frame carries data under an identifier of 29 bits.
inline bool is_extended_data(const can_frame& frame) noexcept {
  return (frame.can_id & ~CAN_EFF_MASK) == CAN_EFF_FLAG && frame.len <= CAN_MAX_DLEN;
}

/// Builds a frame of at most 8 bytes; further bytes are ignored.
inline can_frame data_frame(canid_t id, std::span<const std::uint8_t> data) noexcept {
  can_frame frame{};
  frame.can_id = id;
  frame.len = static_cast<std::uint8_t>(std::min<std::size_t>(data.size(), CAN_MAX_DLEN));
  std::copy_n(data.begin(), frame.len, frame.data);
  return frame;
}

/// Bits of the data as one number: bit 0 is the lowest bit of byte 0 (little-endian, as in all dialects here).
inline std::uint64_t data_word(const can_frame& frame) noexcept {
  std::uint64_t word = 0;
  for (int i = CAN_MAX_DLEN - 1; i >= 0; --i) word = word << 8U | frame.data[i];
  return word;
}

/// Builds a frame whose data are the lowest `bytes` bytes of `word`.
inline can_frame word_frame(canid_t id, std::uint64_t word, std::uint8_t bytes) noexcept {
  can_frame frame{};
  frame.can_id = id;
  frame.len = bytes;
  for (std::uint8_t i = 0; i < bytes; ++i) frame.data[i] = static_cast<std::uint8_t>(word >> (8U * i));
  return frame;
}

}  // namespace robot_control

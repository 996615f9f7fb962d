#pragma once
/// Frames of classic CAN and of CAN FD, in the layouts of Linux. A classic frame (struct ::can_frame) has an identifier
/// with flags, a length and 8 bytes of data. A frame of CAN FD (struct ::canfd_frame) has the same first members and up
/// to 64 bytes, so it holds either.
///
/// CANFD_FDF marks a frame of CAN FD, which is sent as a ::canfd_frame; any other one is sent as a ::can_frame.
/// CANFD_BRS marks that its data have the higher bit rate. A frame of CAN FD holds 0 … 8, 12, 16, 20, 24, 32, 48 or 64
/// bytes.
///
/// The identifier holds 11 bits, or 29 bits with CAN_EFF_FLAG. CAN_RTR_FLAG marks a remote transmission request, which
/// has a length and no data. CAN_ERR_FLAG marks an error message of the controller, which never was on the wire.
/// Source: linux/can.h, linux/can/error.h.

#include <linux/can.h>

#include <algorithm>
#include <cstdint>
#include <span>

namespace robot_control {

inline constexpr std::size_t kFrameBytes = sizeof(::can_frame);  ///< that the kernel exchanges for a classic frame
inline constexpr std::size_t kFdFrameBytes = sizeof(::canfd_frame);

/// A frame of either kind.
using can_frame = ::canfd_frame;

inline bool is_fd(const can_frame& frame) noexcept {
  return (frame.flags & CANFD_FDF) != 0;
}

/// Returns the greatest length of a frame of its kind.
inline unsigned max_length(const can_frame& frame) noexcept {
  return is_fd(frame) ? CANFD_MAX_DLEN : CAN_MAX_DLEN;
}

/// Returns the number of bytes that the kernel exchanges for such a frame.
inline std::size_t transfer_size(const can_frame& frame) noexcept {
  return is_fd(frame) ? kFdFrameBytes : kFrameBytes;
}

/// Returns the next length that a frame of CAN FD may have, of at most 64 bytes.
constexpr unsigned fd_length(unsigned bytes) noexcept {
  for (const unsigned length : {8U, 12U, 16U, 20U, 24U, 32U, 48U}) {
    if (bytes <= length) return bytes <= 8 ? bytes : length;
  }
  return CANFD_MAX_DLEN;
}

inline bool is_extended(const can_frame& frame) noexcept {
  return (frame.can_id & CAN_EFF_FLAG) != 0;
}

inline bool is_remote_request(const can_frame& frame) noexcept {
  return (frame.can_id & CAN_RTR_FLAG) != 0;
}

inline bool is_error(const can_frame& frame) noexcept {
  return (frame.can_id & CAN_ERR_FLAG) != 0;
}

/// Returns whether the frame is of classic CAN, and carries data under an identifier of 11 bits.
inline bool is_standard_data(const can_frame& frame) noexcept {
  return (frame.can_id & ~CAN_SFF_MASK) == 0 && frame.len <= CAN_MAX_DLEN && !is_fd(frame);
}

/// The same under an identifier of 29 bits.
inline bool is_extended_data(const can_frame& frame) noexcept {
  return (frame.can_id & ~CAN_EFF_MASK) == CAN_EFF_FLAG && frame.len <= CAN_MAX_DLEN && !is_fd(frame);
}

/// Builds a classic frame of at most 8 bytes; further bytes are ignored.
inline can_frame data_frame(canid_t id, std::span<const std::uint8_t> data) noexcept {
  can_frame frame{};
  frame.can_id = id;
  frame.len = static_cast<std::uint8_t>(std::min<std::size_t>(data.size(), CAN_MAX_DLEN));
  std::copy_n(data.begin(), frame.len, frame.data);
  return frame;
}

/// Bits of the first 8 bytes as one number: bit 0 is the lowest bit of byte 0 (little-endian, as in all dialects here).
inline std::uint64_t data_word(const can_frame& frame) noexcept {
  std::uint64_t word = 0;
  for (int i = CAN_MAX_DLEN - 1; i >= 0; --i) word = word << 8U | frame.data[i];
  return word;
}

/// Builds a classic frame whose data are the lowest `bytes` bytes of `word`.
inline can_frame word_frame(canid_t id, std::uint64_t word, std::uint8_t bytes) noexcept {
  can_frame frame{};
  frame.can_id = id;
  frame.len = bytes;
  for (std::uint8_t i = 0; i < bytes; ++i) frame.data[i] = static_cast<std::uint8_t>(word >> (8U * i));
  return frame;
}

}  // namespace robot_control

#pragma once
/// The head that every frame on the bus begins with, and the checksum that seals a frame.
///
/// A frame is a trivially copyable struct of fixed size, a multiple of 8 bytes without padding, whose
/// first member is `FrameHead head`. Units are SI, angles rad, frames of reference as in REP 103/105.

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace robot_control {

/// What stands behind a head.
enum class FrameKind : std::uint64_t {
  kFrame = 1,  ///< A frame with content.
  kToken = 2,  ///< Lockstep only: "cycle k has passed here, without a frame". Content is zero.
};

struct FrameHead {
  std::uint64_t checksum = 0;  ///< Of all words behind this one; written by `seal`.
  std::uint64_t run = 0;       ///< Random number minted by the driver at its start or reset; never 0.
  std::uint64_t cycle = 0;     ///< Counts from 0 in each run.
  std::int64_t stamp_ns = 0;   ///< Of the sensor sample this frame descends from: run start + cycle * period.
  FrameKind kind = FrameKind::kFrame;
};

/// Words of 8 bytes that a frame consists of; refuses types that cannot cross a process.
template <class Frame>
inline constexpr std::size_t kFrameWords = [] {
  static_assert(std::is_trivially_copyable_v<Frame> && std::is_standard_layout_v<Frame>);
  static_assert(offsetof(Frame, head) == 0 && sizeof(Frame) % 8 == 0);
  return sizeof(Frame) / 8;
}();

/// 64-bit multiply-rotate hash over the words behind `head.checksum`, in four independent lanes.
/// Detects torn, truncated and overwritten frames; it is no protection against an attacker.
template <class Frame>
std::uint64_t checksum_of(const Frame& frame) noexcept {
  constexpr std::uint64_t kOdd = 0x9E3779B97F4A7C15ULL;  // 2^64 / golden ratio, odd
  std::array<std::uint64_t, kFrameWords<Frame>> words;
  std::memcpy(words.data(), &frame, sizeof(Frame));
  std::array<std::uint64_t, 4> lane{1, 2, 3, 4};
  for (std::size_t i = 1; i < words.size(); ++i) {
    lane[i % 4] = std::rotl((lane[i % 4] ^ words[i]) * kOdd, 29);
  }
  std::uint64_t hash = words.size();
  for (const std::uint64_t part : lane) hash = std::rotl((hash ^ part) * kOdd, 31);
  return hash;
}

/// Last act of a writer.
template <class Frame>
void seal(Frame& frame) noexcept {
  frame.head.checksum = checksum_of(frame);
}

/// First question of a reader: is this frame what a writer sealed?
template <class Frame>
bool intact(const Frame& frame) noexcept {
  return frame.head.checksum == checksum_of(frame);
}

}  // namespace robot_control

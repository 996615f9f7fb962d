#pragma once
/// Every frame on the bus begins with a FrameHead, whose checksum seals the frame.
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

/// The kind of data behind a head.
enum class FrameKind : std::uint64_t {
  kFrame = 1,  ///< A frame with content.
  kToken = 2,  ///< A frame without content: cycle k has passed, but a state was corrupt or ClosedLoop injects a fault.
};

/// The result of looking up a frame.
enum class Lookup : std::uint64_t { kMissing, kFrame, kToken, kCorrupt };

struct FrameHead {
  std::uint64_t checksum = 0;  ///< Checksum of all words behind this one; written by `seal`.
  std::uint64_t run = 0;       ///< Random number that the driver draws at its start or reset; never 0.
  std::uint64_t cycle = 0;     ///< Counts from 0 in each run.
  std::int64_t stamp_ns =
      0;  ///< Stamp of the sensor sample from which this frame descends: run start + cycle * period.
  FrameKind kind = FrameKind::kFrame;
};

/// The number of 8-byte words of a frame. Types that cannot be sent to another process do not compile.
template <class Frame>
inline constexpr std::size_t kFrameWords = [] {
  static_assert(std::is_trivially_copyable_v<Frame> && std::is_standard_layout_v<Frame>);
  static_assert(offsetof(Frame, head) == 0 && sizeof(Frame) % 8 == 0);
  return sizeof(Frame) / 8;
}();

/// Returns word `i` of a frame in place; a bit_cast would copy the whole frame first.
template <class Frame>
std::uint64_t word_of(const Frame& frame, std::size_t i) noexcept {
  std::uint64_t word = 0;
  std::memcpy(&word, reinterpret_cast<const std::byte*>(&frame) + 8 * i, sizeof(word));
  return word;
}

/// Returns a 64-bit multiply-rotate hash of the words behind `head.checksum`. Eight independent lanes use the
/// throughput of the multiplier instead of waiting for its latency. The hash detects torn, truncated and overwritten
/// frames; it is no protection against an attacker.
template <class Frame>
std::uint64_t checksum_of(const Frame& frame) noexcept {
  constexpr std::uint64_t kOdd = 0x9E3779B97F4A7C15ULL;  // 2^64 / golden ratio, odd
  constexpr std::size_t kLanes = 8;
  constexpr std::size_t kWords = kFrameWords<Frame>;
  constexpr std::size_t kRest =
      kWords - (kWords - 1) % kLanes;  // index of the first word behind the last complete row of lanes
  const auto mix = [](std::uint64_t hash, std::uint64_t word) { return std::rotl((hash ^ word) * kOdd, 29); };
  std::array<std::uint64_t, kLanes> lanes{1, 2, 3, 4, 5, 6, 7, 8};
  for (std::size_t i = 1; i < kRest; i += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) lanes[lane] = mix(lanes[lane], word_of(frame, i + lane));
  }
  for (std::size_t i = kRest; i < kWords; ++i) lanes[0] = mix(lanes[0], word_of(frame, i));
  std::uint64_t hash = kWords;
  for (const std::uint64_t lane : lanes) hash = mix(hash, lane);
  return hash;
}

/// Writes the checksum; it is the last step of a writer.
template <class Frame>
void seal(Frame& frame) noexcept {
  frame.head.checksum = checksum_of(frame);
}

/// Returns whether the frame is as its writer sealed it; every reader checks this first.
template <class Frame>
bool intact(const Frame& frame) noexcept {
  return frame.head.checksum == checksum_of(frame);
}

}  // namespace robot_control

#pragma once
/// When a sender of `clearance` that published repeatedly has fallen silent.
///
/// Two finite values within kStreamSilence are a stream. A stream that pauses for kStreamSilence leaves the clearance 0
/// until the next message: what it said of the way ahead is too old. A single value holds. ∞ ends a stream.

#include <cmath>
#include <cstdint>

namespace robot_control {

inline constexpr std::int64_t kStreamSilence = 500'000'000;  ///< ns: five scans of a laser of 10 Hz

class ClearanceStream {
 public:
  /// Notes a value in m, received at `now_ns`.
  void receive(double clearance, std::int64_t now_ns) noexcept {
    streams_ = std::isfinite(clearance) && finite_ && now_ns - received_ns_ < kStreamSilence;
    finite_ = std::isfinite(clearance);
    received_ns_ = now_ns;
  }

  /// Returns true once per silence.
  bool falls_silent(std::int64_t now_ns) noexcept {
    if (!streams_ || now_ns - received_ns_ < kStreamSilence) return false;
    streams_ = finite_ = false;
    return true;
  }

 private:
  bool streams_ = false, finite_ = false;
  std::int64_t received_ns_ = 0;
};

}  // namespace robot_control

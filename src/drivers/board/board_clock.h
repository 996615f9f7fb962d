#pragma once
/// The time of a board's samples on the clock of the host.
///
/// An order leaves the host at h₀ and reaches the board at b₁; its report leaves at b₂ and reaches the host at h₃. With
/// the present estimate host = b (1 + drift) + offset, each exchange gives two delays with an unknown common error:
///
///   down = host(b₁) − h₀        up = h₃ − host(b₂)
///
/// Delays of a line vary, but each way is now and then nearly free of them. The least `down` and the least `up` of a
/// window are therefore the constant delays, which count as equal. Half of their difference is the error of the
/// estimate. It corrects the offset, and its rate the drift. Until the first window ends, the exchange with the
/// shortest round trip gives the offset.

#include <algorithm>
#include <cstdint>
#include <limits>

namespace robot_control {

class BoardClock {
 public:
  static constexpr std::int64_t kWindowNs = 1'000'000'000;
  static constexpr int kMinExchanges = 20;     ///< of a window; a slow loop has longer windows
  static constexpr double kDriftGain = 0.3;    ///< share of the error's rate
  static constexpr double kMaxDrift = 500e-6;  ///< of a crystal or a ceramic resonator that is trimmed

  void restart() noexcept { *this = BoardClock(); }

  /// `h0_ns`, `h3_ns` on the host's clock, `b1_us`, `b2_us` on that of the board, without its wraps.
  void add(std::int64_t h0_ns, std::int64_t b1_us, std::int64_t b2_us, std::int64_t h3_ns) noexcept {
    if (exchanges_ == 0 && windows_ == 0) {
      zero_us_ = b1_us;
      zero_ns_ = begin_ns_ = h0_ns;
      least_trip_ns_ = std::numeric_limits<std::int64_t>::max();
    }
    const std::int64_t trip_ns = (h3_ns - h0_ns) - 1000 * (b2_us - b1_us);
    if (windows_ == 0 && trip_ns < least_trip_ns_) {
      // The delays of this window were computed with another offset.
      const std::int64_t change_ns = (h0_ns - host_ns(b1_us) + h3_ns - host_ns(b2_us)) / 2;
      zero_ns_ += change_ns;
      down_ns_ += exchanges_ == 0 ? 0 : change_ns;
      up_ns_ -= exchanges_ == 0 ? 0 : change_ns;
      least_trip_ns_ = trip_ns;
    }
    down_ns_ = std::min(down_ns_, host_ns(b1_us) - h0_ns);
    up_ns_ = std::min(up_ns_, h3_ns - host_ns(b2_us));
    ++exchanges_;
    if (h0_ns - begin_ns_ >= kWindowNs && exchanges_ >= kMinExchanges) end_window(h0_ns, b1_us);
  }

  /// Returns the time on the host's clock.
  std::int64_t host_ns(std::int64_t board_us) const noexcept {
    const auto elapsed = static_cast<double>(1000 * (board_us - zero_us_));
    return zero_ns_ + 1000 * (board_us - zero_us_) + static_cast<std::int64_t>(drift_ * elapsed);
  }

  /// Returns by how much the host's clock runs faster than that of the board.
  double drift() const noexcept { return drift_; }

 private:
  static constexpr std::int64_t kNone = 1'000'000'000'000;

  void end_window(std::int64_t now_ns, std::int64_t now_us) noexcept {
    const std::int64_t error_ns = (up_ns_ - down_ns_) / 2;
    const std::int64_t now_host_ns = host_ns(now_us);
    // The first window has no drift yet, so its least delays lie at its ends: only its rate over the next one counts.
    const double rate = static_cast<double>(error_ns) / static_cast<double>(now_ns - begin_ns_);
    if (windows_ > 0) drift_ = std::clamp(drift_ + kDriftGain * rate, -kMaxDrift, kMaxDrift);
    zero_us_ = now_us;  // the drift turns about the newest instant
    zero_ns_ = now_host_ns + error_ns;
    begin_ns_ = now_ns;
    down_ns_ = up_ns_ = kNone;
    exchanges_ = 0;
    ++windows_;
  }

  std::int64_t zero_us_ = 0;  // on the board's clock
  std::int64_t zero_ns_ = 0;  // the same instant on the host's
  double drift_ = 0;
  std::int64_t begin_ns_ = 0;  // of the window
  std::int64_t down_ns_ = kNone;
  std::int64_t up_ns_ = kNone;
  std::int64_t least_trip_ns_ = 0;
  int exchanges_ = 0;  // in the window
  std::uint64_t windows_ = 0;
};

}  // namespace robot_control

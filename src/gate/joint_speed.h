#pragma once
/// How fast a joint turns, from its positions alone: good for fine encoders, for coarse ones and for none at all.
///
///   speed(k) = (q_a − q_b)/(max(a − b, k − a, base)·period)
///
/// a: the last cycle in which the position changed; b: the last such cycle ≥ base before a, else the oldest one known.
/// From change to change whole counts pass. If the counts are coarser than the samples, a steady speed is off by at
/// most one cycle of a − b ≥ base. If they are finer, it is off by at most one count of q_a − q_b. At 1 kHz that is 8 %
/// with 64 counts a turn and 0.13 rad/s with 4096; one cycle's difference jumps by 98 and 1.5 rad/s. A joint that
/// dithers about an edge is no faster than a count per base; one that stands fades with k − a. The speed is that of
/// base/2 ago.
///
/// Cycles that were skipped count. Real-time safe: constant size, no loop over the window.

#include <array>
#include <cstddef>
#include <cstdint>

namespace robot_control {

/// s. Half of it is the lag, in which a joint of 700 rad/s² gains 4 rad/s.
inline constexpr double kSpeedBase = 0.012;

class JointSpeed {
 public:
  /// `period` > 0, s. Above 2.5 kHz the base is shorter: kChanges − 2 cycles.
  explicit JointSpeed(double period) noexcept;

  /// `position` rad or m, finite; `cycle` later than the last one.
  void step(double position, std::uint64_t cycle) noexcept;

  /// rad/s or m/s. Infinite when positions beyond all bounds overflow, never NaN.
  double value() const noexcept { return speed_; }

 private:
  struct Change {
    std::uint64_t cycle = 0;
    double position = 0;
  };
  static constexpr std::size_t kChanges = 32;  ///< a power of two

  const Change& change(std::uint64_t index) const noexcept { return changes_[index % kChanges]; }

  double period_;
  std::uint64_t base_;       ///< cycles
  std::uint64_t count_ = 0;  ///< changes so far; a is the one of index count_ − 1
  std::uint64_t first_ = 0;  ///< index of b
  double speed_ = 0;
  std::array<Change, kChanges> changes_{};
};

}  // namespace robot_control

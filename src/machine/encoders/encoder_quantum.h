#pragma once
/// Learns the angle of one encoder count from the samples. It is the smallest step of the angle, or change of step, so
/// far.
///
/// A wheel that starts, or changes its speed, shows a single count at once. The steps of an encoder without counts
/// change by less and less. Below 10⁻⁴ rad, 63,000 counts a turn, it counts as exact: 0. Until the angle changes for
/// the first time, the count is that of another wheel whose angle has changed. Otherwise it is that of the coarsest
/// known encoder: 45 counts a turn, of a hub motor's Hall sensors.

#include <numbers>

namespace robot_control {

class EncoderQuantum {
 public:
  /// Learns from the angle `turned` since the last sample, rad. Returns true if the value has changed.
  bool refine(double turned) noexcept;

  /// Takes the value of another wheel until the angle changes for the first time. Returns true if the value has
  /// changed.
  bool assume(const EncoderQuantum& other) noexcept;

  double value() const noexcept { return value_; }  ///< rad; 0: exact

 private:
  static constexpr double kCoarsest = 2 * std::numbers::pi / 45;  // rad

  double value_ = kCoarsest;
  double last_ = 0;       ///< rad, last step
  bool changed_ = false;  ///< The angle has changed at least once.
};

}  // namespace robot_control

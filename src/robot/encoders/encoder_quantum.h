#pragma once
/// The angle of one encoder count, learned from the samples: the smallest step of the angle, or change of step, so far.
///
/// A wheel that starts, or changes its speed, shows a single count at once. An encoder without counts has steps that
/// change by less and less; below 10⁻⁴ rad, 63,000 counts a turn, it is taken for exact: 0. Until the angle changes for
/// the first time, it is taken for that of another wheel, whose angle has changed, or else for the coarsest encoder
/// that is known: 45 counts a turn, of a hub motor's Hall sensors.

#include <numbers>

namespace robot_control {

class EncoderQuantum {
 public:
  /// `turned` rad: since the last sample. True: the value has changed.
  bool refine(double turned) noexcept;

  /// Until the angle changes for the first time: that of another wheel. True: the value has changed.
  bool assume(const EncoderQuantum& other) noexcept;

  double value() const noexcept { return value_; }  ///< rad; 0: exact

 private:
  static constexpr double kCoarsest = 2 * std::numbers::pi / 45;  // rad

  double value_ = kCoarsest;
  double last_ = 0;       ///< rad, the last step
  bool changed_ = false;  ///< the angle, at least once
};

}  // namespace robot_control

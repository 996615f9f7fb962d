#pragma once
/// The angle of one encoder count, learned from the samples: the smallest step of the angle, or change of step, so far.
///
/// A wheel that starts, or changes its speed, shows a single count at once. An encoder without counts has steps that
/// change by less and less; below 10⁻⁴ rad, 63,000 counts a turn, it is taken for exact: 0. Until the angle changes for
/// the first time, it is taken for the coarsest encoder that is known: 45 counts a turn, of a hub motor's Hall sensors.

#include <numbers>

namespace robot_control {

class EncoderQuantum {
 public:
  /// `turned` rad: since the last sample. True: the value has changed.
  bool refine(double turned) noexcept;

  double value() const noexcept { return value_; }  ///< rad; 0: exact

 private:
  double value_ = 2 * std::numbers::pi / 45;
  double last_ = 0;  ///< rad, the last step
};

}  // namespace robot_control

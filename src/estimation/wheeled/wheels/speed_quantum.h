#pragma once
/// Finds the step of wheel speeds that are reported in steps, of which travel over time of every reading is a multiple.
///
/// The step is the greatest common divisor of the changes between readings (Euclid), to kStampRounding of the speed.
/// Speeds without steps leave only that rounding. An encoder's counts are steps of the travel, whose error does not
/// grow, so that a step that the count explains is ignored.
///
/// A reading is off by up to half a step, as is each that repeats it. So n equal ones in a row are off by n times that.

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimation/common/values.h"

namespace robot_control {

class SpeedQuantum {
 public:
  /// `count` is one count of a side's encoder, m.
  explicit SpeedQuantum(double count = 0) noexcept : count_(count) {}

  /// Adds the travel of a reading (m) in `time` s, > 0.
  void add(double travel, double time) noexcept {
    const double speed = travel / time;
    const double rounding = kStampRounding * std::max(std::abs(speed), std::abs(last_));
    double change = std::abs(speed - last_);
    if (change > rounding) repeated_ = 0;
    while (change > rounding) change = std::abs(std::remainder(std::exchange(step_, change), change));
    repeated_ += 1;
    time_ = time;
    last_ = speed;
  }

  double step() const noexcept { return step_ * time_ > 2 * count_ ? step_ : 0; }  ///< m/s
  /// Returns by how much the last reading enlarges the variance of the travel, m².
  double travel_variance() const noexcept { return (2 * repeated_ - 1) * square(step() * time_) / 12; }

 private:
  static constexpr double kStampRounding = 1e-3;  ///< stamps in ms

  double count_;
  double step_ = 0;      ///< m/s
  double last_ = 0;      ///< m/s
  double time_ = 0;      ///< s
  double repeated_ = 0;  ///< number of equal readings in a row
};

}  // namespace robot_control

#pragma once
/// The step of wheel speeds that are reported in steps: travel over time of every reading is a multiple of it.
///
/// The step is the greatest common divisor of the changes from one reading to the next (Euclid), to kRounding of the
/// speed. Speeds without steps leave nothing but that rounding. Counts of an encoder are steps of the travel, whose
/// error does not grow; a step that the encoder's count explains is none.
///
/// A reading is off by up to half a step, and so is each that repeats it: n equal readings in a row are off by n times
/// as much.

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimation/values.h"

namespace robot_control {

class SpeedQuantum {
 public:
  /// m, of one side.
  explicit SpeedQuantum(double count = 0) noexcept : count_(count) {}

  /// The travel of a reading, m, in `time` s, > 0.
  void add(double travel, double time) noexcept {
    const double speed = travel / time;
    const double rounding = kRounding * std::max(std::abs(speed), std::abs(last_));
    double change = std::abs(speed - last_);
    if (change > rounding) repeated_ = 0;
    while (change > rounding) change = std::abs(std::remainder(std::exchange(step_, change), change));
    repeated_ += 1;
    time_ = time;
    last_ = speed;
  }

  double step() const noexcept { return step_ * time_ > 2 * count_ ? step_ : 0; }  ///< m/s
  /// m², that the last reading adds to the variance of the way: of n equal ones the error is n times as large.
  double travel_variance() const noexcept { return (2 * repeated_ - 1) * square(step() * time_) / 12; }

 private:
  static constexpr double kRounding = 1e-3;  ///< of stamps in ms

  double count_;
  double step_ = 0;      ///< m/s
  double last_ = 0;      ///< m/s
  double time_ = 0;      ///< s
  double repeated_ = 0;  ///< readings in a row
};

}  // namespace robot_control

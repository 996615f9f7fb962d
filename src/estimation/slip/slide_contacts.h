#pragma once
/// Which wheels slip in a slide. Without slip E keeps to its line and W to its value (motion_difference.h); a side
/// rolls, too, if the other one alone explains what they leave them by. Friction bends E even where it is near the
/// line: then that side slips. A robot may slide sideways on wheels that roll.

#include <array>
#include <cstdint>

#include "estimation/values.h"

namespace robot_control {

/// m/s, base axes: of E and W.
struct DifferenceSlope {
  double along = 0, across = 0, turn = 0;

  /// Of the path difference of the left (0) or right (1) side.
  double side(std::size_t i) const noexcept { return along + (i == 0 ? -1 : 1) * turn / 2; }
};

struct SlideContacts {
  std::array<bool, 2> slips{};  ///< left, right
  bool sideways = false;

  /// m/s, beyond which a slope is none of a rolling wheel.
  struct Tolerance {
    double path = 0;  ///< of E from the line
    double turn = 0;  ///< of W from 0
    double bend = 0;  ///< of either slope from the one before
  };

  void slip_all() noexcept { *this = {{true, true}, true}; }
  void roll_all() noexcept { *this = {}; }
  /// `excess`: slope beyond the line; `bend`: slope beyond the last one.
  void judge(const DifferenceSlope& excess, const DifferenceSlope& bend, const Tolerance& tolerance) noexcept;

  bool both_slip() const noexcept { return slips[0] && slips[1]; }
  bool both_roll() const noexcept { return !slips[0] && !slips[1]; }
  bool all_roll() const noexcept { return both_roll() && !sideways; }
  bool only_sideways() const noexcept { return both_roll() && sideways; }
  /// Of excess slopes or distances of both sides together and of their turn: the excess of the middle of the wheels,
  /// by which the wheels are ahead of the ground. One side that rolls shows it without the accelerometer.
  double slipped(double along, double turn) const noexcept;
  /// SlipReason; `wheel_speed` m/s.
  std::uint64_t reasons(const DifferenceSlope& excess, double wheel_speed) const noexcept;
};

}  // namespace robot_control

#pragma once
/// Converts the readings of both sides to the travel of the middle of the wheels, and the turn since half of it.
///
///   distance = (left + right)/2 + ε (right − left)/4        ε: radius ratio − 1
///
/// If a side is lost, the other one replaces it by the turn of the robot:
///
///   distance = travel of the side ± turn · wheel_base / 2        + for the left side
///
/// The gyro measures that turn, so the second part has no clock offset. The travel that was replaced is deducted from
/// the first reading after the gap.

#include <array>
#include <cstddef>
#include <utility>

#include "estimation/wheeled/wheels/wheel_sides.h"
#include "signals/fixed_vector.h"

namespace robot_control {

class MiddleTravel {
 public:
  struct Travel {
    double distance = 0;    ///< m
    double turn_since = 0;  ///< rad, turned since half of that travel
    double late = 1;        ///< share of the distance that wheels measured; that alone is late by the clock offset
  };
  using Travels = FixedVector<Travel, 2>;

  /// `turned` (rad) is the turn of the robot in this step, `wheel_base` is in m and `ratio` is ε.
  Travels step(const WheelReading& wheels, double turned, double wheel_base, double ratio) noexcept {
    for (Side& side : sides_) side.turned += turned;
    Travels travels;
    const bool together = wheels.both_received() && sides_[0].credited == 0 && sides_[1].credited == 0;
    if (together && sides_[0].turned == sides_[1].turned) {
      travels.emplace_back(wheels.mean() + ratio * (wheels.right() - wheels.left()) / 4, sides_[0].turned / 2);
      forget_turn();
      return travels;
    }
    for (const std::size_t i : {0U, 1U}) {
      if (wheels.received[i]) travels.emplace_back(travel(wheels, i, wheel_base));
    }
    return travels;
  }

  /// Returns the turn since the last readings of the sides that were received now, rad.
  double turned_since(const WheelReading& wheels) const noexcept {
    return (wheels.received[0] ? sides_[0].turned / 2 : 0) + (wheels.received[1] ? sides_[1].turned / 2 : 0);
  }
  void forget_turn() noexcept { sides_[0].turned = sides_[1].turned = 0; }      ///< forgets the turn since the readings
  void forget_credit(std::size_t side) noexcept { sides_[side].credited = 0; }  ///< The side lost its travel.

 private:
  struct Side {
    double turned = 0;    ///< rad since its last reading
    double credited = 0;  ///< m by which the other side replaced this one
  };

  Travel travel(const WheelReading& wheels, std::size_t i, double wheel_base) noexcept {
    const double turned = std::exchange(sides_[i].turned, 0);
    const double own = wheels.travel[i];
    const double credited = std::exchange(sides_[i].credited, 0);
    if (!wheels.lost[1 - i]) return {.distance = (own - credited) / 2, .turn_since = turned / 2};
    const double across = (i == 0 ? 1 : -1) * turned * wheel_base;
    const double distance = own + across / 2;
    sides_[1 - i].credited += own + across;
    return {.distance = distance, .turn_since = turned / 2, .late = distance == 0 ? 0 : own / distance};
  }

  std::array<Side, 2> sides_;
};

}  // namespace robot_control

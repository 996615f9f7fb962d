#pragma once
/// The outline of a robot with its joints where they were within the last kStride: legs and arms move it.

#include <deque>
#include <map>
#include <string>
#include <utility>

#include "machine/bodies/rigid_bodies.h"
#include "navigation/footprint.h"

namespace robot_control::navigation {

inline constexpr double kStride = 1.0;          ///< s; the slowest gait's period
inline constexpr double kOutlinePeriod = 0.05;  ///< s, at least, between two outlines

class MovingOutline {
 public:
  /// Every joint is at zero until the first update. Throws what footprint_of throws.
  explicit MovingOutline(RigidBodies robot) : robot_(std::move(robot)), footprint_(footprint_of(robot_)) {}

  /// Returns whether a joint can change the outline: one that is no wheel.
  bool changes() const;

  /// `positions` in rad or m, by joint; `now` in s. Throws what footprint_of throws; the outline stays then.
  void update(const std::map<std::string, double>& positions, double now);

  const Footprint& footprint() const noexcept { return footprint_; }

 private:
  RigidBodies robot_;
  std::deque<std::pair<double, Footprint>> lately_;  // s
  Footprint footprint_;
};

}  // namespace robot_control::navigation

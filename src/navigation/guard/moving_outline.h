#pragma once
/// The outline of a robot with its joints where they were within the last kStride: legs and arms move it.

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "machine/bodies/rigid_bodies.h"
#include "navigation/footprint.h"

namespace robot_control::navigation {

inline constexpr double kStride = 1.0;          ///< s; the slowest gait's period
inline constexpr double kOutlinePeriod = 0.05;  ///< s, at least, between two outlines

class MovingOutline {
 public:
  /// `first` is the outline until the first update.
  MovingOutline(RigidBodies robot, Footprint first) : robot_(std::move(robot)), footprint_(std::move(first)) {}

  /// Returns whether a joint can change the outline: one that is no wheel.
  bool changes() const;

  /// `positions` in rad or m, by joint; `now` in s. Throws what footprint_of throws; the outline stays then.
  void update(const std::map<std::string, double>& positions, double now);

  const Footprint& footprint() const noexcept { return footprint_; }

 private:
  RigidBodies robot_;
  std::vector<double> times_;      // s
  std::vector<Footprint> lately_;  // at these times
  Footprint footprint_;
};

}  // namespace robot_control::navigation

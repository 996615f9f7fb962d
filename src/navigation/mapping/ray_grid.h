#pragma once
/// A RayGrid is an occupancy grid that is drawn by rays (Probabilistic Robotics, section 9.2) and grows with them.
///
/// Each cell holds the logarithm of its odds to be occupied in steps of log(0.65/0.35). A ray that passes a cell takes
/// one step away, and one that ends in it adds kHitSteps. The sum stays within ±kMaxSteps, so that what has moved is
/// forgotten. A ray without an echo passes all cells up to range_max. One that was not measured changes nothing.

#include <cstdint>

#include "navigation/grid.h"
#include "navigation/scan.h"

namespace robot_control::navigation {

inline constexpr int kHitSteps = 3;
inline constexpr int kMaxSteps = 12;
inline constexpr double kMaxRay = 15;  ///< m; cells that are farther away are not changed

class RayGrid {
 public:
  RayGrid() = default;

  /// Unknown cells of `saved` have even odds.
  explicit RayGrid(const Grid& saved);

  /// Inserts a scan of a laser at this pose. Rays end at the border of a grid that has kMaxCells.
  void insert(const Scan& scan, const PlanarPose& laser);

  /// Returns the probabilities in per cent; cells of even odds are unknown.
  Grid grid() const;

 private:
  void include(double low_x, double low_y, double high_x, double high_y);
  void add(Cell cell, int steps);

  Grid steps_;  // its cells are numbers of steps
};

}  // namespace robot_control::navigation

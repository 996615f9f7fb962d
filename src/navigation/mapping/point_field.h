#pragma once
/// A PointField holds the points of walls so that scans can be compared with them.
///
/// A cell holds the nearest point within kReach of its middle. Its likelihood to be the end of a ray is exp(−d²/2σ²),
/// with the distance d of that point. The score of points at a pose is their mean likelihood.
///
/// `search` finds the pose of the best score in a window by branch and bound (W. Hess et al., Real-time loop closure in
/// 2D LIDAR SLAM, ICRA 2016). Level h holds the maxima over squares of 2ʰ × 2ʰ cells, which bound all poses in them.

#include <cstdint>
#include <optional>
#include <vector>

#include "navigation/mapping/wall_points.h"

namespace robot_control::navigation {

/// Poses around `middle`.
struct SearchWindow {
  PlanarPose middle;
  double distance = 0, turn = 0;  ///< ± m in x and in y, ± rad
};

struct Found {
  PlanarPose pose;
  double score = 0;
  bool proven = true;  ///< false: the search ended early, and the pose is one that may be the best
};

class PointField {
 public:
  static constexpr int kReach = 6;                               ///< cells
  static constexpr double kSamePlace = 0.5, kSameHeading = 0.5;  ///< m, rad
  static constexpr int kMaxBounds = 4'000'000;                   ///< of 250 points each they take about 2 s

  /// Points over more than kMaxCells cells are refused: the field is then empty.
  PointField(std::vector<WallPoint> points, double resolution);

  const std::vector<WallPoint>& points() const noexcept { return points_; }

  /// Returns the nearest point within kReach; nullptr without one.
  const WallPoint* nearest(const Eigen::Vector2d& at) const noexcept;

  /// Returns the best pose of the points in the window, if its score is `least` or more. It is not within kSamePlace
  /// and kSameHeading of `known`. The search ends after `max_bounds` computed bounds.
  std::optional<Found> search(const std::vector<WallPoint>& seen, const SearchWindow& window, double least,
                              const PlanarPose* known = nullptr, int max_bounds = kMaxBounds);

 private:
  static constexpr int kLevels = 6;

  void make_levels();

  std::vector<WallPoint> points_;
  double resolution_;
  int columns_ = 0, rows_ = 0;
  Eigen::Vector2d corner_ = Eigen::Vector2d::Zero();  // of cell (0, 0)
  std::vector<std::int32_t> nearest_;                 // −1: none
  std::vector<std::vector<std::uint8_t>> levels_;     // made by the first search
};

}  // namespace robot_control::navigation

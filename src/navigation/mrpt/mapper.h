#pragma once
/// A Mapper builds a map from a laser and an odometry, and says where the robot is in it.
///
/// Each scan is matched with the points of the map by MRPT's CICP (iterative closest points), from the pose that the
/// odometry predicts. This is what its CMetricMapBuilderICP does; here the map can begin with a saved one. Points are
/// matched, because the same matching against the grid diverges.
///
/// The pose in the map is correction ∘ odometry. Only the correction, the transform from map to odom, is changed by a
/// match, so that `odom` never jumps.

#include <cstddef>
#include <memory>
#include <string>

#include "navigation/grid.h"
#include "navigation/scan.h"

namespace robot_control::navigation {

class Mapper {
 public:
  /// The map begins empty, and its origin is the pose of the first scan's robot.
  Mapper();

  /// The map begins with `saved`, in which the robot is at `pose`. Walls and robot move by up to half a cell (align).
  Mapper(const Grid& saved, const PlanarPose& pose);
  ~Mapper();
  Mapper(Mapper&&) noexcept;
  Mapper& operator=(Mapper&&) noexcept;

  /// Takes the next scan. `sensor` is the pose of the laser in the base, `odometry` that of the base in odom when the
  /// scan was made.
  void update(const Scan& scan, const PlanarPose& sensor, const PlanarPose& odometry);

  /// Return the pose of the base at the last scan, and the pose of odom, both in the map.
  PlanarPose pose() const noexcept;
  PlanarPose correction() const noexcept;

  /// Returns the part of the last matched scan's points that found one of the map; 1 before the first match.
  double matched() const noexcept;

  /// Returns the number of points with which scans are matched. It grows with what is seen, not with time.
  std::size_t points() const noexcept;

  /// Returns whether the last scan fits the map. One that does not changes nothing.
  bool fits() const noexcept;

  /// Returns why it does not, in one sentence; "" if it does.
  std::string reason() const;

  /// Returns the map up to now; cells that no ray has touched are unknown.
  Grid grid() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace robot_control::navigation

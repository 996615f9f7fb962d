#pragma once
/// A Mapper builds a map from a laser and an odometry, and says where the robot is in it.
///
/// The map is a graph of scans (PoseGraph). The reference is the node whose pose is most like that of the robot. Each
/// scan is matched with the walls of the nodes within kLocalLength of it along the edges. A pose that is like no node
/// becomes one, with the match as its edge.
///
/// A far node of the graph may be near a new one, by the covariance of the way between them. A search for the walls
/// that were seen last then closes the loop. The graph is optimised, and the map is drawn again.
///
/// An odometry whose covariance shrinks has corrected its past path. Its step may then be that correction, so that it
/// is as uncertain as the covariance has shrunk (growth).
///
/// A point contradicts the map if it lies where the reference saw free space. The robot is lost while these points
/// outnumber those that match. Nothing is then added to the map. Its scan is searched nearby. The last three scans or
/// more are searched in the whole map, which may take seconds; `fits` shows the loss before.
///
/// Without enough points in sight, the odometry alone moves the pose. The pose in the map is correction ∘ odometry.
/// Only the correction is changed by a match, so that `odom` never jumps. The same calls give the same map.

#include <cstddef>
#include <memory>
#include <string>

#include "navigation/grid.h"
#include "navigation/mapping/pose_graph.h"
#include "navigation/scan.h"
#include "navigation/uncertain_pose.h"

namespace robot_control::navigation {

/// A pose that moves with a node when the graph is optimised.
struct Anchor {
  std::size_t node = 0;
  PlanarPose relative;
};

class Mapper {
 public:
  /// The map begins with the first walls in sight. Its origin is the pose of the first scan's robot.
  Mapper();

  /// The map goes on with `saved`, in which the robot is near the origin.
  explicit Mapper(Grid saved);
  explicit Mapper(PoseGraph saved);
  ~Mapper();
  Mapper(Mapper&&) noexcept;
  Mapper& operator=(Mapper&&) noexcept;

  /// The robot is near `pose`, as after `initialpose`. The next scan is matched there.
  void set_pose(const PlanarPose& pose);

  /// Takes the next scan. `sensor` is the pose of the laser in the base, `odometry` that of the base in odom when the
  /// scan was made.
  void update(const Scan& scan, const PlanarPose& sensor, const UncertainPose& odometry);

  /// Return the pose of the base at the last scan, and the pose of odom, both in the map.
  PlanarPose pose() const;
  PlanarPose correction() const;
  Anchor anchor() const;

  /// Returns, of the points of the last matched scan that match or contradict the map, the part that match; 1 without
  /// any.
  double matched() const noexcept;

  /// Returns whether the last scan fits the map. One that does not changes nothing.
  bool fits() const noexcept;

  /// Returns why it does not, in one sentence; "" if it does.
  std::string reason() const;

  /// Returns the map up to now; cells that no ray has touched are unknown.
  Grid grid() const;

  /// Returns the map as a graph. It grows with what is seen, not with time.
  const PoseGraph& graph() const noexcept;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace robot_control::navigation

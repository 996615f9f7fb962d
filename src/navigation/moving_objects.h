#pragma once
/// Detects moving objects from two scans of one laser, and predicts their positions.
///
/// Neighbouring rays whose ends are within kMaxGap are one cluster. A cluster moves if kMinNewShare of its points lie
/// where space was free kScanInterval before. Space was free if the rays on both sides of the point passed it. One ray
/// is not enough: a ray that grazes a wall also passes the next point of that wall. Walls that come into sight do not
/// move, because the view was blocked before. The velocity is that of the middle of the points between the two scans. A
/// cluster that is larger than kMaxSize counts as static.

#include <deque>
#include <vector>

#include "navigation/costmap.h"

namespace robot_control::navigation {

inline constexpr double kPredictionTime = 3;  ///< s; at 0.5 m/s the outline crosses the path of a cart in 2.5 s

struct MovingObject {
  std::vector<Point> points;  ///< m
  Point velocity;             ///< m/s
};

class MovingObjects {
 public:
  /// Returns the moving objects, in the frame of `sensor`, which has to be fixed: the odometry's. `now` in s.
  std::vector<MovingObject> update(const Scan& scan, const PlanarPose& sensor, double now);

 private:
  struct Cluster {
    std::vector<Point> points;
    Point middle;
  };
  struct ScanRecord {
    Scan scan;
    PlanarPose sensor;
    double at = 0;  // s
    std::vector<Cluster> clusters;
  };
  static std::vector<Cluster> clusters_of(const Scan& scan, const PlanarPose& sensor);

  std::deque<ScanRecord> records_;
};

/// Return points or objects, given in the axes of `frame`, in the frame in which `frame` is given.
std::vector<Point> composed(const PlanarPose& frame, std::vector<Point> points);
std::vector<MovingObject> composed(const PlanarPose& frame, std::vector<MovingObject> objects);

/// Returns the points that the objects, given in base axes, occupy, and those that they will occupy within
/// kPredictionTime. The latter are left out for an object that will touch the outline at its present pose: waiting
/// there is no safer than driving on.
std::vector<Point> predicted_points(const std::vector<MovingObject>& objects, const Footprint& footprint);

/// The costmap gets the predicted and present points of these objects for paths. It loses the marks of the present
/// ones, because the LocalController has their velocities. Objects and `base` are given in its frame.
void foresee(const std::vector<MovingObject>& objects, const PlanarPose& base, Costmap& costmap);

}  // namespace robot_control::navigation

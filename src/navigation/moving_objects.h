#pragma once
/// Objects in motion: two scans of one laser show them, and where they will be.
///
/// Neighbouring rays whose ends are within kGap are one cluster. A cluster moves if kNew of its points lie where the
/// laser looked through kApart before. There the rays on both sides went on: one alone passes the next point of a wall
/// along which it grazes. Walls that come into sight do not move: there the view was blocked. The velocity is that of
/// the middle of the points between the two scans. A cluster that is larger than kLargest is taken to stand.

#include <deque>
#include <vector>

#include "navigation/costmap.h"

namespace robot_control::navigation {

inline constexpr double kForesight = 3;  ///< s; at 0.5 m/s the outline crosses the way of a cart in 2.5 s

struct MovingObject {
  std::vector<Point> points;  ///< m
  Point velocity;             ///< m/s
};

class MovingObjects {
 public:
  /// Returns what moves, in the frame of `sensor`, which has to be at rest: the odometry's. `now` in s.
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

/// Returns points, given in the axes of `base`, in the frame in which `base` is given.
std::vector<Point> placed(std::vector<Point> points, const PlanarPose& base);

/// Returns the objects in the axes of `base`, which is given in their frame.
std::vector<MovingObject> objects_seen_from(std::vector<MovingObject> objects, const PlanarPose& base);

/// Returns the places that the objects, given in base axes, will take within kForesight. Those that touch the standing
/// outline on their way are left out: where it stands is no better than what lies ahead.
std::vector<Point> places_ahead(const std::vector<MovingObject>& objects, const Footprint& footprint);

}  // namespace robot_control::navigation

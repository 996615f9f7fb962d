#pragma once
/// Movers are things in motion. Two scans of one laser show them, and where they will be.
///
/// Neighbouring rays whose ends are within kGap are one thing. A thing moves if kNew of its points lie where the laser
/// looked through kApart before. There the rays on both sides went on: one alone passes the next point of a wall along
/// which it grazes. Walls that come into sight do not move: there the view was blocked. The velocity is that of the
/// middle of the points between the two scans. A thing that is larger than kLargest is taken to stand.

#include <deque>
#include <vector>

#include "navigation/costmap.h"

namespace robot_control {

inline constexpr double kForesight = 3;  ///< s; at 0.5 m/s the outline crosses the way of a cart in 2.5 s

struct Mover {
  std::vector<Point> points;  ///< m
  Point velocity;             ///< m/s
};

class Movers {
 public:
  /// Returns what moves, in the frame of `sensor`, which has to be at rest: the odometry's. `now` in s.
  std::vector<Mover> update(const Scan& scan, const PlanarPose& sensor, double now);

 private:
  struct Thing {
    std::vector<Point> points;
    Point middle;
  };
  struct View {
    Scan scan;
    PlanarPose sensor;
    double at = 0;  // s
    std::vector<Thing> things;
  };
  static std::vector<Thing> things_of(const Scan& scan, const PlanarPose& sensor);

  std::deque<View> views_;
};

/// Returns points, given in the axes of `base`, in the frame in which `base` is given.
std::vector<Point> placed(std::vector<Point> points, const PlanarPose& base);

/// Returns the movers in the axes of `base`, which is given in their frame.
std::vector<Mover> movers_seen_from(std::vector<Mover> movers, const PlanarPose& base);

/// Returns the places that the movers, given in base axes, will take within kForesight. Those that touch the standing
/// outline on their way are left out: where it stands is no better than what lies ahead.
std::vector<Point> places_ahead(const std::vector<Mover>& movers, const Footprint& footprint);

}  // namespace robot_control

#pragma once
/// A CollisionGuard derives the free distance ahead of the robot from its lasers, whatever moves the robot. It reads no
/// clock and knows no ROS.
///
/// Every point counts that a laser sees or remembers (scan_memory.h), and moving objects where they will be.
/// The distance is the shortest one along two arcs: that of the measured motion, and that of the requested one, which
/// begins next. A measured motion below kMovingSpeed does not count, so that a robot at a wall may be driven away from
/// it.

#include <map>
#include <string>
#include <utility>

#include "navigation/guard/motion_clearance.h"
#include "navigation/guard/scan_memory.h"

namespace robot_control::navigation {

inline constexpr double kMovingSpeed = 0.05;  ///< m/s of the outline; the robot stops from it within 2.5 mm

struct GuardVerdict {
  double clearance = 0;           ///< m, at most kLookAhead
  std::string problem;            ///< why the lasers are not trusted; then the clearance is 0
  std::optional<Point> obstacle;  ///< in base axes: what ends the free way
};

class CollisionGuard {
 public:
  explicit CollisionGuard(Footprint footprint) : footprint_(std::move(footprint)) {}

  /// Takes a scan of this laser, which is at `mount` on the base; the base was at `base` in odom. `stamp` in s.
  void insert(const std::string& laser, const Scan& scan, const PlanarPose& mount, const PlanarPose& base,
              double stamp);

  /// `base` is the pose in odom at `now`, in s of the clock of stamps.
  GuardVerdict check(const PlanarPose& base, const PlanarMotion& measured, const PlanarMotion& requested,
                     double now) const;

  void set_footprint(Footprint footprint) { footprint_ = std::move(footprint); }
  const Footprint& footprint() const noexcept { return footprint_; }

 private:
  struct Laser {
    ScanMemory memory;
    MovingObjects moving;
    std::vector<MovingObject> objects;  // in odom, at the stamp
    double stamp = 0;                   // s
  };

  Footprint footprint_;
  std::map<std::string, Laser> lasers_;
};

}  // namespace robot_control::navigation

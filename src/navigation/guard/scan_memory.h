#pragma once
/// A ScanMemory holds what one laser has seen, in odom, and doubts scans that contradict it.
///
/// A ray without an echo (Scan::hit) is evidence of nothing, neither of an obstacle nor of free space. Points beyond
/// kSureEcho·range_max count as out of view, because noise may take their echo. A point that was seen is forgotten
///
///   at once          if the rays on both sides have echoes kMinPassing behind it, or one of them has its echo there,
///                    which then takes its place
///   after kRecall    if it is hidden, if it may have moved, or if it has vanished
///   after kLookAhead that the base has driven, if it is out of the field of view
///   never            if it has vanished, while the scan is blind in part
///
/// A moving object leaves an echo within kMaxObjectSpeed times the time. A point vanishes if a ray beside it has no
/// echo, and there is none as near as that. It is hidden again once both rays have echoes: one ray may drop out. A scan
/// is blind in part if vanished points cover kDoubtfulAngle. Then no new points are remembered.
///
/// A scan is frozen in part if rays over kDoubtfulAngle report the bits of an earlier scan. The robot has moved by
/// kFrozenMotion since, and what that scan saw would now be nearer or farther along them by kFrozenRange.

#include <string>
#include <vector>

#include "navigation/guard/motion_clearance.h"
#include "navigation/scan_watch.h"

namespace robot_control::navigation {

inline constexpr double kSureEcho = 0.95;        ///< of range_max
inline constexpr double kRecall = 1.0;           ///< s
inline constexpr double kMaxObjectSpeed = 2.5;   ///< m/s
inline constexpr double kFrozenRange = 0.03;     ///< m, three deviations of the noise
inline constexpr double kDoubtfulAngle = 0.175;  ///< rad, 10°: at 0.5 m the width of a leg

class ScanMemory {
 public:
  /// Takes a scan whose laser was at `mount` on the base, and the base at `base` in odom. `stamp` in s. After a jump of
  /// the pose or the stamp it is empty. A correction that odom shows slowly moves what was seen; its covariance does
  /// not tell, because it mostly shrinks without one.
  void update(const Scan& scan, const PlanarPose& mount, const PlanarPose& base, double stamp,
              const Footprint& footprint);

  /// Returns why the newest scan is doubted; "" if it is not.
  const std::string& problem() const noexcept { return problem_; }

  /// Returns what is seen, and what was seen and is not forgotten, in odom. Parts of the robot are left out.
  const std::vector<Point>& points() const noexcept { return points_; }

 private:
  struct Memory {
    Point at;
    double seen = 0;    // s
    double driven = 0;  // m, when it was seen
    bool vanished = false;
  };
  enum class Fate { kForgotten, kKept, kVanished };
  Fate fate_of(const Memory& memory, const Scan& scan, const PlanarPose& sensor, double stamp) const;
  double frozen_angle(const Scan& scan, const PlanarPose& sensor) const;

  std::vector<Memory> memories_;
  std::vector<Point> points_;
  Scan reference_;  // the last one that was compared
  PlanarPose reference_sensor_;
  PlanarPose base_;
  double stamp_ = -1e9;  // s
  double driven_ = 0;    // m, of the base
  Point counted_;        // where that was counted last
  bool blind_ = false;
  std::string problem_;
};

}  // namespace robot_control::navigation

#pragma once
/// Zones are a mask beside the map, as the filter masks of Nav2. Its file has the format of map_file.h, in the frame of
/// the map, with a resolution and an origin of its own. The value of a cell means
///
///   100 %        keep-out zone: paths and the LocalController do not enter it (costmap.h)
///   1 … 99 %     speed zone, with `mode: scale`. The base's origin moves at (100 − value) % of the robot's largest
///                speed at most, as with Nav2's base 100 and multiplier −1
///   0, unknown   no zone

#include "navigation/footprint.h"
#include "navigation/grid.h"

namespace robot_control::navigation {

inline constexpr double kZoneDelay = 0.3;  ///< s from a new limit to the speed

class Zones {
 public:
  Zones() = default;
  explicit Zones(Grid mask) : mask_(std::move(mask)) {}

  const Grid& mask() const noexcept { return mask_; }

  /// Returns the largest speed here, m/s, of a robot whose largest speed is `fastest`. If it brakes with half of
  /// `deceleration` m/s² after kZoneDelay, it enters no speed zone faster than allowed:
  ///
  ///   v² = v_zone² + deceleration · (distance − kZoneDelay · fastest)
  double speed_limit(Point at, double fastest, double deceleration) const;

 private:
  Grid mask_;  // without cells: there are no zones
};

}  // namespace robot_control::navigation

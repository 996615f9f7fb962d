#pragma once
/// Conversions to MRPT; headers of this folder alone may include it.

#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/poses/CPose2D.h>

#include <cmath>

#include "navigation/grid.h"
#include "navigation/scan.h"

namespace robot_control::navigation {

inline mrpt::poses::CPose2D mrpt_pose(const PlanarPose& pose) {
  return {pose.x, pose.y, pose.yaw};
}
inline PlanarPose planar(const mrpt::poses::CPose2D& pose) {
  return {pose.x(), pose.y(), pose.phi()};
}

/// MRPT spreads n rays over an aperture that is centred on the sensor's heading: (n − 1) steps, from the first ray to
/// the last one. The middle of a scan that is not symmetric, as that of a full turn, is put into the sensor's heading.
inline mrpt::obs::CObservation2DRangeScan mrpt_scan(const Scan& scan, const PlanarPose& sensor) {
  mrpt::obs::CObservation2DRangeScan result;
  const std::size_t count = scan.ranges.size();
  const double aperture = static_cast<double>(count - 1) * scan.angle_increment;
  result.aperture = static_cast<float>(std::abs(aperture));
  result.rightToLeft = scan.angle_increment > 0;
  result.maxRange = static_cast<float>(scan.range_max);
  result.stdError = 0.01f;
  result.sensorPose =
      mrpt::poses::CPose3D(mrpt::poses::CPose2D(sensor.x, sensor.y, sensor.yaw + scan.angle_min + aperture / 2));
  result.resizeScan(count);
  for (std::size_t ray = 0; ray < count; ++ray) {
    const bool hit = scan.hit(scan.ranges[ray]);
    result.setScanRange(ray, hit ? scan.ranges[ray] : static_cast<float>(scan.range_max));
    result.setScanRangeValidity(ray, hit);
  }
  return result;
}

/// Returns the points of the scan in the axes of the base, at least `apart` m from each other.
inline mrpt::maps::CSimplePointsMap points_of(const mrpt::obs::CObservation2DRangeScan& scan, float apart) {
  mrpt::maps::CSimplePointsMap points;
  points.insertionOptions.minDistBetweenLaserPoints = apart;
  points.insertionOptions.isPlanarMap = true;
  points.insertObservation(scan);
  return points;
}

}  // namespace robot_control::navigation

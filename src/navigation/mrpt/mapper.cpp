#include "navigation/mrpt/mapper.h"

#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/slam/CICP.h>

#include <utility>

#include "navigation/mrpt/mrpt_grid.h"
#include "navigation/mrpt/mrpt_scan.h"

namespace robot_control::navigation {
namespace {

using mrpt::maps::COccupancyGridMap2D;
using mrpt::maps::CSimplePointsMap;
using mrpt::poses::CPose2D;

constexpr float kResolution = 0.05f;                                    // m
constexpr double kMatchDistance = 0.05, kMatchTurn = 2 * M_PI / 180;    // m, rad between two matches
constexpr double kInsertDistance = 0.6, kInsertTurn = 15 * M_PI / 180;  // m, rad between two scans of the map
constexpr float kMinPointDistance = 0.03f;  // m; nearer to a point of the map another one adds size alone
constexpr double kMinMatched = 0.4;         // part of the points, below which a match is no match

/// Returns whether the robot has moved by so much between two poses.
bool moved(const CPose2D& from, const CPose2D& to, double distance, double turn) {
  const CPose2D step = to - from;
  return step.norm() > distance || std::abs(step.phi()) > turn;
}

mrpt::slam::CICP matcher() {
  mrpt::slam::CICP icp;
  icp.options.maxIterations = 60;
  icp.options.thresholdDist = 0.2;
  icp.options.thresholdAng = 5 * M_PI / 180;
  icp.options.smallestThresholdDist = 0.02;
  icp.options.corresponding_points_decimation = 1;
  icp.options.onlyUniqueRobust = true;  // else the many points of near walls outweigh those that hold the heading
  icp.options.skip_cov_calculation = true;
  return icp;
}

}  // namespace

struct Mapper::Parts {
  CSimplePointsMap points;
  COccupancyGridMap2D grid{-1, 1, -1, 1, kResolution};
  mrpt::slam::CICP icp = matcher();
  CPose2D correction, odometry;
  CPose2D matched_at, inserted_at;  // in odom, in the map
  double matched = 1;
  bool first = true;

  CPose2D pose() const { return correction + odometry; }

  void insert(const mrpt::obs::CObservation2DRangeScan& scan) {
    const mrpt::poses::CPose3D at(pose());
    CSimplePointsMap seen = points_of(scan, 0.05f);
    seen.changeCoordinatesReference(at);
    std::vector<bool> known(seen.size());
    for (std::size_t i = 0; i < known.size() && !points.empty(); ++i) {
      float x = 0, y = 0;
      seen.getPoint(i, x, y);
      known[i] = points.squareDistanceToClosestCorrespondence(x, y) < kMinPointDistance * kMinPointDistance;
    }
    seen.applyDeletionMask(known);
    points += seen;
    grid.insertObservation(scan, at);
    inserted_at = pose();
  }

  void match(const mrpt::obs::CObservation2DRangeScan& scan) {
    const CSimplePointsMap seen = points_of(scan, 0.02f);
    mrpt::slam::CICP::TReturnInfo info;
    const auto found = icp.Align(&points, &seen, pose(), info);
    matched = info.goodness;
    matched_at = odometry;
    if (matched >= kMinMatched) correction = found->getMeanVal() + -odometry;
  }
};

Mapper::Mapper() : parts_(std::make_unique<Parts>()) {}
Mapper::~Mapper() = default;
Mapper::Mapper(Mapper&&) noexcept = default;
Mapper& Mapper::operator=(Mapper&&) noexcept = default;

Mapper::Mapper(const Grid& saved, const PlanarPose& pose) : Mapper() {
  Parts& parts = *parts_;
  Grid aligned = saved;
  const PlanarPose moved = align(aligned);
  parts.correction = mrpt_pose({pose.x - moved.x, pose.y - moved.y, pose.yaw});
  parts.grid = mrpt_grid(aligned);
  parts.points = wall_points(aligned);
}

void Mapper::update(const Scan& scan, const PlanarPose& sensor, const PlanarPose& odometry) {
  Parts& parts = *parts_;
  const mrpt::obs::CObservation2DRangeScan observation = mrpt_scan(scan, sensor);
  parts.odometry = mrpt_pose(odometry);
  const bool first = std::exchange(parts.first, false);
  if (first) parts.correction = parts.correction + -parts.odometry;
  if (parts.points.empty()) return parts.insert(observation);
  if (first) return parts.match(observation);
  if (moved(parts.matched_at, parts.odometry, kMatchDistance, kMatchTurn)) parts.match(observation);
  if (parts.matched >= kMinMatched && moved(parts.inserted_at, parts.pose(), kInsertDistance, kInsertTurn))
    parts.insert(observation);
}

PlanarPose Mapper::pose() const noexcept {
  return planar(parts_->pose());
}
PlanarPose Mapper::correction() const noexcept {
  return planar(parts_->correction);
}
double Mapper::matched() const noexcept {
  return parts_->matched;
}
std::size_t Mapper::points() const noexcept {
  return parts_->points.size();
}
bool Mapper::fits() const noexcept {
  return parts_->matched >= kMinMatched;
}
std::string Mapper::reason() const {
  if (fits()) return "";
  return "the scan matches the map in " + std::to_string(std::lround(100 * parts_->matched)) +
         " % of its points, less than " + std::to_string(std::lround(100 * kMinMatched)) +
         " %: drive back to a mapped area, or load the map again";
}
Grid Mapper::grid() const {
  return grid_of(parts_->grid);
}

}  // namespace robot_control::navigation

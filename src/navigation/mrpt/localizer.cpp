#include "navigation/mrpt/localizer.h"

#include <mrpt/bayes/CParticleFilter.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPosePDFGaussian.h>
#include <mrpt/random/RandomGenerators.h>
#include <mrpt/slam/CMonteCarloLocalization2D.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "navigation/mrpt/mrpt_grid.h"
#include "navigation/mrpt/mrpt_scan.h"

namespace robot_control::navigation {
namespace {

using mrpt::poses::CPose2D;

constexpr unsigned kMinParticles = 300, kMaxParticles = 20000;
constexpr std::size_t kGlobalParticles = 20000;
constexpr double kFreeFrom = 0.7;                // probability from which a cell is free for a global start
const mrpt::maps::TMatchingRatioParams kAtWall;  // 0.1 m: a point that near to a wall is explained by the map
constexpr double kFits = 0.75;        // part of the points that must be explained; a fifth of them may be moved
constexpr double kSmoothing = 0.05;   // of each new part of explained points, per scan: 2 s at 10 Hz
constexpr int kMaxProofScans = 60;    // scans within which a place that a search found must fit, else it goes on
constexpr double kSmallSpread = 0.3;  // m, below which a search has found the place
// m, rad, between two updates: wheels that slip do more than the odometry knows.
constexpr double kMinStep = 0.02, kMinTurn = 0.02;
constexpr double kMapDeviation = 0.02;       // m: a wall lies anywhere in its cell, and the map has errors of its own
constexpr double kHeadingDeviation = 0.005;  // rad, likewise

mrpt::bayes::CParticleFilter filter() {
  mrpt::bayes::CParticleFilter result;
  result.m_options.PF_algorithm = mrpt::bayes::CParticleFilter::pfStandardProposal;
  result.m_options.adaptiveSampleSize = true;
  return result;
}

/// Returns the map with the likelihood of a range whose deviation is `deviation` m.
std::shared_ptr<mrpt::maps::COccupancyGridMap2D> likelihood_field(const Grid& grid, float deviation) {
  auto map = std::make_shared<mrpt::maps::COccupancyGridMap2D>(mrpt_grid(grid));
  map->likelihoodOptions.likelihoodMethod = mrpt::maps::COccupancyGridMap2D::lmLikelihoodField_Thrun;
  map->likelihoodOptions.LF_decimation = 10;
  map->likelihoodOptions.LF_stdHit = deviation;
  map->likelihoodOptions.LF_maxRange = 30;
  return map;
}

}  // namespace

const char* name_of(Localization state) noexcept {
  constexpr const char* kNames[] = {"no pose", "searching", "localized", "lost"};
  return kNames[static_cast<int>(state)];
}

struct Localizer::Parts {
  std::shared_ptr<mrpt::maps::COccupancyGridMap2D> map, wide;  // with a likelihood for tracking, and for a search
  mrpt::maps::CSimplePointsMap walls;
  mrpt::slam::CMonteCarloLocalization2D particles{1};
  mrpt::bayes::CParticleFilter pf = filter();
  Localization state = Localization::kNoPose;
  UncertainPose updated;  // the odometry at the last update
  PlanarPose odometry;    // at the last scan
  UncertainPose pose;     // of the particles, at the last update
  bool first = true;      // the next scan updates; before it nothing says where the odometry of a set pose is
  double explained = 0;   // smoothed
  double last_explained = 0;
  double spread = 0;   // m
  PlanarPose aligned;  // of the frame of all these in that of the given map
  int settled = 0;     // scans since the particles of a search came together

  /// Returns the pose at the last scan.
  CPose2D now() const { return mrpt_pose(pose.mean) + (mrpt_pose(odometry) - mrpt_pose(updated.mean)); }

  void measure_spread() {
    const auto [covariance, mean] = particles.getCovarianceAndMean();
    pose.mean = planar(CPose2D(mean));
    pose.covariance = covariance.asEigen();
    spread = std::sqrt(pose.covariance(0, 0) + pose.covariance(1, 1));
  }

  void begin(Localization next) {
    state = next;
    first = true;
    explained = next == Localization::kSearching ? 0 : 1;  // a search has to prove its place
    settled = 0;
    measure_spread();
  }

  void search() {
    particles.resetUniformFreeSpace(map.get(), kFreeFrom, kGlobalParticles);
    begin(Localization::kSearching);
  }

  void update_state() {
    const bool fits = explained > kFits;
    settled = spread < kSmallSpread ? settled + 1 : 0;
    if (state == Localization::kLocalized && !fits) state = Localization::kLost;
    if (state != Localization::kLocalized && fits && settled > 0) state = Localization::kLocalized;
    if (state == Localization::kSearching && settled > kMaxProofScans) search();
  }

  void filter_step(const mrpt::obs::CObservation2DRangeScan& scan, const UncertainPose& to) {
    const CPose2D step = mrpt_pose(to.mean) - mrpt_pose(updated.mean);
    const Eigen::Matrix3d noise = at_least(growth(updated, to), {kMinStep, kMinStep, kMinTurn});
    mrpt::obs::CActionRobotMovement2D motion;
    motion.rawOdometryIncrementReading = step;
    motion.poseChange = mrpt::poses::CPosePDFGaussian::Create(step, mrpt::math::CMatrixDouble33(noise));
    mrpt::obs::CActionCollection actions;
    actions.insert(motion);
    mrpt::obs::CSensoryFrame frame;
    frame.insert(std::make_shared<mrpt::obs::CObservation2DRangeScan>(scan));
    const bool searching = state == Localization::kSearching;
    particles.options.metricMap = searching ? wide : map;
    particles.options.KLD_params.KLD_minSampleSize = searching ? kGlobalParticles : kMinParticles;
    pf.executeOn(particles, &actions, &frame);
    updated = to;
    measure_spread();
  }
};

Localizer::Localizer(const Grid& map, std::uint32_t seed) : parts_(std::make_unique<Parts>()) {
  Parts& parts = *parts_;
  Grid grid = map;
  parts.aligned = align(grid);
  parts.map = likelihood_field(grid, 0.1f);
  parts.wide = likelihood_field(grid, 0.2f);  // few of the particles of a search are near the place
  parts.walls = wall_points(grid);
  if (parts.walls.empty()) throw std::invalid_argument("the map has no occupied cell, so no scan can match it");
  if (std::ranges::count(map.cells, kFreeCell) == 0)
    throw std::invalid_argument("the map has no free cell for the robot");
  parts.particles.options.KLD_params.KLD_maxSampleSize = kMaxParticles;
  mrpt::random::getRandomGenerator() = {seed};  // randomize() keeps the second number of the last normal pair
}
Localizer::~Localizer() = default;
Localizer::Localizer(Localizer&&) noexcept = default;
Localizer& Localizer::operator=(Localizer&&) noexcept = default;

void Localizer::set_pose(const UncertainPose& pose) {
  std::vector<mrpt::math::CVectorDouble> drawn;
  const Eigen::Matrix3d covariance = at_least(pose.covariance, {kMinStep, kMinStep, kMinTurn});
  const PlanarPose& aligned = parts_->aligned;
  const CPose2D mean(pose.mean.x - aligned.x, pose.mean.y - aligned.y, pose.mean.yaw);
  mrpt::poses::CPosePDFGaussian(mean, mrpt::math::CMatrixDouble33(covariance)).drawManySamples(2000, drawn);
  parts_->particles.resetDeterministic({}, drawn.size());
  for (std::size_t i = 0; i < drawn.size(); ++i)
    parts_->particles.m_particles[i].d = {drawn[i][0], drawn[i][1], drawn[i][2]};
  parts_->begin(Localization::kLocalized);
}

void Localizer::search() {
  parts_->search();
}

bool Localizer::update(const Scan& scan, const PlanarPose& sensor, const UncertainPose& odometry) {
  Parts& parts = *parts_;
  if (parts.state == Localization::kNoPose) return false;
  if (parts.first) parts.updated = odometry;
  parts.odometry = odometry.mean;
  const CPose2D step = mrpt_pose(odometry.mean) - mrpt_pose(parts.updated.mean);
  const bool moved = step.norm() > kUpdateDistance || std::abs(step.phi()) > kUpdateTurn;
  const mrpt::obs::CObservation2DRangeScan observation = mrpt_scan(scan, sensor);
  const bool updated = parts.first || moved;
  if (updated) parts.filter_step(observation, odometry);
  const mrpt::maps::CSimplePointsMap seen = points_of(observation, 0);
  const mrpt::poses::CPose3D at(parts.now());
  parts.last_explained = seen.empty() ? 0 : parts.walls.compute3DMatchingRatio(&seen, at, kAtWall);
  parts.explained += kSmoothing * (parts.last_explained - parts.explained);
  parts.first = false;
  parts.update_state();
  return updated;
}

Localization Localizer::state() const noexcept {
  return awaits_scan() ? Localization::kNoPose : parts_->state;
}

bool Localizer::awaits_scan() const noexcept {
  return parts_->first && parts_->state == Localization::kLocalized;
}

std::string Localizer::reason() const {
  const auto cm = [](double m) { return std::to_string(std::lround(100 * m)) + " cm"; };
  if (awaits_scan()) return "a pose was set, and no scan was used since";
  switch (parts_->state) {
    case Localization::kLocalized:
      return "";
    case Localization::kNoPose:
      return "no pose yet: set one (initialpose) or call global_localization";
    case Localization::kSearching:
      return "searching in the whole map: the matching poses differ by " + cm(parts_->spread) + "; drive on";
    case Localization::kLost:
      break;
  }
  return "the pose is lost: " + std::to_string(std::lround(100 * parts_->explained)) +
         " % of the scan matches the map there, less than " + std::to_string(std::lround(100 * kFits)) +
         " %; set the pose (initialpose) or call global_localization";
}

UncertainPose Localizer::pose() const {
  UncertainPose result{composed(parts_->aligned, planar(parts_->now())), parts_->pose.covariance};
  const Eigen::Vector3d map(kMapDeviation, kMapDeviation, kHeadingDeviation);
  result.covariance.diagonal() += map.cwiseProduct(map);
  return result;
}

PlanarPose Localizer::correction() const {
  return planar(mrpt_pose(pose().mean) + -mrpt_pose(parts_->odometry));
}

double Localizer::explained() const noexcept {
  return parts_->last_explained;
}

std::vector<PlanarPose> Localizer::particles() const {
  std::vector<PlanarPose> result;
  for (const auto& particle : parts_->particles.m_particles)
    result.push_back(composed(parts_->aligned, {particle.d.x, particle.d.y, particle.d.phi}));
  return result;
}

}  // namespace robot_control::navigation

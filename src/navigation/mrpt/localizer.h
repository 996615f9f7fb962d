#pragma once
/// A Localizer finds the robot in a given map by a particle filter: MRPT's CMonteCarloLocalization2D with the
/// likelihood field of the grid (S. Thrun, W. Burgard, D. Fox, Probabilistic Robotics, 2005, sections 6.4 and 8.3).
///
/// Particles move with the odometry and with its own uncertainty: between two updates its covariance Σ grows by
///
///   Q = Rᵀ(Σ₂ − F Σ₁ Fᵀ)R    F: derivative of the composed pose by the first one, R: rotation of the first one
///
/// so that they spread no more than the odometry says. Scans are used after a motion of kUpdateDistance or kUpdateTurn.
///
/// The number of particles adapts to their spread (KLD sampling). A global start begins with kGlobalParticles all over
/// the free cells and keeps that many until the spread is small. The same seed and calls give the same poses.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "navigation/grid.h"
#include "navigation/scan.h"
#include "navigation/uncertain_pose.h"

namespace robot_control::navigation {

inline constexpr double kUpdateDistance = 0.1;  ///< m
inline constexpr double kUpdateTurn = 0.1;      ///< rad

enum class Localization {
  kNoPose,     ///< neither a pose nor a global start was given, or no scan was used since a pose was set
  kSearching,  ///< after a global start: the particles lie far apart
  kLocalized,
  kLost,  ///< the scans do not fit the map
};

/// Returns "no pose", "searching", "localized" or "lost".
const char* name_of(Localization state) noexcept;

class Localizer {
 public:
  /// Throws std::invalid_argument for a map without a free or without an occupied cell.
  Localizer(const Grid& map, std::uint32_t seed);
  ~Localizer();
  Localizer(Localizer&&) noexcept;
  Localizer& operator=(Localizer&&) noexcept;

  /// The robot is about here, as after `initialpose`. The next scan updates.
  void set_pose(const UncertainPose& pose);

  /// The robot may be anywhere in the free cells.
  void search();

  /// Takes the next scan. `sensor` is the pose of the laser in the base, `odometry` that of the base in odom when the
  /// scan was made, with its covariance. Returns whether it moved the particles.
  bool update(const Scan& scan, const PlanarPose& sensor, const UncertainPose& odometry);

  Localization state() const noexcept;

  /// Returns whether a pose was set and no scan was used since, which is kNoPose.
  bool awaits_scan() const noexcept;

  /// Returns why it is not kLocalized, in one sentence; "" if it is.
  std::string reason() const;

  /// Returns the pose at the last scan, valid while kLocalized. Its covariance is that of the particles and that of the
  /// map's own cells.
  UncertainPose pose() const;

  /// Returns the pose of odom in the map. Valid while kLocalized.
  PlanarPose correction() const;

  /// Returns the part of the last scan's points that lie at a wall of the map.
  double explained() const noexcept;

  std::vector<PlanarPose> particles() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace robot_control::navigation

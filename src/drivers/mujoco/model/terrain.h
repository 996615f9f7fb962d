#pragma once
/// An uneven floor before the robot: boxes on the ground of the scene, by parameters and the seed of the plant.
///
/// The axes of a course have their origin at the site `start` of the scene. Their x axis is turned by `heading` from
/// that of the site. Boxes are kWidth wide, and lean by kLean. Between parallel faces of two boxes MuJoCo 2.2 may find
/// a contact that throws the robot away. The first one begins `distance` ahead of the origin:
///
///   stairs  `count` steps of `height`, each `length` deep, a landing of kLanding, and as many steps down; a step is one
///   rough   `count` rows of square tiles of side `length`, each between 0 and `height` high at random
///   bars    `count` bars of a square section of `height`, `length` from one to the next
///   gap     a gap `length` wide and kDepth deep between two platforms; the robot starts on the first one
///   ice     a patch kPatch high of little friction, `length` long

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "drivers/mujoco/mujoco_plant_parameters.h"

namespace robot_control {

class Terrain {
 public:
  static constexpr double kWidth = 8;           ///< m
  static constexpr double kLean = 1e-5;         ///< rad
  static constexpr double kTiles = 4;           ///< m, width of all tiles
  static constexpr double kLanding = 1.5;       ///< m
  static constexpr double kPlatform = 4;        ///< m, length of each platform beside a gap
  static constexpr double kDepth = 0.3;         ///< m
  static constexpr double kIceFriction = 0.15;  ///< of a floor, under rubber
  static constexpr double kPatch = 0.002;       ///< m

  static constexpr std::size_t kMaxBoxes = 2000;

  /// Throws DriverError if the parameters give no box, or more than kMaxBoxes.
  Terrain(const TerrainParameters& parameters, std::uint64_t seed);

  /// Height of the ground at a place in the axes of the site `start`, in m from its x-y plane without a course.
  double height(double x, double y) const noexcept;

  /// Height in m of the place on which the robot starts.
  double start_height() const noexcept { return height(0, 0); }

  /// MJCF of the boxes in the body world; `start` x y z, quaternion w x y z: the pose of the site.
  std::string mjcf(const std::array<double, 7>& start) const;

 private:
  struct Box {
    Eigen::Vector2d from, to;  ///< m, axes of the course
    double height;             ///< m
  };
  void lay(const TerrainParameters& parameters, std::uint64_t seed);
  void add(double from, double to, double height, double left = kWidth / 2, double right = -kWidth / 2);

  double heading_, friction_;
  std::vector<Box> boxes_;
};

}  // namespace robot_control

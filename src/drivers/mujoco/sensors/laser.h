#pragma once
/// A Laser measures what a laser scanner on a link of the robot sees of the scene, from a true state. It has a MuJoCo
/// state of its own, so that an ordinary thread can cast the rays while the plant goes on.
///
///   range = d + noise · w    d: distance to the first shape along the ray, w: a standard normal number
///
/// A ray comes back from shapes of the scene. It passes through the robot and through glass (geom group kGlassGroup).
/// It does not come back from black shapes (kBlackGroup), from beyond range_max, or if it drops out.
///
/// Random numbers depend on the plant's seed and the cycle alone: the same state gives the same bits. Bodies on paths
/// are where they are at this time (mocap_paths.h). Other bodies of the scene that move are seen where they begin.

#include <array>

#include "drivers/laser_scan.h"
#include "drivers/mujoco/model/mocap_paths.h"
#include "drivers/mujoco/model/mujoco_model.h"
#include "signals/truth_frame.h"

namespace robot_control {

inline constexpr int kGlassGroup = 1, kBlackGroup = 2;  ///< geom groups of a scene

class Laser {
 public:
  /// `origin` is that of the truth: position, quaternion w x y z. `period` is in s. `model` outlives the laser. Throws
  /// DriverError if the robot has no such link or the angles or ranges are reversed.
  Laser(const MujocoModel& model, const MujocoPlantParameters& parameters, const std::array<double, 7>& origin,
        double period);

  LaserScan scan(const TruthFrame& truth);

 private:
  void place(const TruthFrame& truth);

  const MujocoModel& model_;
  LaserParameters laser_;
  std::uint64_t seed_;
  std::array<double, 7> origin_;
  double period_;
  int body_ = 0;
  Eigen::Isometry3d in_body_;
  MocapPaths paths_;
  MujocoData data_;
};

}  // namespace robot_control

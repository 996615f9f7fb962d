#pragma once
/// The simulated laser scanner (laser.h), in the map `laser` of the plant's block.

#include <cstdint>
#include <string>

#include "parameters/block.h"

namespace robot_control {

struct LaserParameters {
  double rate = 0;                  ///< Hz; 0: there is no laser
  std::string link = "laser_link";  ///< of the URDF; its x-y plane is that of the rays
  std::uint64_t rays = 360;
  double angle_min = -3.141592653589793;   ///< rad, of the first ray
  double angle_max = 3.141592653589793;    ///< rad, one step behind the last ray
  double range_min = 0.1, range_max = 12;  ///< m
  double noise = 0.01;                     ///< m, standard deviation of a range
  double drop_outs = 0.005;                ///< part of the rays that do not come back
};

inline Keys keys(LaserParameters& laser) {
  const std::string_view group = "laser";
  return {
      {"rate", &laser.rate, "Hz", 0.1, 100, kZeroIsOff | kPublishRate, {}, group},
      {"link", &laser.link, {}, 0, 0, 0, {}, group},
      {"rays", &laser.rays, {}, 1, 10000, 0, {}, group},
      {"angle_min", &laser.angle_min, "rad", -6.3, 6.3, 0, {}, group},
      {"angle_max", &laser.angle_max, "rad", -6.3, 6.3, 0, {}, group},
      {"range_min", &laser.range_min, "m", 0, 1000, 0, {}, group},
      {"range_max", &laser.range_max, "m", 0.01, 1000, 0, {}, group},
      {"noise", &laser.noise, "m", 0, 10, 0, {}, group},
      {"drop_outs", &laser.drop_outs, {}, 0, 1, 0, {}, group},
  };
}

}  // namespace robot_control

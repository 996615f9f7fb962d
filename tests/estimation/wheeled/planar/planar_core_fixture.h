#pragma once
/// A planar core during a drive, and matrices of the textbook for comparison.

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>

#include "estimation/wheeled/planar/planar_core.h"

namespace robot_control {

using CoreMatrix = PlanarCore::Matrix;
using CoreVector = PlanarCore::Vector;

/// The values of the error state; the gyro's scale has none and is 0.
inline CoreVector values_of(const PlanarCore& core) {
  CoreVector x = CoreVector::Zero();
  x[PlanarCore::kX] = core.pose().x;
  x[PlanarCore::kY] = core.pose().y;
  x[PlanarCore::kYaw] = core.pose().yaw;
  x[PlanarCore::kBias] = core.bias();
  x[PlanarCore::kRatio] = core.ratio();
  x[PlanarCore::kBase] = core.base();
  x[PlanarCore::kOffset] = core.offset();
  x[PlanarCore::kAnchor] = core.pose().yaw - core.turned();
  return x;
}

/// Wheels that a turn does not drag over the floor.
inline PlanarCoreParams rolling_wheels() {
  return {.drags_wheels = false};
}

inline PlanarCoreParams core_without_noise() {
  return {.gyro_noise = 0, .gyro_bias_walk = 0, .drags_wheels = false};
}

/// Drives `blocks` of 1 s at 0.4 m/s with a turn of 0.3 rad, exact sensors and clocks. The rate alternates.
inline void practise(PlanarCore& core, int blocks) {
  constexpr int kSteps = 20;
  constexpr double kWay = 0.4;
  constexpr double kTurn = 0.3;
  constexpr double kBase = PlanarCoreParams{}.wheel_base;
  for (int block = 0; block < blocks; ++block) {
    const double sign = block % 2 == 0 ? 1 : -1;
    core.begin_block(kTurn - 0.2 * sign);
    for (int i = 0; i < kSteps; ++i) {
      core.turn_by_gyro(kTurn / kSteps, 1.0 / kSteps);
      core.roll(kWay / kSteps * std::cos(core.pose().yaw), kWay / kSteps * std::sin(core.pose().yaw), kTurn);
    }
    core.end_block(
        {.time = 1.0, .left = kWay - kBase * kTurn / 2, .right = kWay + kBase * kTurn / 2, .rate = kTurn + 0.2 * sign});
  }
}

}  // namespace robot_control

#pragma once
/// The pose in which a robot on legs stands and walks: level, its feet where it lies, its centre of gravity above their
/// middle.

#include <Eigen/Core>
#include <array>
#include <optional>

#include "machine/legs/leg_dynamics.h"
#include "machine/legs/leg_model.h"

namespace robot_control {

/// All vectors are in the base's axes.
struct NominalStance {
  std::array<Eigen::Vector3d, kLegs> feet{};  ///< m, their centres
  LeggedMotion motion;                        ///< at rest
  LeggedEquations equations;
  std::optional<LegPlace> short_leg;  ///< one that does not reach the ground

  /// Returns the inertia of the robot about its centre of gravity in kg·m².
  Eigen::Matrix3d inertia() const noexcept;
};

NominalStance nominal_stance(const LegModel& robot) noexcept;

/// Returns the height of the body above the one that lies level, in m.
double nominal_height(const LegModel& robot) noexcept;

}  // namespace robot_control

#pragma once
/// Distributes a force and a moment on the robot among its feet. The forces fᵢ at the feet pᵢ obey
///
///   Σ fᵢ = force    Σ pᵢ × fᵢ = moment
///
/// and of all such forces have the smallest Σ |fᵢ|²/wᵢ. A foot of weight 0 carries nothing, and none pulls.

#include <Eigen/Core>
#include <array>

#include "machine/legs/leg_model.h"

namespace robot_control {

struct FootForcesInput {
  std::array<Eigen::Vector3d, kLegs> feet{};         ///< m
  std::array<double, kLegs> share{};                 ///< wᵢ, 0 … 1; at least three above 0
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< N
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  ///< N·m, about the origin of `feet`
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();     ///< unit vector
};

/// Returns the matrix of v × x.
Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) noexcept;

/// Returns the forces in N.
std::array<Eigen::Vector3d, kLegs> foot_forces(const FootForcesInput& input) noexcept;

}  // namespace robot_control

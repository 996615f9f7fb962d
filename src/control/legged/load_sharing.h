#pragma once
/// Shares the weight among the feet. The vertical forces fᵢ balance weight and tipping about the centre of gravity,
///
///   Σ fᵢ = W    Σ fᵢ (xᵢ − x) = 0    Σ fᵢ (yᵢ − y) = 0
///
/// and of all such forces have the smallest Σ fᵢ²/wᵢ. A foot of weight 0 carries nothing.

#include <Eigen/Core>
#include <array>

#include "machine/legs/leg_model.h"

namespace robot_control {

struct LoadInput {
  std::array<Eigen::Vector2d, kLegs> feet{};  ///< m, horizontal, from the centre of gravity
  std::array<double, kLegs> share{};          ///< wᵢ, 0 … 1; at least three above 0
  double weight = 0;                          ///< N, W
};

/// Returns the forces in N, each at least 0.
std::array<double, kLegs> shared_loads(const LoadInput& input) noexcept;

}  // namespace robot_control

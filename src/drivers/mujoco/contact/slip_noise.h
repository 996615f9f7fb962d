#pragma once
/// SlipNoise computes the random slip of wheels behind each other, which scrub in every curve. The wheels of a side
/// roll as if their radius were (1 + ε) times the true one. Over the distance s of the rim, ε is an Ornstein–Uhlenbeck
/// process of the correlation length kLength. The difference between the distances of rim and ground therefore grows as
/// a random walk:
///
///   variance of ∫ε ds = σ² s  for s ≫ kLength        variance of ε = σ²/(2 kLength)
///
/// Here σ = wheel_slip_noise. The slip is zero unless sensor_errors is kField and the robot has more than one wheel per
/// side.

#include <array>
#include <cstdint>

#include "drivers/mujoco/mujoco_plant_parameters.h"
#include "drivers/mujoco/sensors/normal_stream.h"

namespace robot_control {

class SlipNoise {
 public:
  static constexpr double kLength = 0.1;  ///< m; in the recordings, slip is not correlated after half a second

  /// `wheels` is the number of drive wheels.
  SlipNoise(std::size_t wheels, const MujocoPlantParameters& parameters);

  void reset();

  /// Advances ε after the rims of `side` (0: left, 1: right) have rolled by `distance` m.
  void step(std::size_t side, double distance) noexcept;

  /// Returns ε of `side`.
  double error(std::size_t side) const noexcept { return error_[side]; }

 private:
  std::uint64_t seed_;
  double deviation_;  ///< standard deviation of ε
  std::array<NormalStream, 2> random_;
  std::array<double, 2> error_{};
};

}  // namespace robot_control

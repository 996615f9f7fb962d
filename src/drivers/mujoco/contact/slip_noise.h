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
#include "machine/wheeled/drive_train.h"

namespace robot_control {

class SlipNoise {
 public:
  static constexpr double kLength = 0.1;  ///< m; in the recordings, slip is not correlated after half a second

  SlipNoise(const DriveTrain& robot, const MujocoPlantParameters& parameters);

  void reset();

  /// Advances ε after the rims of `side` have rolled by `distance` m.
  void step(Side side, double distance) noexcept;

  /// Returns ε of `side`.
  double error(Side side) const noexcept { return error_[index(side)]; }

 private:
  static std::size_t index(Side side) noexcept { return side == Side::kLeft ? 0 : 1; }

  std::uint64_t seed_;
  double deviation_;  ///< standard deviation of ε
  std::array<NormalStream, 2> random_;
  std::array<double, 2> error_{};
};

}  // namespace robot_control

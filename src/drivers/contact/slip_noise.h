#pragma once
/// The random slip of wheels behind each other, which scrub in every curve: the wheels of a side roll as if their
/// radius were (1 + ε) times what it is. Over the way s of the rim, ε is an Ornstein–Uhlenbeck process of the
/// correlation length kLength, so that the difference between the way of the rim and that over the ground grows as a
/// random walk:
///
///   variance of ∫ε ds = σ² s  for s ≫ kLength        variance of ε = σ²/(2 kLength)
///
/// σ = wheel_slip_noise. Zero unless sensor_errors is kField and the robot has more than one wheel a side.

#include <array>
#include <cstdint>

#include "drivers/mujoco_plant_parameters.h"
#include "drivers/sensors/normal_stream.h"
#include "robot/robot_model.h"

namespace robot_control {

class SlipNoise {
 public:
  static constexpr double kLength = 0.1;  ///< m: after half a second the recordings' slip has forgotten itself

  SlipNoise(const RobotModel& robot, const MujocoPlantParameters& parameters);

  void reset();

  /// The rims of `side` went `way` m.
  void step(Side side, double distance) noexcept;

  /// ε of `side`.
  double error(Side side) const noexcept { return error_[index(side)]; }

 private:
  static std::size_t index(Side side) noexcept { return side == Side::kLeft ? 0 : 1; }

  std::uint64_t seed_;
  double deviation_;  ///< of ε
  std::array<NormalStream, 2> random_;
  std::array<double, 2> error_{};
};

}  // namespace robot_control

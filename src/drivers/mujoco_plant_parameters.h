#pragma once
/// What a user sets of the simulated machine: the world, the brakes, and everything in which the plant differs from
/// an ideal one. Random numbers come from `seed` alone: same seed, same bytes.

#include <cstdint>
#include <optional>
#include <string>

#include "drivers/sensors/errors.h"

namespace robot_control {

enum class TyreModel {
  kBrush,   ///< tyre.h: Coulomb friction that is right while sliding
  kNative,  ///< MuJoCo's own contact friction
};

struct MujocoPlantParameters : Errors {
  std::string scene;         ///< MJCF path: the world around the robot
  std::uint64_t seed = 0;    ///< of every random number in the plant
  std::uint64_t cycles = 0;  ///< the node ends by itself after so many cycles; 0 = never

  // The ground.
  TyreModel tyre = TyreModel::kBrush;
  std::optional<double> ground_friction;  ///< of all the ground; else each shape of the scene has its own
  double slope = 0;                       ///< rad, the whole world tilted: uphill along x of the start pose

  // The brakes, each wheel's. Left out: derived from robot and ground (brake_limits.h).
  std::optional<double> brake_effort;      ///< N·m
  std::optional<double> brake_damping;     ///< N·m·s/rad
  std::optional<double> brake_stiffness;   ///< N·m/rad, position hold below brake_hold_speed
  std::optional<double> brake_hold_speed;  ///< rad/s

  // Differences between the simulated robot and the model of its controller.
  double left_radius_error = 0;  ///< true radius = radius · (1 + error)
  double right_radius_error = 0;
  double wheel_base_error = 0;                         ///< true wheel base = wheel base · (1 + error)
  double wheel_friction_error = 0;                     ///< true dry friction of a wheel's joint, likewise
  double payload = 0;                                  ///< kg, fixed to the base
  double payload_x = 0, payload_y = 0, payload_z = 0;  ///< m, base axes

  // The motors, each wheel's; of the motor shaft, `gear_ratio` turns of it are one of the wheel (motor.h).
  double gear_ratio = 1;
  double rotor_inertia = 0;          ///< kg·m²
  double no_load_speed = 0;          ///< rad/s, where the torque has fallen to zero; 0: never
  double motor_friction = 0;         ///< N·m, Coulomb
  double motor_damping = 0;          ///< N·m·s/rad
  std::uint64_t actuator_delay = 0;  ///< cycles beyond the one of the bus

  // The sensors.
  bool contact_sensors = false;  ///< true: forces at wheels and casters (SensorFrame::contact_forces)

  // The battery (battery.h); it does not run down.
  double battery_voltage = 0;       ///< V, without load; 0: none is reported
  double battery_resistance = 0.1;  ///< Ω, of cells and cables

  // A push at the base's origin, base axes turned into the world at its start.
  double push_x = 0, push_y = 0, push_z = 0;  ///< N
  double push_start = 0;                      ///< s
  double push_duration = 0;                   ///< s; 0: none
};

}  // namespace robot_control

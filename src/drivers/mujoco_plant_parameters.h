#pragma once
/// These are the parameters of the simulated machine: the world, the brakes, and all deviations from an ideal plant.
/// Random numbers depend only on `seed`: the same seed gives the same bytes.

#include <cstdint>
#include <optional>
#include <string>

#include "drivers/sensors/errors.h"

namespace robot_control {

enum class TyreModel {
  kBrush,   ///< tyre.h: Coulomb friction that is also correct while sliding
  kNative,  ///< MuJoCo's own contact friction
};

struct MujocoPlantParameters : Errors {
  std::string scene;         ///< MJCF path: the world around the robot
  std::uint64_t seed = 0;    ///< seed of every random number in the plant
  std::uint64_t cycles = 0;  ///< number of cycles after which the node ends by itself; 0 = never

  // These members describe the ground.
  TyreModel tyre = TyreModel::kBrush;
  std::optional<double>
      ground_friction;  ///< friction of all the ground; without it each shape of the scene has its own
  double slope = 0;     ///< rad by which the whole world is tilted: uphill along x of the start pose

  // These members describe the brake of each wheel. Missing values are derived from robot and ground (brake_limits.h).
  std::optional<double> brake_effort;      ///< N·m
  std::optional<double> brake_damping;     ///< N·m·s/rad
  std::optional<double> brake_stiffness;   ///< N·m/rad, position hold below brake_hold_speed
  std::optional<double> brake_hold_speed;  ///< rad/s

  // These members are differences between the simulated robot and the model of its controller.
  double left_radius_error = 0;  ///< true radius = radius · (1 + error)
  double right_radius_error = 0;
  double wheel_base_error = 0;      ///< true wheel base = wheel base · (1 + error)
  double wheel_friction_error = 0;  ///< true dry friction of a wheel's joint = friction · (1 + error)
  double payload = 0;               ///< kg, fixed to the base
  double payload_x = 0, payload_y = 0, payload_z = 0;  ///< m, base axes

  // These members describe each wheel's motor at its shaft; `gear_ratio` turns of the shaft are one turn of the wheel
  // (motor.h).
  double gear_ratio = 1;
  double rotor_inertia = 0;          ///< kg·m²
  double no_load_speed = 0;          ///< rad/s at which the torque has fallen to zero; 0: no such speed
  double motor_friction = 0;         ///< N·m, Coulomb
  double motor_damping = 0;          ///< N·m·s/rad
  std::uint64_t actuator_delay = 0;  ///< cycles in addition to the one of the bus

  // This member describes the sensors.
  bool contact_sensors = false;  ///< true: forces at wheels and casters (SensorFrame::contact_forces)

  // These members describe the battery (battery.h), which does not discharge.
  double battery_voltage = 0;       ///< V without load; 0: no battery is reported
  double battery_resistance = 0.1;  ///< Ω, of cells and cables

  // These members describe a push at the base's origin, in the base's axes at the beginning of the push.
  double push_x = 0, push_y = 0, push_z = 0;  ///< N
  double push_start = 0;                      ///< s
  double push_duration = 0;                   ///< s; 0: none
};

}  // namespace robot_control

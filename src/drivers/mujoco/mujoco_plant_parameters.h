#pragma once
/// These are the parameters of the simulated machine: the world, the brakes, and all deviations from an ideal plant.
/// Random numbers depend only on `seed`: the same seed gives the same bytes.

#include <cstdint>
#include <optional>
#include <string>

#include "drivers/drive_brake.h"
#include "drivers/mujoco/sensors/errors.h"
#include "parameters/block.h"

namespace robot_control {

/// The simulated laser scanner (laser.h), in the map `laser` of the plant's block.
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

enum class TerrainKind { kNone, kStairs, kRough, kBars, kGap, kIce };

inline std::vector<Word> words_of(TerrainKind) {
  return {{"none", TerrainKind::kNone}, {"stairs", TerrainKind::kStairs}, {"rough", TerrainKind::kRough},
          {"bars", TerrainKind::kBars}, {"gap", TerrainKind::kGap},       {"ice", TerrainKind::kIce}};
}

/// An uneven floor before the robot (terrain.h), in the map `terrain` of the plant's block.
struct TerrainParameters {
  TerrainKind kind = TerrainKind::kNone;
  double height = 0.1;      ///< m
  double length = 0.3;      ///< m
  std::uint64_t count = 5;  ///< steps, rows of tiles or bars
  double distance = 0.75;   ///< m, from the robot's origin; beyond its front at the start
  double heading = 0;       ///< rad
  double friction = 1;      ///< of the boxes; ice has kIceFriction of it
};

inline Keys keys(TerrainParameters& terrain) {
  const std::string_view group = "terrain";
  return {
      {"kind", &terrain.kind, {}, 0, 0, 0, {}, group},
      {"height", &terrain.height, "m", 0, 1, 0, {}, group},
      {"length", &terrain.length, "m", 0.02, 100, 0, {}, group},
      {"count", &terrain.count, {}, 1, 100, 0, {}, group},
      {"distance", &terrain.distance, "m", 0.5, 100, 0, {}, group},
      {"heading", &terrain.heading, "rad", -3.2, 3.2, 0, {}, group},
      {"friction", &terrain.friction, {}, 0, 10, 0, {}, group},
  };
}

enum class TyreModel {
  kBrush,   ///< tyre.h: Coulomb friction that is also correct while sliding
  kNative,  ///< MuJoCo's own contact friction
};

inline std::vector<Word> words_of(TyreModel) {
  return {{"brush", TyreModel::kBrush}, {"native", TyreModel::kNative}};
}

enum class SimulatedDrive {
  kTorque,    ///< joint_law.h
  kVelocity,  ///< motors/velocity_drive.h
};

inline std::vector<Word> words_of(SimulatedDrive) {
  return {{"torque", SimulatedDrive::kTorque}, {"velocity", SimulatedDrive::kVelocity}};
}

struct MujocoPlantParameters : Errors {
  std::string scene;         ///< MJCF path: the world around the robot
  std::uint64_t seed = 0;    ///< seed of every random number in the plant
  std::uint64_t cycles = 0;  ///< number of cycles after which the node ends by itself; 0 = never

  // These members describe the ground.
  TyreModel tyre = TyreModel::kBrush;
  std::optional<double>
      ground_friction;       ///< friction of all the ground; without it each shape of the scene has its own
  double slope = 0;          ///< rad by which the whole world is tilted
  double slope_heading = 0;  ///< rad, direction uphill from x of the start pose
  TerrainParameters terrain;

  // These members describe the brake of each wheel. Missing values are derived from the robot
  // (gate/wheeled/wheel_stop.h).
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

  // These members describe the drives of the wheels; those but the first one hold for drive: velocity.
  SimulatedDrive drive = SimulatedDrive::kTorque;
  double drive_gain = 1;           ///< times the gains of its speed loop
  bool drive_feed_forward = true;  ///< it adds the torque of the command
  double drive_dead_band = 0;      ///< rad/s, slower commands are 0
  double drive_resolution = 0;     ///< rad/s, of the commands that it takes; 0: exact
  DriveBrake drive_brake = DriveBrake::kHold;

  // These members describe the sensors.
  bool contact_sensors = false;  ///< true: forces at wheels and casters, or feet (SensorFrame::contacts)
  LaserParameters laser;

  // These members describe the battery (battery.h), which does not discharge.
  double battery_voltage = 0;       ///< V without load; 0: no battery is reported
  double battery_resistance = 0.1;  ///< Ω, of cells and cables

  // These members describe a push at the base's origin, in the base's axes at the beginning of the push.
  double push_x = 0, push_y = 0, push_z = 0;  ///< N
  double push_start = 0;                      ///< s
  double push_duration = 0;                   ///< s; 0: none
};

inline Keys keys(MujocoPlantParameters& plant) {
  // A YAML integer, a Python int and a ROS parameter represent every value below it.
  constexpr double kMaxCount = 9007199254740992.0;  // 2^53
  return joined({
      {
          {"scene", &plant.scene, {}, 0, 0, kPath},
          {"seed", &plant.seed, {}, 0, kMaxCount},
          {"cycles", &plant.cycles, "cycles", 0, kMaxCount, kZeroIsOff},
          {"tyre", &plant.tyre},
          {"ground_friction", &plant.ground_friction, {}, 0, 10, kOptional},
          {"slope", &plant.slope, "rad", -1, 1},
          {"slope_heading", &plant.slope_heading, "rad", -3.2, 3.2},
          {"brake_effort", &plant.brake_effort, "N·m", 0.001, 10000, kOptional},
          {"brake_damping", &plant.brake_damping, "N·m·s/rad", 0, 10000, kOptional},
          {"brake_stiffness", &plant.brake_stiffness, "N·m/rad", 0, 1.0e6, kOptional},
          {"brake_hold_speed", &plant.brake_hold_speed, "rad/s", 0, 10, kOptional},
          {"left_radius_error", &plant.left_radius_error, {}, -0.5, 0.5},
          {"right_radius_error", &plant.right_radius_error, {}, -0.5, 0.5},
          {"wheel_base_error", &plant.wheel_base_error, {}, -0.5, 0.5},
          {"wheel_friction_error", &plant.wheel_friction_error, {}, -1, 10},
          {"payload", &plant.payload, "kg", 0, 10000},
          {"payload_x", &plant.payload_x, "m", -10, 10},
          {"payload_y", &plant.payload_y, "m", -10, 10},
          {"payload_z", &plant.payload_z, "m", -10, 10},
          {"gear_ratio", &plant.gear_ratio, {}, 0.001, 10000},
          {"rotor_inertia", &plant.rotor_inertia, "kg·m²", 0, 100},
          {"no_load_speed", &plant.no_load_speed, "rad/s", 0, 100000, kZeroIsOff},
          {"motor_friction", &plant.motor_friction, "N·m", 0, 1000},
          {"motor_damping", &plant.motor_damping, "N·m·s/rad", 0, 1000},
          {"actuator_delay", &plant.actuator_delay, "cycles", 0, 100},
          {"drive", &plant.drive},
          {"drive_gain", &plant.drive_gain, {}, 0.1, 10},
          {"drive_feed_forward", &plant.drive_feed_forward},
          {"drive_dead_band", &plant.drive_dead_band, "rad/s", 0, 10},
          {"drive_resolution", &plant.drive_resolution, "rad/s", 0, 1, kZeroIsOff},
          {"drive_brake", &plant.drive_brake},
      },
      keys(static_cast<Errors&>(plant)),
      {
          {"contact_sensors", &plant.contact_sensors},
          // At the idle current at most half a volt is lost (battery.h), so the voltage stays positive.
          {"battery_voltage", &plant.battery_voltage, "V", 1, 1000, kZeroIsOff},
          {"battery_resistance", &plant.battery_resistance, "Ω", 0, 1},
          {"push_x", &plant.push_x, "N", -100000, 100000},
          {"push_y", &plant.push_y, "N", -100000, 100000},
          {"push_z", &plant.push_z, "N", -100000, 100000},
          {"push_start", &plant.push_start, "s", 0, 1.0e6},
          {"push_duration", &plant.push_duration, "s", 0, 1.0e6, kZeroIsOff},
      },
      keys(plant.laser),
      keys(plant.terrain),
  });
}

}  // namespace robot_control

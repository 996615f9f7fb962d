#pragma once
/// true_robot returns the simulated robot. It is the robot of the URDF, without the overrides of the `robot:` block,
/// with the configured errors of the plant.
///
///   payload     a point mass, fixed to the base
///   centre of gravity   in the field (errors.h), ahead and to the left of the described one by
///               centre_of_gravity_error · wheel base, by moving that of the root link
///   wheels      wheeled/true_wheels.h
///   held joints a rotor, which no URDF states: the effort limit alone accelerates it by 200 rad/s² or m/s², or it has
///               the inertia of the robot's mass at a lever of 1 m, if that is less
///
/// Effort limits stay as described, because they belong to the drive.

#include <vector>

#include "drivers/mujoco/mujoco_plant_parameters.h"
#include "gate/brake_law.h"
#include "machine/bodies/shape_points.h"
#include "machine/machine_model.h"

namespace robot_control {

/// A drive wheel or the wheel of a caster.
struct TrueWheel {
  std::size_t joint = 0;     ///< index into MachineModel::joints
  std::size_t side = 0;      ///< of a drive wheel: index into MachineModel::groups
  RollingEllipsoid shape;    ///< on the ground
  double inertia = 0;        ///< kg·m² about the axle, rotor_inertia included
  double rotor_inertia = 0;  ///< kg·m², of the drive's rotor and gear
  bool omni = false;         ///< slides sideways without friction
  Brake brake;               ///< of a drive wheel, from the robot's kind
};

struct TrueRobot : MachineModel {
  TrueRobot() = default;
  explicit TrueRobot(const MachineModel& machine) : MachineModel(machine) {}

  std::vector<TrueWheel> wheels;  ///< the drive wheels, which are the first joints; then those of casters
  std::size_t drive_wheels = 0;
};

/// `step` is the time step of the simulated drives in s. Throws RobotError as read_drive_train does.
TrueRobot true_robot(const MachineModel& described, const MujocoPlantParameters& parameters, double step);

/// Adds the payload, and moves the centre of gravity by its error. `wheel_base` is in m, and zero without wheels.
void load_base(MachineModel& robot, RigidBodies& bodies, const MujocoPlantParameters& parameters, double wheel_base);

/// Returns the wheel that `body` is; null for all others.
const TrueWheel* wheel_of(const TrueRobot& robot, const RigidBody& body);

}  // namespace robot_control

#pragma once
/// The drives of a simulated robot whose wheels take speeds, derived from the true robot.

#include <vector>

#include "drivers/driver.h"
#include "drivers/mujoco/model/true_robot.h"
#include "drivers/mujoco/motors/velocity_drive.h"

namespace robot_control {

/// Returns one drive for each drive wheel; none where the drives take torques. `step` is that of the simulation in s.
/// Throws DriverError for drives of speeds on a robot without drive wheels.
inline std::vector<VelocityDrive> velocity_drives(const TrueRobot& robot, const MujocoPlantParameters& parameters,
                                                  double step) {
  std::vector<VelocityDrive> drives;
  if (parameters.drive == SimulatedDrive::kTorque) return drives;
  if (robot.drive_wheels == 0)
    throw DriverError("mujoco_plant: drive is velocity, but " + robot.source +
                      " has no drive wheels. Set it to torque.");
  for (std::size_t i = 0; i < robot.drive_wheels; ++i) {
    const TrueWheel& wheel = robot.wheels[i];
    const double radius = wheel.shape.radius;
    const double share = robot.mass / static_cast<double>(robot.drive_wheels);
    drives.emplace_back(VelocityDriveParameters{.loaded_inertia = wheel.inertia + share * radius * radius,
                                                .lifted_inertia = wheel.inertia,
                                                .effort_limit = robot.joints[wheel.joint].effort_limit,
                                                .gain = parameters.drive_gain,
                                                .takes_feed_forward = parameters.drive_feed_forward,
                                                .dead_band = parameters.drive_dead_band,
                                                .resolution = parameters.drive_resolution,
                                                .at_rest = parameters.drive_brake,
                                                .brake = wheel.brake},
                        step);
  }
  return drives;
}

}  // namespace robot_control

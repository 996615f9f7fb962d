#include "robots/robot_kind.h"

#include "machine/bodies/rigid_bodies.h"
#include "machine/legs/leg_model.h"
#include "machine/wheeled/drive_train.h"
#include "robots/differential_drive.h"
#include "robots/quadruped.h"

namespace robot_control {

RobotKind kind_of(const RobotDescription& description) {
  return has_legs(read_rigid_bodies(description)) ? RobotKind::kOnLegs : RobotKind::kOnWheels;
}

std::unique_ptr<MachineModel> read_robot(const RobotDescription& description, const Parameters& parameters) {
  if (kind_of(description) == RobotKind::kOnLegs)
    return std::make_unique<LegModel>(read_legs(description, parameters.robot, parameters.legs));
  return std::make_unique<DriveTrain>(read_drive_train(description, parameters.robot));
}

std::unique_ptr<Robot> make_robot(const Parameters& parameters) {
  const RobotDescription description = load_description(parameters.urdf);
  if (kind_of(description) == RobotKind::kOnLegs)
    return std::make_unique<Quadruped>(parameters, read_legs(description, parameters.robot, parameters.legs));
  return std::make_unique<DifferentialDrive>(parameters, read_drive_train(description, parameters.robot));
}

}  // namespace robot_control

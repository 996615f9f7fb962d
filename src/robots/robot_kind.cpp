#include "robots/robot_kind.h"

#include "machine/bodies/rigid_bodies.h"
#include "machine/legs/leg_model.h"
#include "machine/wheeled/drive_train.h"

namespace robot_control {

RobotKind kind_of(const RobotDescription& description) {
  return has_legs(read_rigid_bodies(description)) ? RobotKind::kLegs : RobotKind::kWheels;
}

std::unique_ptr<MachineModel> read_robot(const RobotDescription& description, const Parameters& parameters) {
  if (kind_of(description) == RobotKind::kLegs)
    return std::make_unique<LegModel>(read_legs(description, parameters.robot, parameters.legs));
  return std::make_unique<DriveTrain>(read_drive_train(description, parameters.robot));
}

}  // namespace robot_control

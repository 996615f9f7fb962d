#include "robots/robot_kind.h"

#include "machine/bodies/added_laser.h"
#include "machine/bodies/rigid_bodies.h"
#include "machine/legs/leg_chains.h"
#include "machine/legs/leg_model.h"
#include "machine/wheeled/drive_train.h"
#include "robots/differential_drive.h"
#include "robots/quadruped.h"
#include "robots/wheeled/within_drives.h"
#include "signals/robot_kinds.h"

namespace robot_control {

MachineKind kind_of(const RobotDescription& description, KindChoice choice) {
  if (choice != KindChoice::kDerived)
    return choice == KindChoice::kOnLegs ? MachineKind::kOnLegs : MachineKind::kOnWheels;
  return has_legs(read_moving_bodies(description)) ? MachineKind::kOnLegs : MachineKind::kOnWheels;
}

std::unique_ptr<MachineModel> read_robot(const RobotDescription& description, const Parameters& parameters) {
  if (kind_of(description, parameters.kind) == MachineKind::kOnLegs)
    return std::make_unique<LegModel>(read_legs(description, parameters.robot, parameters.legs));
  return std::make_unique<DriveTrain>(read_drive_train(description, parameters.robot));
}

Parameters limited_by_drives(const Parameters& parameters, const RobotDescription& description) {
  const bool unlimited = parameters.drives.empty() || kind_of(description, parameters.kind) == MachineKind::kOnLegs;
  return unlimited ? parameters : within_drives(parameters, description);
}

MachineKind kind_of(const MachineModel& machine) noexcept {
  return dynamic_cast<const LegModel*>(&machine) != nullptr ? MachineKind::kOnLegs : MachineKind::kOnWheels;
}

std::string_view name_of(MachineKind kind) noexcept {
  return kind == MachineKind::kOnLegs ? kLeggedKind : kWheeledKind;
}

std::unique_ptr<Robot> compose(const Parameters& parameters, const MachineModel& machine) {
  if (kind_of(machine) == MachineKind::kOnLegs) return std::make_unique<Quadruped>(parameters, leg_model_of(machine));
  return std::make_unique<DifferentialDrive>(parameters, drive_train_of(machine));
}

std::unique_ptr<Robot> make_robot(const Parameters& parameters) {
  const RobotDescription description = with_laser(load_description(parameters.urdf), parameters.simulated_laser);
  return compose(parameters, *read_robot(description, parameters));
}

}  // namespace robot_control

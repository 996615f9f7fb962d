#include "drivers/driver_contract.h"

#include "drivers/mujoco/mujoco_plant.h"
#include "support/robots/diffbot_urdf.h"
#include "support/robots/free_wheels.h"

namespace robot_control::tests {

constexpr double kEffortLimit = 3.5;  // N·m, of diffbot's wheels

std::unique_ptr<Driver> mujoco_plant() {
  MujocoPlantParameters parameters;
  parameters.scene = PROJECT_DIRECTORY "/urdf/scenes/flat.xml";
  return std::make_unique<MujocoPlant>(read_drive_train(diffbot_urdf(), {}), parameters, 0.001);
}

// One wheel moves half of the robot's 12 kg at 0.1 m: 0.06 kg·m² with its own inertia. 1 N·m turns it by 0.7 rad in
// 0.3 s; 20 N·m/rad and 2 N·m·s/rad are an impedance of damping ratio 0.9.
const MachineUnderTest kSimulatedMachine{.name = "MujocoPlant",
                                         .make = mujoco_plant,
                                         .effort_limit = kEffortLimit,
                                         .effort = 1,
                                         .damping = 2,
                                         .stiffness = 20};

std::unique_ptr<Driver> free_wheels() {
  const Brake brake{.effort = 3, .hold_effort = 3, .damping = 3, .stiffness = 20, .hold_speed = 0.3};
  return std::make_unique<FreeWheels>(read_drive_train(diffbot_urdf(), {}), std::vector<Brake>(2, brake), 0.001);
}

const MachineUnderTest kFreeWheels{.name = "FreeWheels",
                                   .make = free_wheels,
                                   .effort_limit = kEffortLimit,
                                   .effort = 1,
                                   .damping = 2,
                                   .stiffness = 20};

INSTANTIATE_TEST_SUITE_P(Machines, DriverContract, testing::Values(kSimulatedMachine, kFreeWheels), machine_name);

}  // namespace robot_control::tests

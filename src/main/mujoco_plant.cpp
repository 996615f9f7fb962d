#include "drivers/mujoco/mujoco_plant.h"

#include "ros/nodes/driver_node.h"
#include "ros/nodes/node.h"

int main(int argc, char** argv) {
  using namespace robot_control;
  return run_node(argc, argv,
                  {.name = "mujoco_plant",
                   .purpose = "Simulates the robot: motors, sensors and the world around it, in MuJoCo. The last check "
                              "of every command is here.",
                   .make = [](const Setup& setup) {
                     return make_driver_node(setup, [](const Setup& read) -> std::unique_ptr<Driver> {
                       return std::make_unique<MujocoPlant>(read.robot, read.parameters.plant,
                                                            read.parameters.loop.period());
                     });
                   }});
}

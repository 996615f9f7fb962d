#include "ros/nodes/driver_node.h"
#include "ros/nodes/node.h"
#include "simulation/machines/simulated_machine.h"

int main(int argc, char** argv) {
  using namespace robot_control;
  return run_node(argc, argv,
                  {.name = "mujoco_plant",
                   .purpose = "Simulates the robot: motors, sensors and the world around it, in MuJoCo. The last check "
                              "of every command is here.",
                   .make = [](const Setup& setup) {
                     return make_driver_node(setup, [](const Parameters& parameters, const Robot& robot) {
                       return make_simulated_machine(parameters, robot.machine(), robot.brakes());
                     });
                   }});
}

#include "ros/nodes/mujoco_plant_node.h"
#include "ros/nodes/node.h"

int main(int argc, char** argv) {
  using namespace robot_control;
  return run_node(argc, argv,
                  {.name = "mujoco_plant",
                   .purpose = "Simulates the robot: motors, sensors and the world around it, in MuJoCo. The last check "
                              "of every command is here.",
                   .make = make_mujoco_plant});
}

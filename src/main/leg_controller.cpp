#include "ros/legged/leg_controller_node.h"
#include "ros/nodes/node.h"

int main(int argc, char** argv) {
  using namespace robot_control;
  return run_node(argc, argv,
                  {.name = "leg_controller",
                   .purpose = "Controls a robot on four legs: standing up, moving body and feet, walking, lying down.",
                   .make = make_leg_controller});
}

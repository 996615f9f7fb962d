#include "ros/legged/leg_controller_node.h"
#include "ros/nodes/node.h"

int main(int argc, char** argv) {
  using namespace robot_control;
  return run_node(argc, argv,
                  {.name = "leg_controller",
                   .purpose = "Lets a robot on four legs stand up, moves its body and its feet, and lets it lie down.",
                   .make = make_leg_controller});
}

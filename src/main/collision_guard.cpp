#include "ros/navigation/collision_guard_node.h"

int main(int argc, char** argv) {
  using namespace robot_control;
  return run_node(argc, argv,
                  {.name = "collision_guard",
                   .purpose = "Limits the speed of every motion by what the lasers see.",
                   .make = navigation::make_collision_guard,
                   .in_loop = false});
}

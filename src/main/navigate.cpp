#include "ros/navigation/navigate_node.h"

int main(int argc, char** argv) {
  using namespace robot_control;
  return run_node(argc, argv,
                  {.name = "navigate",
                   .purpose = "Steers to a goal on the map through follow_path, and reports why a goal is not reached.",
                   .make = navigation::make_navigate,
                   .in_loop = false});
}

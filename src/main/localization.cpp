#include "ros/navigation/localization_node.h"

int main(int argc, char** argv) {
  using namespace robot_control;
  return run_node(argc, argv,
                  {.name = "localization",
                   .purpose = "Finds the robot in a saved map from scan and odom.",
                   .make = navigation::make_localization,
                   .in_loop = false});
}

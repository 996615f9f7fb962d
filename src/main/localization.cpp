#include "ros/navigation/localization_node.h"
#include "ros/nodes/service_program.h"

int main(int argc, char** argv) {
  using namespace robot_control;
  return run_service(argc, argv,
                     {.name = "localization",
                      .purpose = "Finds the robot in a saved map from scan and odom.",
                      .spin = navigation::spin_localization});
}

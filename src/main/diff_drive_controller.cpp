#include "ros/nodes/node.h"
#include "ros/wheeled/controller_node.h"

int main(int argc, char** argv) {
  using namespace robot_control;
  return run_node(argc, argv,
                  {.name = "diff_drive_controller",
                   .purpose = "Turns velocity commands into torques of the wheels, within the limits of the robot.",
                   .make = make_controller});
}

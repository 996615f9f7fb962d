#include "ros/navigation/navigate_node.h"
#include "ros/nodes/service_program.h"

int main(int argc, char** argv) {
  using namespace robot_control;
  return run_service(
      argc, argv,
      {.name = "navigate",
       .purpose = "Plans a way to a goal on the map, sends it to follow_path, and says why a goal is not reached.",
       .spin = navigation::spin_navigate});
}

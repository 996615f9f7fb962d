#include "ros/navigation/slam_node.h"
#include "ros/nodes/service_program.h"

int main(int argc, char** argv) {
  using namespace robot_control;
  return run_service(
      argc, argv,
      {.name = "slam",
       .purpose = "Makes a map from scan and odom while the robot is driven, and publishes its place in it.",
       .spin = navigation::spin_slam});
}

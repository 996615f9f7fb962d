#include "ros/navigation/slam_node.h"

int main(int argc, char** argv) {
  using namespace robot_control;
  return run_node(argc, argv,
                  {.name = "slam",
                   .purpose = "Makes a map from scan and odom while the robot is driven, and publishes its pose in it.",
                   .make = navigation::make_slam,
                   .in_loop = false});
}

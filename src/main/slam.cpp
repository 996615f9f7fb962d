#include "ros/navigation/slam_node.h"

int main(int argc, char** argv) {
  return robot_control::run_slam(argc, argv);
}

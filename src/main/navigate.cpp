#include "ros/navigation/navigate_node.h"

int main(int argc, char** argv) {
  return robot_control::run_navigate(argc, argv);
}

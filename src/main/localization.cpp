#include "ros/navigation/localization_node.h"

int main(int argc, char** argv) {
  return robot_control::run_localization(argc, argv);
}

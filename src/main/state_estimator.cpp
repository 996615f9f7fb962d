#include "ros/nodes/estimator_node.h"
#include "ros/nodes/node.h"

int main(int argc, char** argv) {
  using namespace robot_control;
  return run_node(argc, argv,
                  {.name = "state_estimator",
                   .purpose = "Estimates pose and speed of the robot from its wheels and its inertial sensors.",
                   .make = make_estimator});
}

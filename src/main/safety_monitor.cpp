#include "ros/nodes/monitor_node.h"
#include "ros/nodes/node.h"

int main(int argc, char** argv) {
  using namespace robot_control;
  return run_node(
      argc, argv,
      {.name = "safety_monitor",
       .purpose = "Permits or stops motion, independently of the other nodes; keeps a stop until it is reset.",
       .make = make_monitor});
}

#include "ros/nodes/monitor_node.h"
#include "ros/nodes/node.h"

int main(int argc, char** argv) {
  using namespace robot_control;
  return run_node(
      argc, argv,
      {.name = "safety_monitor",
       .purpose = "Permits motion or stops it, beside the chain of the other nodes; holds stops until they are reset.",
       .make = make_monitor});
}

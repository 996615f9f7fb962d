#include "ros/nodes/node.h"
#include "ros/nodes/telemetry_node.h"

int main(int argc, char** argv) {
  using namespace robot_control;
  return run_node(argc, argv,
                  {.name = "telemetry",
                   .purpose = "Writes every cycle of all nodes to a log (run.bag) and to the black box.",
                   .make = make_telemetry});
}

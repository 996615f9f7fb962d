#include "bridge/nodes/node.h"
#include "bridge/nodes/safety_monitor_node.h"
#include "faults/faulty_frame_output.h"

int main(int argc, char** argv) {
  using namespace robot_control;
  return run_node(argc, argv,
                  {.name = "safety_monitor",
                   .purpose = "Permits motion or stops it, beside the chain of the other nodes; holds stops until they "
                              "are reset. Faults can be injected into its output.",
                   .make = [](const Setup& setup) { return make_safety_monitor(setup, faulty_monitor_output()); }});
}

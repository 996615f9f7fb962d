#include "bridge/nodes/node.h"
#include "bridge/nodes/safety_monitor_node.h"
#include "faults/faulty_frame_output.h"

int main(int argc, char** argv) {
  using namespace robot_control;
  return run_node(argc, argv, "safety_monitor",
                  [](const Setup& setup) { return make_safety_monitor(setup, faulty_monitor_output()); });
}

#include "bridge/nodes/node.h"
#include "bridge/nodes/state_estimator_node.h"
#include "faults/faulty_frame_output.h"

int main(int argc, char** argv) {
  using namespace robot_control;
  return run_node(argc, argv, "state_estimator",
                  [](const Setup& setup) { return make_state_estimator(setup, faulty_estimator_output()); });
}

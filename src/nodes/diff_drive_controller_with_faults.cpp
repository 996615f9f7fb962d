#include "bridge/nodes/diff_drive_controller_node.h"
#include "bridge/nodes/node.h"
#include "faults/faulty_frame_output.h"

int main(int argc, char** argv) {
  using namespace robot_control;
  return run_node(argc, argv, "diff_drive_controller",
                  [](const Setup& setup) { return make_diff_drive_controller(setup, faulty_controller_output()); });
}

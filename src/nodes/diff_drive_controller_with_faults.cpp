#include "bridge/nodes/diff_drive_controller_node.h"
#include "bridge/nodes/node.h"
#include "faults/faulty_frame_output.h"

int main(int argc, char** argv) {
  using namespace robot_control;
  return run_node(
      argc, argv,
      {.name = "diff_drive_controller",
       .purpose = "Turns velocity commands into torques of the wheels, within the limits of the robot. Faults can be "
                  "injected into its output.",
       .make = [](const Setup& setup) { return make_diff_drive_controller(setup, faulty_controller_output()); }});
}

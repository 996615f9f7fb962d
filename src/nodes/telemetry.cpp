#include "bridge/nodes/node.h"
#include "bridge/nodes/telemetry_node.h"

int main(int argc, char** argv) {
  using namespace robot_control;
  return run_node(argc, argv, "telemetry", make_telemetry);
}

#include "bridge/nodes/mujoco_plant_node.h"
#include "bridge/nodes/node.h"

int main(int argc, char** argv) {
  using namespace robot_control;
  return run_node(argc, argv, "mujoco_plant", make_mujoco_plant);
}

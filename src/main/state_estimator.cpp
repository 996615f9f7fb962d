#include "robots/robot_kind.h"
#include "ros/nodes/estimator_node.h"
#include "ros/nodes/node.h"
#include "ros/wheeled/wheel_outputs.h"

namespace robot_control {
namespace {

std::unique_ptr<Node> make_estimator_of_kind(const Setup& setup) {
  if (kind_of(*setup.machine) == MachineKind::kOnWheels) return make_wheel_estimator(setup);
  return make_estimator(setup, nullptr);
}

}  // namespace
}  // namespace robot_control

int main(int argc, char** argv) {
  using namespace robot_control;
  return run_node(argc, argv,
                  {.name = "state_estimator",
                   .purpose = "Estimates pose and speed of the robot from its wheels and its inertial sensors.",
                   .make = make_estimator_of_kind});
}

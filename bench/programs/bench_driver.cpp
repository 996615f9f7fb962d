/// bench_driver: the node `driver` on a robot without simulated physics (tests/support/robots/free_wheels.h). With it,
/// scripts/bench realtime measures what the loop itself costs.

#include "ros/nodes/driver_node.h"
#include "ros/nodes/node.h"
#include "support/robots/free_wheels.h"

int main(int argc, char** argv) {
  using namespace robot_control;
  return run_node(argc, argv,
                  {.name = "driver",
                   .purpose = "A driver of wheels that turn freely, for benchmarks.",
                   .make = [](const Setup& setup) {
                     return make_driver_node(
                         setup, [](const Parameters& parameters, const Robot& robot) -> std::unique_ptr<Driver> {
                           return std::make_unique<FreeWheels>(drive_train_of(robot.machine()), robot.brakes(),
                                                               parameters.loop.period());
                         });
                   }});
}

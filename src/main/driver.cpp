#include "drivers/table/factory.h"
#include "ros/nodes/driver_node.h"
#include "ros/nodes/node.h"
#include "rt/clock.h"

int main(int argc, char** argv) {
  using namespace robot_control;
  return run_node(
      argc, argv,
      {.name = "driver",
       .purpose = "Connects the loop with a real machine (robot.driver). The last check of every command is "
                  "here.",
       .make = [](const Setup& setup) {
         return make_driver_node(setup, [](const Parameters& parameters, const Robot& robot) {
           return make_driver(parameters, robot.machine(), robot.brakes(), [] {
             return CanTime{monotonic_ns(), utc_ns()};
           });
         });
       }});
}

#pragma once
/// Two wheels in the air on the simulated motor board, behind the example driver.

#include <sys/socket.h>

#include <array>
#include <memory>
#include <vector>

#include "drivers/example/example_driver.h"
#include "drivers/wheels_in_air.h"
#include "simulation/devices/example_board.h"

namespace robot_control {

class ExampleMachine final : public WheelsInAir<ExampleBoard, ExampleDriver> {
 public:
  static constexpr double kPeriod = 0.001;  ///< s

  ExampleMachine() : WheelsInAir(kPeriod) {
    std::array<int, 2> ends{};
    if (socketpair(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK, 0, ends.data()) != 0) throw DriverError("no socket");
    const std::vector<Brake> brakes{kBrake, kBrake};
    const std::vector<double> limits{kEffortLimit, kEffortLimit};
    board_ = std::make_unique<ExampleBoard>(brakes, limits, kPeriod, ends[1]);
    driver_ = std::make_unique<ExampleDriver>(ExampleParameters{}, brakes, limits, 2, kPeriod, ends[0]);
  }
};

}  // namespace robot_control

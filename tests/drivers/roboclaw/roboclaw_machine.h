#pragma once
/// Two wheels in the air on a simulated RoboClaw, behind its driver.

#include <array>
#include <functional>
#include <memory>
#include <utility>

#include "drivers/roboclaw/roboclaw_driver.h"
#include "drivers/roboclaw/roboclaw_front.h"
#include "drivers/wheels_in_air.h"

namespace robot_control {

class RoboclawMachine final : public WheelsInAir<RoboclawFront, RoboclawDriver> {
 public:
  explicit RoboclawMachine(double rate) : WheelsInAir(1 / rate) {
    board_ = std::make_unique<RoboclawFront>(parameters(), kBrakes, kLimits, period_, 1);
    connect(board_->line().driver_end());
  }

  /// Over a true line; its driver's end is made after its device's end.
  RoboclawMachine(double rate, std::unique_ptr<SerialLine> device_end,
                  const std::function<std::unique_ptr<SerialLine>()>& driver_end)
      : WheelsInAir(1 / rate) {
    board_ = std::make_unique<RoboclawFront>(parameters(), kBrakes, kLimits, period_, std::move(device_end));
    connect(driver_end());
  }

  RoboclawDriver& driver() { return *driver_; }

  /// The driver's process ended, and another one is there. The board ran on.
  void replace_driver() { replace_driver(board_->line().driver_end()); }
  void replace_driver(std::unique_ptr<SerialLine> driver_end) { connect(std::move(driver_end)); }

  static RoboclawParameters parameters() {
    RoboclawParameters parameters{.line = {.address = "none"}, .wheels = {}};
    for (std::uint64_t i = 0; i < 2; ++i) {
      parameters.wheels.push_back({.joint = i == 0 ? "left" : "right",
                                   .motor = 2 - i,  // the joints are not in the order of the motors
                                   .direction = i == 0 ? 1 : -1,
                                   .counts_per_turn = 16384,
                                   .velocity_limit = 30});
    }
    return parameters;
  }

 private:
  static constexpr std::array kBrakes{kBrake, kBrake};
  static constexpr std::array kLimits{kEffortLimit, kEffortLimit};

  void connect(std::unique_ptr<SerialLine> driver_end) {
    driver_ = std::make_unique<RoboclawDriver>(parameters(), 2, period_, std::move(driver_end),
                                               [this] { return board_->now_ns(); });
  }
};

}  // namespace robot_control

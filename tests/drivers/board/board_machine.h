#pragma once
/// Two wheels in the air on the simulated motor board, whose code is that of firmware/, behind its driver.

#include <array>
#include <functional>
#include <memory>
#include <utility>

#include "drivers/board/board_driver.h"
#include "drivers/board/board_front.h"
#include "drivers/wheels_in_air.h"

namespace robot_control {

class BoardMachine final : public WheelsInAir<BoardFront, BoardDriver> {
 public:
  explicit BoardMachine(double rate = 1000, unsigned counter_bits = 32, std::uint32_t zero = 0,
                        std::uint64_t bit_rate = 0)
      : WheelsInAir(1 / rate), parameters_(parameters_of(counter_bits, bit_rate)) {
    board_ = std::make_unique<BoardFront>(parameters_, kBrakes, period_, 1);
    board_->set_zero(zero);
    connect(board_->line().driver_end());
  }

  /// Over a true line; its driver's end is made after its device's end.
  BoardMachine(double rate, std::unique_ptr<SerialLine> device_end,
               const std::function<std::unique_ptr<SerialLine>()>& driver_end)
      : WheelsInAir(1 / rate), parameters_(parameters_of(32, 0)) {
    board_ = std::make_unique<BoardFront>(parameters_, kBrakes, period_, std::move(device_end));
    connect(driver_end());
  }

  BoardDriver& driver() { return *driver_; }

  /// The driver's process ended, and another one is there. The board ran on.
  void replace_driver() { connect(board_->line().driver_end()); }

 private:
  static constexpr std::array kBrakes{kBrake, kBrake};

  static BoardParameters parameters_of(unsigned counter_bits, std::uint64_t bit_rate) {
    BoardParameters parameters{
        .line = {.address = "none", .bit_rate = bit_rate, .e_stop_input = true, .on_silence = SilenceReaction::kHolds},
        .wheels = {}};
    for (std::uint64_t i = 0; i < 2; ++i) {
      parameters.wheels.push_back({.joint = i == 0 ? "left" : "right",
                                   .wheel = 1 - i,  // the joints are not in the order of the board
                                   .direction = i == 0 ? 1 : -1,
                                   .counts_per_turn = 16384,
                                   .counter_bits = counter_bits,
                                   .torque_limit = kEffortLimit,
                                   .velocity_limit = 100});
    }
    return parameters;
  }

  void connect(std::unique_ptr<SerialLine> driver_end) {
    driver_ = std::make_unique<BoardDriver>(parameters_, kBrakes, 2, period_, std::move(driver_end),
                                            [this] { return board_->now_ns(); });
  }

  BoardParameters parameters_;
};

}  // namespace robot_control

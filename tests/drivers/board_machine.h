#pragma once
/// Two wheels in the air on the simulated motor board, whose code is that of firmware/, behind its driver.

#include <memory>
#include <vector>

#include "drivers/serial/board_driver.h"
#include "simulation/devices/board_front.h"

namespace robot_control {

class BoardMachine final : public Driver {
 public:
  static constexpr double kInertia = 0.01;  ///< kg·m²
  static constexpr double kEffortLimit = 3.5;

  explicit BoardMachine(double rate = 1000, unsigned counter_bits = 32, std::uint32_t zero = 0,
                        std::uint64_t bit_rate = 0)
      : period_(1 / rate) {
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
    const Brake brake{.effort = 3, .hold_effort = 3, .damping = 3, .stiffness = 20, .hold_speed = 0.3};
    const std::vector<Brake> brakes{brake, brake};
    board_ = std::make_unique<BoardFront>(parameters, brakes, period_, 1);
    board_->set_zero(zero);
    driver_ = std::make_unique<BoardDriver>(parameters, brakes, 2, period_, board_->driver_end(),
                                            [this] { return board_->now_ns(); });
  }

  /// The contract begins with a machine that is ready.
  void start() override {
    driver_->start();
    SensorFrame frame;
    for (int i = 0; i < 50 && frame.driver_state != DriverState::kRunning; ++i) {
      read(frame);
      write(std::vector<JointCommand>(2));
    }
  }
  void reset() noexcept override { driver_->reset(); }
  void read(SensorFrame& sensors) noexcept override { driver_->read(sensors); }
  void write(std::span<const JointCommand> commands) noexcept override {
    driver_->write(commands);
    run_board();
  }
  void stop() noexcept override { driver_->stop(); }
  bool accepts(JointMode mode) const noexcept override { return driver_->accepts(mode); }
  bool measures(MachineInput input) const noexcept override { return driver_->measures(input); }
  std::string description() const override { return driver_->description(); }
  std::string warning() const override { return driver_->warning(); }

  /// Runs the board without its driver.
  void run_board() {
    board_->run(joints);
    for (std::size_t i = 0; i < joints.size(); ++i) {
      joints[i].velocity += board_->torque(i) / kInertia * period_;
      joints[i].position += joints[i].velocity * period_;
    }
  }

  BoardFront& board() { return *board_; }
  BoardDriver& driver() { return *driver_; }
  double period() const { return period_; }

  std::vector<JointSample> joints = std::vector<JointSample>(2);

 private:
  double period_;
  std::unique_ptr<BoardFront> board_;
  std::unique_ptr<BoardDriver> driver_;
};

}  // namespace robot_control

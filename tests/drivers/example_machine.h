#pragma once
/// Two wheels in the air on the simulated motor board, behind the example driver.

#include <sys/socket.h>

#include <array>
#include <memory>
#include <vector>

#include "drivers/example/example_driver.h"
#include "simulation/devices/example_board.h"

namespace robot_control {

class ExampleMachine final : public Driver {
 public:
  static constexpr double kInertia = 0.01;  ///< kg·m²
  static constexpr double kPeriod = 0.001;  ///< s
  static constexpr double kEffortLimit = 3.5;

  ExampleMachine() {
    std::array<int, 2> ends{};
    if (socketpair(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK, 0, ends.data()) != 0) throw DriverError("no socket");
    const Brake brake{.effort = 3, .hold_effort = 3, .damping = 3, .stiffness = 20, .hold_speed = 0.3};
    const std::vector<Brake> brakes{brake, brake};
    const std::vector<double> limits{kEffortLimit, kEffortLimit};
    board_ = std::make_unique<ExampleBoard>(brakes, limits, kPeriod, ends[1]);
    driver_ = std::make_unique<ExampleDriver>(ExampleParameters{}, brakes, limits, 2, kPeriod, ends[0]);
  }

  /// The contract begins with a machine that is ready.
  void start() override {
    driver_->start();
    SensorFrame frame;
    for (int i = 0; i < 10 && frame.driver_state != DriverState::kRunning; ++i) {
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
  std::string warning() const override { return driver_->warning(); }

  /// Runs the board without its driver.
  void run_board() {
    board_->run(joints);
    for (std::size_t i = 0; i < joints.size(); ++i) {
      joints[i].velocity += board_->torque(i) / kInertia * kPeriod;
      joints[i].position += joints[i].velocity * kPeriod;
    }
  }

  ExampleBoard& board() { return *board_; }

  std::vector<JointSample> joints = std::vector<JointSample>(2);

 private:
  std::unique_ptr<ExampleBoard> board_;
  std::unique_ptr<ExampleDriver> driver_;
};

}  // namespace robot_control

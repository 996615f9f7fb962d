#pragma once
/// Wheels in the air, two unless their number is given, moved by the torques of a simulated Board, behind Inner, its
/// driver.

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "drivers/driver.h"
#include "drivers/joint_law.h"

namespace robot_control {

template <class Board, class Inner>
class WheelsInAir : public Driver {
 public:
  static constexpr double kInertia = 0.01;  ///< kg·m²
  static constexpr double kEffortLimit = 3.5;
  static constexpr Brake kBrake{.effort = 3, .hold_effort = 3, .damping = 3, .stiffness = 20, .hold_speed = 0.3};

  /// The contract begins with a machine that is ready.
  void start() override { start(50); }
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

  /// Runs `count` cycles with one command for all wheels; returns the last frame.
  const SensorFrame& cycles(int count, const JointCommand& command = {}) {
    for (int i = 0; i < count; ++i) {
      read(frame_);
      write(std::vector<JointCommand>(joints.size(), command));
    }
    return frame_;
  }
  const SensorFrame& frame() const { return frame_; }

  /// Runs the board without its driver.
  void run_board() {
    board_->run(joints);
    for (std::size_t i = 0; i < joints.size(); ++i) {
      joints[i].velocity += board_->torque(i) / kInertia * period_;
      joints[i].position += joints[i].velocity * period_;
    }
  }

  Board& board() { return *board_; }
  double period() const { return period_; }

  std::vector<JointSample> joints;

 protected:
  explicit WheelsInAir(double period, std::size_t wheels = 2) : joints(wheels), period_(period) {}

  void start(int max_cycles) {
    driver_->start();
    frame_ = {};
    for (int i = 0; i < max_cycles && frame_.driver_state != DriverState::kRunning; ++i) cycles(1);
  }

  double period_;
  SensorFrame frame_;
  std::unique_ptr<Board> board_;
  std::unique_ptr<Inner> driver_;
};

}  // namespace robot_control

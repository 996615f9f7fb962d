#pragma once
/// A SerialFront is a DeviceFront that is one board on a serial line, with the wheels of a robot behind it. The line is
/// one in virtual time, or the board stands before the device's end of a true one.
///
/// `inject` takes the component `line` with the kinds of virtual_serial.h, and those of the board.

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "drivers/drive/device_front.h"
#include "drivers/line/virtual_serial.h"

namespace robot_control {

/// The board stands on a line in virtual time with this seed, or before the device's end of a true one.
struct FrontLine {
  FrontLine(std::uint64_t line_seed) : seed(line_seed) {}  // NOLINT(*-explicit-*)
  template <class Line>
  FrontLine(std::unique_ptr<Line> device_end) : true_end(std::move(device_end)) {}  // NOLINT(*-explicit-*)
  FrontLine(FrontSetup setup) : seed(setup.seed) {                                  // NOLINT(*-explicit-*)
    if (setup.line) true_end = std::get<std::unique_ptr<SerialLine>>(std::move(*setup.line));
  }

  std::uint64_t seed = 0;
  std::unique_ptr<SerialLine> true_end;
};

class SerialFront : public DeviceFront {
 public:
  static constexpr std::int64_t kStepNs = 250'000;      ///< between two steps of the board
  static constexpr std::int64_t kBootNs = 300'000'000;  ///< in which a board that restarts is silent

  std::size_t size() const override { return motions_.size(); }
  std::int64_t now_ns() const override { return now_ns_; }
  void run(std::span<const JointSample> joints) override;
  double torque(std::size_t joint) const override { return motions_.at(joint).mean_torque; }
  std::string inject(std::string_view component, std::string_view kind) override;

  LineEnd driver_end() override { return virtual_line_->driver_end(); }

  /// The line in virtual time.
  VirtualSerial& line() { return *virtual_line_; }

 protected:
  struct Motion {
    double position = 0;  ///< rad, of the joint
    double velocity = 0;
    double mean_torque = 0;  ///< N·m, over the period
  };

  /// `bit_rate` in bit/s, of a line in virtual time; 0: USB.
  SerialFront(std::size_t wheels, double period, std::uint64_t bit_rate, FrontLine line);

  /// Runs the board at `now_ns`, with the bytes that arrived.
  virtual void step_board() = 0;
  /// Returns the torque of a joint until the next step, N·m.
  virtual double step_wheel(std::size_t joint, double seconds) = 0;
  /// Returns whether it has this component and kind.
  virtual bool inject_board(std::string_view component, std::string_view kind) = 0;
  /// Returns the components and kinds of `inject_board` in words.
  virtual std::string fault_words() const = 0;

  const Motion& motion(std::size_t joint) const { return motions_[joint]; }
  SerialLine& board_line() { return virtual_line_ ? virtual_line_->device_end() : *true_line_; }
  std::int64_t period_ns() const { return period_ns_; }
  bool booting() const { return now_ns_ < boots_ns_; }

  std::int64_t boots_ns_ = 0;  ///< The board is silent until then.
  bool off_ = false;

 private:
  std::vector<Motion> motions_;  // in the order of the joints
  std::int64_t period_ns_;
  std::unique_ptr<SerialLine> true_line_;
  std::unique_ptr<VirtualSerial> virtual_line_;  // null: the true one
  std::int64_t now_ns_ = 0;
};

}  // namespace robot_control

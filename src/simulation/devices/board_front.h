#pragma once
/// A BoardFront is a motor board before the motors of a simulated robot, at the device's end of a serial line. Its code
/// is that of `firmware/`. For a board that takes speeds that code runs its own speed loop, and the motors are those of
/// direct current: torque = kStall · limit · (pwm − speed/(kFree · speed limit)), within the torque limit.
///
/// `inject` takes `board` or `line` as the component; the line has faults in virtual time alone.
///
///   board  ok | off | reset, brown_out (silent for kBootNs, counts from 0) | fault (of its wheel 0) | other_protocol
///          e_stop (the button is pressed, or its wire is broken)
///   line   kSerialFaultWords

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "drivers/serial/board_parameters.h"
#include "firmware/board.h"
#include "gate/brake_law.h"
#include "simulation/devices/device_front.h"
#include "simulation/devices/virtual_serial.h"

namespace robot_control {

class BoardFront final : public DeviceFront {
 public:
  static constexpr std::int64_t kStepNs = 250'000;      ///< between two calls of the board's main loop
  static constexpr std::int64_t kBootNs = 300'000'000;  ///< in which a board that restarts is silent
  static constexpr double kClockPpm = 200;              ///< by which its clock runs fast
  static constexpr double kStall = 2;                   ///< torque at rest, of the limit
  static constexpr double kFree = 1.5;                  ///< speed without load, of the limit
  static constexpr double kIntegralTime = 0.08;         ///< s, of the speed loop

  /// Before a line in virtual time.
  BoardFront(const BoardParameters& parameters, std::span<const Brake> brakes, double period, std::uint64_t seed);

  /// Before the device's end of a true line.
  BoardFront(const BoardParameters& parameters, std::span<const Brake> brakes, double period,
             std::unique_ptr<SerialLine> line);
  BoardFront(const BoardFront&) = delete;
  BoardFront& operator=(const BoardFront&) = delete;

  std::size_t size() const override { return wheels_.size(); }
  std::int64_t now_ns() const override { return now_ns_; }
  void run(std::span<const JointSample> joints) override;
  double torque(std::size_t joint) const override { return wheels_.at(joint).mean_torque; }
  std::string inject(std::string_view component, std::string_view kind) override;

  /// Returns the driver's end of the line in virtual time.
  std::unique_ptr<SerialLine> driver_end() { return virtual_line_->driver_end(); }

  /// The line in virtual time.
  VirtualSerial& line() { return *virtual_line_; }

  /// Returns the measurements beside counts and torques; a test may set them.
  board_sensors& sensors() noexcept { return sensors_; }

  /// Lets the counters begin at this number.
  void set_zero(std::uint32_t counts) noexcept { zero_ = counts; }

 private:
  struct Wheel {
    BrakeLaw brake;
    double damping = 0;   // N·m·s/rad, of the brake
    double position = 0;  // rad, of the joint
    double velocity = 0;
    std::int64_t start = 0;  // counts at the last boot
    double torque = 0;       // N·m, of the joint
    double mean_torque = 0;
    board_mode mode = BOARD_BRAKE;
    double ordered = 0;  // N·m or a share of the supply, of the joint
  };

  void boot(board_reset reason);
  void tune(board_config& config) const;
  void run_board();
  std::size_t joint_of(std::size_t wheel) const;
  std::uint32_t time_us() const;
  std::int64_t counted(std::size_t joint) const;  // since the beginning
  void counts(std::uint32_t* counts) const;
  void drive(std::size_t wheel, board_mode mode, std::int32_t value);
  void read_sensors(board_sensors& sensors) const;
  void write(std::span<const std::uint8_t> bytes);
  double ordered_torque(std::size_t joint) const;

  BoardParameters parameters_;
  std::vector<Wheel> wheels_;  // in the order of the joints
  std::int64_t period_ns_;
  std::unique_ptr<VirtualSerial> virtual_line_;
  std::unique_ptr<SerialLine> true_line_;
  SerialLine& line_;
  board board_{};
  board_sensors sensors_{};
  std::uint32_t zero_ = 0;
  std::int64_t now_ns_ = 0;
  std::int64_t boots_ns_ = 0;   // the board is silent until then
  std::int64_t booted_ns_ = 0;  // zero of its clock
  board_reset next_reset_ = BOARD_POWER_ON;
  bool off_ = false;
  bool fault_ = false;
  bool other_protocol_ = false;
};

}  // namespace robot_control

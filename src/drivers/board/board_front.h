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

#include <span>
#include <string>
#include <vector>

#include "drivers/board/board_parameters.h"
#include "drivers/drive/serial_front.h"
#include "firmware/board.h"
#include "gate/brake_law.h"

namespace robot_control {

class BoardFront final : public SerialFront {
 public:
  static constexpr double kClockPpm = 200;       ///< by which its clock runs fast
  static constexpr double kStall = 2;            ///< torque at rest, of the limit
  static constexpr double kFree = 1.5;           ///< speed without load, of the limit
  static constexpr double kIntegralTime = 0.08;  ///< s, of the speed loop

  BoardFront(const BoardParameters& parameters, std::span<const Brake> brakes, double period, FrontLine line);
  BoardFront(const BoardFront&) = delete;
  BoardFront& operator=(const BoardFront&) = delete;

  /// Returns the measurements beside counts and torques; a test may set them.
  board_sensors& sensors() noexcept { return sensors_; }

  /// Lets the counters begin at this number.
  void set_zero(std::uint32_t counts) noexcept { zero_ = counts; }

 private:
  struct Wheel {
    BrakeLaw brake;
    double damping = 0;      // N·m·s/rad, of the brake
    std::int64_t start = 0;  // counts at the last boot
    double torque = 0;       // N·m, of the joint
    board_mode mode = BOARD_BRAKE;
    double ordered = 0;  // N·m or a share of the supply, of the joint
  };

  void boot(board_reset reason);
  void tune(board_config& config) const;
  void step_board() override;
  double step_wheel(std::size_t joint, double seconds) override;
  bool inject_board(std::string_view component, std::string_view kind) override;
  std::string fault_words() const override {
    return "board (with ok, off, reset, brown_out, fault, e_stop, other_protocol)";
  }
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
  board board_{};
  board_sensors sensors_{};
  std::uint32_t zero_ = 0;
  std::int64_t booted_ns_ = 0;  // zero of its clock
  board_reset next_reset_ = BOARD_POWER_ON;
  bool fault_ = false;
  bool other_protocol_ = false;
};

}  // namespace robot_control

#pragma once
/// A RoboclawFront is a RoboClaw before the two motors of a simulated robot, at the device's end of a serial line.
///
/// Each wheel has a PI loop of its own, whose torque is bounded by the motor's. A duty of zero, and the serial timeout,
/// short the motors: they brake without a torque at rest. Without counts the loop drives with all its torque.
///
/// `inject` takes `board`, `encoder` or `line` as the component; the line has faults in virtual time alone
/// (`SerialFaults`).
///
///   board    ok | off | reset, brown_out (silent for kBootNs, counts from 0) | fault (over-temperature)
///            | no_gains (at the next start)
///   encoder  ok | stuck (that of M1)

#include <span>
#include <string>
#include <vector>

#include "drivers/drive/serial_front.h"
#include "drivers/drive/speed_loop.h"
#include "drivers/roboclaw/roboclaw_parameters.h"
#include "drivers/roboclaw/roboclaw_protocol.h"
#include "gate/brake_law.h"

namespace robot_control {

class RoboclawFront final : public SerialFront {
 public:
  /// `effort_limits` are those of the motors at the joints, N·m.
  RoboclawFront(const RoboclawParameters& parameters, std::span<const Brake> brakes,
                std::span<const double> effort_limits, double period, FrontLine line);
  RoboclawFront(const RoboclawFront&) = delete;
  RoboclawFront& operator=(const RoboclawFront&) = delete;

 private:
  struct Wheel {
    double damping = 0;  // N·m·s/rad
    double limit = 0;    // N·m
    double zero = 0;     // rad, at which the counts are 0
    double wanted = 0;   // rad/s, of the joint
    SpeedLoop speed_loop{};
    std::int32_t stuck = 0;
    bool driven = false;  // by a speed
  };

  void receive_byte(std::uint8_t byte);
  void obey();
  void stop() {
    for (Wheel& wheel : wheels_) wheel.driven = false;
  }
  void answer(roboclaw::Packet data);
  std::int32_t counts(std::size_t wheel) const;
  void step_board() override;
  double step_wheel(std::size_t joint, double seconds) override;
  bool inject_board(std::string_view component, std::string_view kind) override;
  std::string fault_words() const override {
    return "board (with ok, off, reset, brown_out, fault, no_gains), encoder (with ok, stuck)";
  }
  std::size_t joint_of(std::size_t motor) const;

  RoboclawParameters parameters_;
  std::vector<Wheel> wheels_;  // in the order of the joints
  roboclaw::Packet request_;
  std::int64_t request_ns_ = 0;  // of the newest good one
  std::int64_t byte_ns_ = 0;     // of the newest bytes
  std::uint8_t timeout_ = 0;     // 100 ms; 0: none
  bool fault_ = false, gains_ = true, stuck_ = false;
};

}  // namespace robot_control

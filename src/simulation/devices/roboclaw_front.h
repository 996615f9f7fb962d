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

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "drivers/serial/roboclaw_parameters.h"
#include "drivers/serial/roboclaw_protocol.h"
#include "gate/brake_law.h"
#include "simulation/devices/device_front.h"
#include "simulation/devices/speed_loop.h"
#include "simulation/devices/virtual_serial.h"

namespace robot_control {

class RoboclawFront final : public DeviceFront {
 public:
  static constexpr std::int64_t kStepNs = 250'000;
  static constexpr std::int64_t kBootNs = 300'000'000;  ///< in which a board that restarts is silent

  /// Before a line in virtual time. `effort_limits` are those of the motors at the joints, N·m.
  RoboclawFront(const RoboclawParameters& parameters, std::span<const Brake> brakes,
                std::span<const double> effort_limits, double period, std::uint64_t seed);

  /// Before the device's end of a true line.
  RoboclawFront(const RoboclawParameters& parameters, std::span<const Brake> brakes,
                std::span<const double> effort_limits, double period, std::unique_ptr<SerialLine> line);
  RoboclawFront(const RoboclawFront&) = delete;
  RoboclawFront& operator=(const RoboclawFront&) = delete;

  std::size_t size() const override { return wheels_.size(); }
  std::int64_t now_ns() const override { return now_ns_; }
  void run(std::span<const JointSample> joints) override;
  double torque(std::size_t joint) const override { return wheels_.at(joint).mean_torque; }
  std::string inject(std::string_view component, std::string_view kind) override;

  /// Returns the driver's end of the line in virtual time.
  std::unique_ptr<SerialLine> driver_end() { return virtual_line_->driver_end(); }

 private:
  struct Wheel {
    double damping = 0;  // N·m·s/rad
    double limit = 0;    // N·m
    double position = 0, velocity = 0;
    double zero = 0;      // rad, at which the counts are 0
    double wanted = 0;    // rad/s, of the joint
    SpeedLoop speed_loop{};
    double mean_torque = 0;
    std::int32_t stuck = 0;
    bool driven = false;  // by a speed
  };

  void add_wheels(std::span<const Brake> brakes, std::span<const double> effort_limits);
  void receive_byte(std::uint8_t byte);
  void obey();
  void stop();
  void answer(roboclaw::Packet data);
  std::int32_t counts(std::size_t wheel) const;
  double step_wheel(Wheel& wheel, std::size_t index, double seconds) const;
  std::size_t joint_of(std::size_t motor) const;

  RoboclawParameters parameters_;
  std::vector<Wheel> wheels_;  // in the order of the joints
  std::int64_t period_ns_;
  std::unique_ptr<VirtualSerial> virtual_line_;
  std::unique_ptr<SerialLine> true_line_;
  SerialLine& line_;
  roboclaw::Packet request_;
  std::int64_t now_ns_ = 0;
  std::int64_t boots_ns_ = 0;    // silent until then
  std::int64_t request_ns_ = 0;  // of the newest good one
  std::uint8_t timeout_ = 0;     // 100 ms; 0: none
  bool off_ = false, fault_ = false, gains_ = true, stuck_ = false;
};

}  // namespace robot_control

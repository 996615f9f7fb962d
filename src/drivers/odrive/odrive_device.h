#pragma once
/// An ODrive axis as a device, with firmware 0.5 or 0.6: CANSimple, the states idle and closed loop, torque mode with
/// the limits of current and velocity, and the watchdog. Other modes of control give no torque.
///
/// It keeps its last set-point in idle. In closed loop it releases the motor above 1.2 times its velocity limit. Its
/// velocity limit reduces the torque from below the limit on, as enable_torque_mode_vel_limit does, with the gain of
/// the speed. An expired watchdog releases the motor, as every error does. With 0.5 any frame to the axis feeds the
/// watchdog, also in idle; with 0.6 it runs in closed loop alone.

#include <cstdint>
#include <optional>

#include "drivers/drive/device.h"
#include "drivers/drive/speed_loop.h"
#include "drivers/odrive/odrive_messages.h"
#include "drivers/odrive/odrive_parameters.h"

namespace robot_control {

struct OdriveDeviceParameters {
  std::uint8_t node = 0;
  odrive::Firmware firmware = odrive::Firmware::k06;
  std::uint64_t serial_number = 0x1234;
  double torque_constant = 0.1;   ///< N·m/A
  double counts_per_turn = 8192;  ///< of the encoder
  double heartbeat_period = 0.1;  ///< s
  double estimates_period = 0;    ///< s; 0: on request alone
  double effort_period = 0;       ///< s; 0: on request alone
  double watchdog_timeout = 0;    ///< s; 0: off
  std::uint16_t enable_watchdog_endpoint = 0;
  std::uint16_t watchdog_timeout_endpoint = 0;
  double speed_gain = 0;  ///< N·m·s/rad, of velocity mode (speed_loop.h)
  double clock_ppm = 0;
};

class OdriveDevice final : public Device {
 public:
  OdriveDevice(const OdriveDeviceParameters& parameters, VirtualCan& bus, DeviceMotor& motor);

  odrive::AxisState state() const { return state_; }
  double set_point() const { return input_torque_; }

 private:
  void boot() override;
  void begin_fault() override;
  void receive(const can_frame& frame, std::int64_t now_ns) override;
  void run(std::int64_t now_ns, double seconds) override;
  void receive_request(const can_frame& frame);
  void receive_command(const can_frame& frame);
  void receive_sdo(const can_frame& frame);
  void fail(std::uint32_t error);
  void report_fault();  ///< An error that is still there comes again when the axis closes its loop.
  void clear_errors();
  double measured_position() const;
  double driven_torque(double seconds);
  void send_heartbeat();
  void send_estimates();
  void send_current();
  void send_torques();
  template <class Message>
  void send(const Message& message) {
    transmit(odrive::encode(parameters_.node, message));
  }
  template <class Message>
  bool requests(const can_frame& frame) const {
    return odrive::command_of(frame) == Message::kCommand.number;
  }
  bool is_06() const { return parameters_.firmware == odrive::Firmware::k06; }

  OdriveDeviceParameters parameters_;
  DeviceMotor& motor_;
  DeviceTimer heartbeat_timer_, estimates_timer_, effort_timer_, watchdog_timer_;
  odrive::AxisState state_ = odrive::AxisState::kIdle;
  std::uint32_t error_ = 0, disarm_reason_ = 0;
  std::uint64_t motor_error_ = 0;
  std::uint32_t encoder_error_ = 0, controller_error_ = 0;
  odrive::SetControllerMode mode_{.control = odrive::ControlMode::kPosition};  // the maker's default
  std::optional<odrive::SetVelocityGains> gains_;                              // as they were set
  double input_torque_ = 0;
  double input_velocity_ = 0;  // rad/s
  SpeedLoop speed_loop_;
  double velocity_limit_ = 2 * odrive::kTurn;  // rad/s, the maker's default
  double current_limit_ = 10;                  // A, the maker's default
  double zero_ = 0;                            // rad, true position of the device's zero
};

}  // namespace robot_control

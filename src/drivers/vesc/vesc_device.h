#pragma once
/// A VESC as a device: currents, speeds, the CAN status messages 1, 4 and 5, and the timeout with its brake current.
///
/// It keeps its last order until the timeout, which every order feeds; then it brakes with the brake current. An error
/// releases the motor, is not on the bus, and ends kFaultNs after its cause. The speed loop works down to the speed
/// zero: s_pid_min_erpm is 0.

#include <cstdint>

#include "drivers/drive/device.h"
#include "drivers/drive/speed_loop.h"
#include "drivers/vesc/vesc_messages.h"

namespace robot_control {

struct VescDeviceParameters {
  std::uint8_t node = 0;
  double pole_pairs = 7;
  double torque_constant = 0.1;                   ///< N·m/A
  double max_current = 20;                        ///< A
  double status_period = 0.002;                   ///< s
  double temperature_period = 0.1;                ///< s
  double timeout = 0.1;                           ///< s
  double brake_current = 0;                       ///< A, after the timeout
  double counts_per_turn = vesc::kCountsPerTurn;  ///< of the tachometer, per electrical turn
  double speed_gain = 0;                          ///< N·m·s/rad, of the speed loop and of the brake near rest
  double clock_ppm = 0;
};

class VescDevice final : public Device {
 public:
  static constexpr std::int64_t kFaultNs = 500'000'000;  ///< m_fault_stop_time_ms

  VescDevice(const VescDeviceParameters& parameters, VirtualCan& bus, DeviceMotor& motor);

 private:
  enum class Order : std::uint8_t { kNone, kCurrent, kBrake, kSpeed };

  void boot() override;
  void begin_fault() override;
  void receive(const can_frame& frame, std::int64_t now_ns) override;
  void run(std::int64_t now_ns, double seconds) override;
  void obey(Order order, double value);
  double driven_torque(double seconds);
  void send_statuses();
  void send_temperature();
  template <class Message>
  void send(const Message& message) {
    transmit(vesc::encode(parameters_.node, message));
  }

  VescDeviceParameters parameters_;
  DeviceMotor& motor_;
  DeviceTimer status_timer_, temperature_timer_, timeout_timer_;
  std::int64_t released_ns_ = 0;  // The motor is released until then.
  Order order_ = Order::kNone;
  double value_ = 0;  // A, or rad/s of the motor
  SpeedLoop speed_loop_;
  double zero_ = 0;  // rad, true position of the device's zero
};

}  // namespace robot_control

#pragma once
/// A simulated motor drive on a VirtualCan. Its motor is given: the device reads position and velocity, and sets the
/// torque. It has its own clock, which runs fast by `clock_ppm`, and no other knowledge of the simulation.

#include <cmath>
#include <cstdint>
#include <vector>

#include "drivers/line/virtual_can.h"
#include "parameters/block.h"

namespace robot_control {

/// The shaft of a motor.
struct DeviceMotor {
  double position = 0;  ///< rad, true
  double velocity = 0;  ///< rad/s, true
  double torque = 0;    ///< N·m, set by the device
};

enum class DeviceFault : std::uint8_t {
  kNone,          ///< healthy again; a device that was off boots
  kOff,           ///< no supply: no frame, no torque
  kUnplugged,     ///< no line: no frame, the motor control goes on
  kReset,         ///< The device boots again, once.
  kOtherZero,     ///< Its position continues from another zero, once.
  kSlipped,       ///< The encoder slips on its shaft: another zero, and the commutation is wrong (ODrive alone).
  kEncoder,       ///< The device reports an error of its encoder and releases the motor.
  kReleased,      ///< The device releases the motor without an error, once.
  kHot,           ///< 120 °C; the motor keeps its torque
  kUnderVoltage,  ///< The device reports that its supply is too low, and releases the motor.
  kNotFinite,     ///< The measured velocity is NaN, where the protocol has floats.
};

/// The words of `~inject_fault`.
inline std::vector<Word> words_of(DeviceFault) {
  using enum DeviceFault;
  return {{"ok", kNone},
          {"off", kOff},
          {"unplugged", kUnplugged},
          {"reset", kReset},
          {"other_zero", kOtherZero},
          {"slipped", kSlipped},
          {"encoder", kEncoder},
          {"released", kReleased},
          {"hot", kHot},
          {"under_voltage", kUnderVoltage},
          {"not_finite", kNotFinite}};
}

class Device {
 public:
  static constexpr std::int64_t kBootNs = 300'000'000;
  static constexpr double kOtherZero = 7.0;  ///< rad

  virtual ~Device() = default;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  /// Runs the device until `now_ns`: its timers, its state machine, and its motor control once.
  void step(std::int64_t now_ns) {
    const double seconds = 1.0e-9 * static_cast<double>(now_ns - now_ns_);
    now_ns_ = now_ns;
    if (powered(now_ns)) run(now_ns, seconds);
  }
  void inject(DeviceFault fault) {
    const bool boots = fault == DeviceFault::kReset || (fault_ == DeviceFault::kOff && fault != DeviceFault::kOff);
    if (boots) reboot();
    fault_ = fault;
    begin_fault();
  }

 protected:
  explicit Device(VirtualCan& bus)
      : bus_(bus), party_(bus.join([this](const can_frame& frame, std::int64_t now_ns) {
          if (connected(now_ns)) receive(frame, now_ns);
        })) {}

  /// The device is silent for kBootNs.
  void reboot() {
    boot_ns_ = bus_.now_ns() + kBootNs;
    boot();
  }
  void transmit(const can_frame& frame) {
    if (connected(bus_ns())) bus_.send(party_, frame);
  }
  DeviceFault fault() const { return fault_; }
  /// Time of the bus, which is ahead of the last step while frames arrive.
  std::int64_t bus_ns() const { return bus_.now_ns(); }
  /// Time of the last step.
  std::int64_t now_ns() const { return now_ns_; }

 private:
  bool powered(std::int64_t now_ns) const { return fault_ != DeviceFault::kOff && now_ns >= boot_ns_; }
  bool connected(std::int64_t now_ns) const { return powered(now_ns) && fault_ != DeviceFault::kUnplugged; }
  virtual void boot() = 0;
  virtual void begin_fault() = 0;
  virtual void receive(const can_frame& frame, std::int64_t now_ns) = 0;
  virtual void run(std::int64_t now_ns, double seconds) = 0;  // `seconds` since the last step

  VirtualCan& bus_;
  std::size_t party_;
  DeviceFault fault_ = DeviceFault::kNone;
  std::int64_t now_ns_ = 0;
  std::int64_t boot_ns_ = 0;
};

/// A timer of a device: it expires each `period` s of the device's own clock.
class DeviceTimer {
 public:
  /// A period of 0 never expires.
  explicit DeviceTimer(double period = 0, double clock_ppm = 0, double phase = 0)
      : period_ns_(std::llround(1.0e9 * period / (1 + 1.0e-6 * clock_ppm))),
        next_ns_(std::llround(1.0e9 * period * phase)) {}

  bool expired(std::int64_t now_ns) {
    if (period_ns_ == 0 || now_ns < next_ns_) return false;
    next_ns_ += period_ns_ * (1 + (now_ns - next_ns_) / period_ns_);
    return true;
  }
  void restart(std::int64_t now_ns) { next_ns_ = now_ns + period_ns_; }

 private:
  std::int64_t period_ns_;
  std::int64_t next_ns_;
};

}  // namespace robot_control

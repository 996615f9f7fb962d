#pragma once
/// Messages of a Go1 whose every member is random, for tests.

#include <random>

#include "drivers/unitree_legged/legged_messages.h"

namespace robot_control::unitree {

class RandomMessages {
 public:
  explicit RandomMessages(std::uint64_t seed) : random_(seed) {}

  LowCmd command() {
    LowCmd command;
    fill(command.head);
    for (MotorCommand& motor : command.motors) {
      fill(motor.mode);
      motor.q = number(1000);
      motor.dq = number(1000);
      motor.tau = fixed(256);
      motor.kp = fixed(32);
      motor.kd = fixed(16);
      fill(motor.reserve);
    }
    fill(command.bms);
    fill(command.remote);
    fill(command.reserve);
    return command;
  }

  LowState state() {
    LowState state;
    fill(state.head);
    for (float& value : state.imu.quaternion) value = number(1);
    for (float& value : state.imu.gyroscope) value = number(30);
    for (float& value : state.imu.accelerometer) value = number(100);
    for (float& value : state.imu.rpy) value = number(3);
    fill(state.imu.temperature);
    for (MotorState& motor : state.motors) {
      fill(motor.mode);
      motor.q = number(10);
      motor.dq = number(30);
      fill(motor.ddq);
      motor.tau = fixed(256);
      motor.q_raw = number(10);
      motor.dq_raw = number(30);
      fill(motor.ddq_raw);
      fill(motor.temperature);
      fill(motor.reserve);
    }
    fill(state.battery.version_high);
    fill(state.battery.version_low);
    fill(state.battery.status);
    state.battery.charge = static_cast<std::uint8_t>(random_() % 101);
    fill(state.battery.current);
    fill(state.battery.cycles);
    fill(state.battery.bq_temperature);
    fill(state.battery.mcu_temperature);
    fill(state.battery.cells);
    fill(state.foot_force);
    fill(state.foot_force_estimate);
    fill(state.tick);
    fill(state.remote);
    fill(state.reserve);
    return state;
  }

  std::uint64_t raw() { return random_(); }

 private:
  template <class Value>
  void fill(Value& value) {
    if constexpr (requires { value.begin(); }) {
      for (auto& each : value) fill(each);
    } else {
      value = static_cast<Value>(random_());
    }
  }
  void fill(LegHead& head) {
    fill(head.reserve);
    fill(head.serial_number);
    fill(head.version);
    fill(head.band_width);
  }
  float number(float maximum) { return std::uniform_real_distribution<float>(-maximum, maximum)(random_); }
  double fixed(double steps) { return static_cast<std::int16_t>(random_()) / steps; }

  std::mt19937_64 random_;
};

}  // namespace robot_control::unitree

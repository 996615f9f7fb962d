#pragma once
/// Messages of a Go2 whose every member is random, for tests.

#include <cstring>
#include <random>

#include "drivers/unitree_go/go_messages.h"

namespace robot_control::unitree::go {

class RandomMessages {
 public:
  explicit RandomMessages(std::uint64_t seed) : random_(seed) {}

  LowCmd command() {
    LowCmd command;
    fill(command.head);
    for (MotorCommand& motor : command.motors) {
      fill(motor.mode);
      fill(motor.q);
      fill(motor.dq);
      motor.tau = double{number()};
      motor.kp = double{number()};
      motor.kd = double{number()};
      fill(motor.reserve);
    }
    fill(command.bms);
    fill(command.remote);
    fill(command.led);
    fill(command.fan);
    fill(command.gpio);
    fill(command.reserve);
    return command;
  }

  LowState state() {
    LowState state;
    fill(state.head);
    fill(state.imu.quaternion);
    fill(state.imu.gyroscope);
    fill(state.imu.accelerometer);
    fill(state.imu.rpy);
    fill(state.imu.temperature);
    for (MotorState& motor : state.motors) {
      fill(motor.mode);
      fill(motor.q);
      fill(motor.dq);
      fill(motor.ddq);
      motor.tau = double{number()};
      fill(motor.q_raw);
      fill(motor.dq_raw);
      fill(motor.ddq_raw);
      fill(motor.temperature);
      fill(motor.lost);
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
    fill(state.flags);
    fill(state.reel);
    fill(state.board_temperature);
    fill(state.voltage);
    fill(state.current);
    for (std::uint16_t& fan : state.fans) fan = static_cast<std::uint16_t>(random_() % 32768);  // as for temperatures
    fill(state.reserve);
    return state;
  }

  std::uint64_t raw() { return random_(); }

 private:
  template <class Value>
  void fill(Value& value) {
    if constexpr (requires { value.begin(); }) {
      for (auto& each : value) fill(each);
    } else if constexpr (std::is_floating_point_v<Value>) {
      value = number();
    } else if constexpr (std::is_same_v<Value, std::int8_t>) {
      value = static_cast<std::int8_t>(random_() % 128);  // above, the maker's library reads another number
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
  float number() { return std::uniform_real_distribution<float>(-1000, 1000)(random_); }

  std::mt19937_64 random_;
};

/// Gives the bytes of a message a right check sum again.
inline void seal(std::span<std::uint8_t> bytes) {
  const std::uint32_t sum = check_sum(bytes.first(bytes.size() - 4));
  std::memcpy(bytes.data() + bytes.size() - 4, &sum, 4);
}

}  // namespace robot_control::unitree::go

/// Our messages of a Go1 for the maker's own library (tests/drivers/test_leg_peers_udp.py). A message is printed as its
/// numbers in the order of the bytes.
///
///   legged_peer commands        each line of the input is a LowCmd in hexadecimal; prints its numbers, or `refused`
///   legged_peer states COUNT    prints random states, two lines each: the bytes in hexadecimal, the numbers

#include <iomanip>
#include <iostream>
#include <string>
#include <vector>

#include "drivers/unitree_legged/random_messages.h"

namespace robot_control::unitree {
namespace {

template <class... Values>
void print(const Values&... values) {
  const auto print_one = []<class Value>(const Value& value) {
    if constexpr (requires { value.begin(); }) {
      for (const auto& each : value) std::cout << +each << " ";
    } else {
      std::cout << +value << " ";
    }
  };
  (print_one(values), ...);
}

void print_head(const LegHead& head) {
  print(head.level, head.reserve, head.serial_number, head.version, head.band_width);
}

void print_command(const LowCmd& command) {
  print_head(command.head);
  for (const MotorCommand& motor : command.motors)
    print(motor.mode, motor.q, motor.dq, motor.tau, motor.kp, motor.kd, motor.reserve);
  print(command.bms, command.remote, command.reserve);
}

void print_state(const LowState& state) {
  print_head(state.head);
  print(state.imu.quaternion, state.imu.gyroscope, state.imu.accelerometer, state.imu.rpy, state.imu.temperature);
  for (const MotorState& motor : state.motors)
    print(motor.mode, motor.q, motor.dq, motor.ddq, motor.tau, motor.q_raw, motor.dq_raw, motor.ddq_raw,
          motor.temperature, motor.reserve);
  const LegBattery& battery = state.battery;
  print(battery.version_high, battery.version_low, battery.status, battery.charge, battery.current, battery.cycles,
        battery.bq_temperature, battery.mcu_temperature);
  for (const std::uint8_t cell : battery.cells) print(1000 * kCellVoltage * cell);
  print(state.foot_force, state.foot_force_estimate, state.tick, state.remote, state.reserve);
}

void decode_commands() {
  for (std::string line; std::getline(std::cin, line);) {
    std::vector<std::uint8_t> bytes;
    for (std::size_t i = 0; i + 1 < line.size(); i += 2)
      bytes.push_back(static_cast<std::uint8_t>(std::stoul(line.substr(i, 2), nullptr, 16)));
    LowCmd command;
    if (decode(bytes, command) == Flaw::kNone) {
      print_command(command);
    } else {
      std::cout << "refused";
    }
    std::cout << "\n";
  }
}

void print_states(int count) {
  RandomMessages random(8007);
  for (int i = 0; i < count; ++i) {
    const LowState state = random.state();
    std::array<std::uint8_t, kStateBytes> bytes{};
    encode(state, bytes);
    for (const unsigned byte : bytes) std::cout << "0123456789abcdef"[byte / 16] << "0123456789abcdef"[byte % 16];
    std::cout << "\n";
    print_state(state);
    std::cout << "\n";
  }
}

}  // namespace
}  // namespace robot_control::unitree

int main(int argc, char** argv) {
  std::cout << std::setprecision(17);
  if (argc == 3) {
    robot_control::unitree::print_states(std::stoi(argv[2]));
  } else {
    robot_control::unitree::decode_commands();
  }
}

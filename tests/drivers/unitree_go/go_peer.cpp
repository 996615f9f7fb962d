/// Our messages, driver and simulated robot of a Go2 for the maker's own library (tests/drivers/test_leg_peers_dds.py).
///
///   go_peer commands              each line of the input is a LowCmd in hexadecimal; prints its numbers, or `refused`
///   go_peer states COUNT          prints random states, two lines each: the bytes in hexadecimal, the numbers
///   go_peer robot DRIVE_FILE      a simulated robot in the air; prints the angles of its motors at 50 Hz
///   go_peer driver DRIVE_FILE     a driver that turns the joints at 1 rad/s; prints each change of its state, after the
///                                 time in ns
///
/// The drive file has the joints joint_0 … joint_11.

#include <csignal>
#include <iomanip>
#include <iostream>
#include <string>
#include <vector>

#include "drivers/table/read_drive_file.h"
#include "drivers/unitree/unitree_driver.h"
#include "drivers/unitree/unitree_front.h"
#include "drivers/unitree_go/random_messages.h"
#include "drivers/unitree_go/unitree_go_file.h"
#include "rt/clock.h"

namespace robot_control::unitree::go {
namespace {

constexpr double kRate = 500;  // Hz
constexpr std::int64_t kPeriodNs = 2'000'000;

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
  print(command.bms, command.remote, command.led, command.fan, command.gpio, command.reserve);
}

void print_state(const LowState& state) {
  print_head(state.head);
  print(state.imu.quaternion, state.imu.gyroscope, state.imu.accelerometer, state.imu.rpy, state.imu.temperature);
  for (const MotorState& motor : state.motors)
    print(motor.mode, motor.q, motor.dq, motor.ddq, motor.tau, motor.q_raw, motor.dq_raw, motor.ddq_raw,
          motor.temperature, motor.lost, motor.reserve);
  const Battery& battery = state.battery;
  print(battery.version_high, battery.version_low, battery.status, battery.charge, battery.current, battery.cycles,
        battery.bq_temperature, battery.mcu_temperature, battery.cells);
  print(state.foot_force, state.foot_force_estimate, state.tick, state.remote, state.flags, state.reel,
        state.board_temperature, state.voltage, state.current, state.fans, state.reserve);
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

std::unique_ptr<DriveFile> read(const std::string& path) {
  std::vector<std::string> joints;
  for (std::size_t i = 0; i < kRobotMotors; ++i) joints.push_back("joint_" + std::to_string(i));
  return read_drive_file(path, "unitree_go", {.joints = joints, .rate = kRate});
}

void run_robot(const std::string& path) {
  constexpr double kInertia = 0.05;  // kg·m²
  const auto file = read(path);
  const auto& parameters = dynamic_cast<const UnitreeGoFile&>(*file).parameters();
  UnitreeFront<Go2> robot(parameters, 1 / kRate, 1, UdpSocket::device_end(file->address()));
  std::vector<JointSample> joints(robot.size());
  std::int64_t next_ns = monotonic_ns();
  for (int cycle = 0;; ++cycle) {
    robot.run(joints);
    for (std::size_t i = 0; i < joints.size(); ++i) {
      joints[i].velocity += robot.torque(i) / kInertia / kRate;
      joints[i].position += joints[i].velocity / kRate;
    }
    if (cycle % 10 == 0) {
      for (const JointSample& joint : joints) std::cout << joint.position << " ";
      std::cout << std::endl;
    }
    sleep_until(next_ns += kPeriodNs);
  }
}

void run_driver(const std::string& path) {
  const auto file = read(path);
  const std::size_t count = file->request().joints.size();
  const Brake brake{.effort = 3, .hold_effort = 3, .damping = 3, .stiffness = 20, .hold_speed = 0.3};
  const DriveMotors motors{.joints = file->request().joints,
                           .effort_limits = std::vector(count, 20.0),
                           .brakes = std::vector(count, brake),
                           .joint_count = count};
  const auto driver = file->make_driver(motors, file->open_line(RealtimePolicy::kOff, {}),
                                        [] { return CanTime{.time_ns = monotonic_ns()}; });
  const std::vector commands(count, JointCommand{.mode = JointMode::kVelocity, .velocity = 1, .damping = 1});
  SensorFrame frame;
  std::string last;
  driver->start();
  std::int64_t next_ns = monotonic_ns();
  while (true) {
    driver->read(frame);
    driver->write(commands);
    const std::string now = frame.driver_state == DriverState::kRunning ? "running" : driver->warning();
    if (now != last) std::cout << monotonic_ns() << " " << now << std::endl;
    last = now;
    sleep_until(next_ns += kPeriodNs);
  }
}

}  // namespace
}  // namespace robot_control::unitree::go

int main(int argc, char** argv) {
  namespace go = robot_control::unitree::go;
  std::cout << std::setprecision(17);
  const std::string mode = argc > 1 ? argv[1] : "";
  try {
    if (mode == "commands") go::decode_commands();
    if (argc < 3) return 0;
    if (mode == "states") go::print_states(std::stoi(argv[2]));
    if (mode == "robot") go::run_robot(argv[2]);
    if (mode == "driver") go::run_driver(argv[2]);
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}

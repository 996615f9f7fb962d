/// The simulated RoboClaw and our requests, for its maker's own library (tests/drivers/test_serial_peers.py).
///
///   roboclaw_peer PATH   the board with two free wheels behind a pseudo-terminal at PATH, in real time. Each line of the
///                        input is answered by the speeds of M1 and M2 in counts per s; the end of the input ends it.
///   roboclaw_peer        prints our requests: number of the command, bytes in hexadecimal

#include <poll.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <iostream>
#include <memory>
#include <numbers>
#include <string>
#include <thread>

#include "drivers/line/pseudo_terminal.h"
#include "drivers/roboclaw/roboclaw_front.h"

namespace robot_control {
namespace {

using roboclaw::PacketCommand;

constexpr double kPeriod = 0.002;  // s
constexpr double kInertia = 0.01;  // kg·m²
constexpr double kCounts = 1000;   // per turn
constexpr std::uint8_t kAddress = 0x80;

void print_requests() {
  for (const PacketCommand command :
       {PacketCommand::kSetTimeout, PacketCommand::kGetTimeout, PacketCommand::kVersion, PacketCommand::kBattery,
        PacketCommand::kDuties, PacketCommand::kSpeeds, PacketCommand::kVelocityPid1, PacketCommand::kVelocityPid2,
        PacketCommand::kEncoders, PacketCommand::kTemperature, PacketCommand::kStatus}) {
    const bool speeds = command == PacketCommand::kSpeeds;
    const std::int32_t first = speeds ? 1000 : command == PacketCommand::kSetTimeout ? 1 : 0;
    std::printf("%d ", static_cast<int>(command));
    for (const std::uint8_t byte : roboclaw::request(kAddress, command, first, speeds ? -2000 : 0).bytes())
      std::printf("%02x", byte);
    std::printf("\n");
  }
}

/// Returns false at the end of the input.
bool answer(std::span<const JointSample> joints) {
  pollfd input{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
  if (poll(&input, 1, 0) == 0) return true;
  std::string line;
  if (!std::getline(std::cin, line)) return false;
  for (const JointSample& joint : joints) std::cout << joint.velocity * kCounts / (2 * std::numbers::pi) << " ";
  std::cout << std::endl;
  return true;
}

void run_board(const std::string& path) {
  RoboclawParameters parameters{.line = {.address = path}, .wheels = {}};
  for (std::uint64_t motor = 1; motor <= 2; ++motor)
    parameters.wheels.push_back({.joint = "wheel", .motor = motor, .counts_per_turn = kCounts, .velocity_limit = 30});
  constexpr std::array kBrakes{Brake{.damping = 3}, Brake{.damping = 3}};
  constexpr std::array kLimits{3.5, 3.5};
  RoboclawFront board(parameters, kBrakes, kLimits, kPeriod, std::make_unique<PseudoTerminal>(path));
  std::array<JointSample, 2> joints{};
  auto next = std::chrono::steady_clock::now();
  std::cout << "ready" << std::endl;
  while (answer(joints)) {
    board.run(joints);
    for (std::size_t i = 0; i < joints.size(); ++i) {
      joints[i].velocity += board.torque(i) / kInertia * kPeriod;
      joints[i].position += joints[i].velocity * kPeriod;
    }
    std::this_thread::sleep_until(next += std::chrono::milliseconds(2));
  }
}

}  // namespace
}  // namespace robot_control

int main(int argc, char** argv) {
  if (argc == 1) {
    robot_control::print_requests();
  } else {
    robot_control::run_board(argv[1]);
  }
}

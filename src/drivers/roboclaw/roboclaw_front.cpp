#include "drivers/roboclaw/roboclaw_front.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace robot_control {
namespace {

using roboclaw::Packet;
using roboclaw::PacketCommand;

constexpr std::int64_t kTimeoutStepNs = 100'000'000;
constexpr std::uint32_t kGain = 65536;  // 1
constexpr std::uint32_t kTooHot = 0x0002;
constexpr double kQppsMargin = 1.2;  // of the velocity limit

double counts_per_rad(const RoboclawWheelParameters& wheel) {
  return static_cast<double>(wheel.direction) * wheel.counts_per_turn / (2 * std::numbers::pi);
}

}  // namespace

RoboclawFront::RoboclawFront(const RoboclawParameters& parameters, std::span<const Brake> brakes,
                             std::span<const double> effort_limits, double period, FrontLine line)
    : SerialFront(parameters.wheels.size(), period, parameters.line.bit_rate, std::move(line)),
      parameters_(parameters) {
  for (std::size_t i = 0; i < parameters_.wheels.size(); ++i)
    wheels_.push_back({.damping = brakes[i].damping, .limit = effort_limits[i]});
}

std::size_t RoboclawFront::joint_of(std::size_t motor) const {
  const auto found = std::ranges::find(parameters_.wheels, motor, &RoboclawWheelParameters::motor);
  return static_cast<std::size_t>(found - parameters_.wheels.begin());
}

std::int32_t RoboclawFront::counts(std::size_t wheel) const {
  if (stuck_ && parameters_.wheels[wheel].motor == 1) return wheels_[wheel].stuck;
  const double turned = motion(wheel).position - wheels_[wheel].zero;
  return static_cast<std::int32_t>(
      static_cast<std::int64_t>(std::floor(counts_per_rad(parameters_.wheels[wheel]) * turned)));
}

/// A byte that can begin no request, and a request with a wrong CRC, are dropped.
void RoboclawFront::receive_byte(std::uint8_t byte) {
  request_.add(byte, 1);
  if (request_.number(0, 1) != parameters_.line.board_address) return request_.clear();
  if (request_.size() < 2) return;
  const auto command = static_cast<PacketCommand>(request_.number(1, 1));
  if (!roboclaw::is_write(command)) {
    if (roboclaw::answer_size(command) > 0 || command == PacketCommand::kVersion) obey();
    return request_.clear();
  }
  const std::size_t size = 2 + roboclaw::data_size(command);
  if (request_.size() < size + 2) return;
  if (roboclaw::crc16(request_.bytes().first(size)) == request_.number(size, 2)) obey();
  request_.clear();
}

void RoboclawFront::answer(Packet data) {
  data.add(roboclaw::crc16(data.bytes(), roboclaw::crc16(request_.bytes())), 2);
  board_line().send(data.bytes());
}

void RoboclawFront::obey() {
  request_ns_ = now_ns();
  const auto command = static_cast<PacketCommand>(request_.number(1, 1));
  Packet data;
  switch (command) {
    case PacketCommand::kSetTimeout:
      timeout_ = static_cast<std::uint8_t>(request_.number(2, 1));
      break;
    case PacketCommand::kDuties:
      stop();
      break;
    case PacketCommand::kSpeeds:
      for (std::size_t motor = 1; motor <= wheels_.size(); ++motor) {
        const std::size_t joint = joint_of(motor);
        const auto speed = static_cast<std::int32_t>(request_.number(2 + 4 * (motor - 1), 4));
        wheels_[joint].wanted = speed / counts_per_rad(parameters_.wheels[joint]);
        wheels_[joint].driven = !fault_;
      }
      break;
    case PacketCommand::kGetTimeout:
      data.add(timeout_, 1);
      break;
    case PacketCommand::kVersion:
      for (const char letter : std::string_view("USB Roboclaw 2x15a v4.2.4\n"))
        data.add(static_cast<std::uint8_t>(letter), 1);
      data.add(0, 1);
      break;
    case PacketCommand::kBattery:
      data.add(242, 2);
      break;
    case PacketCommand::kTemperature:
      data.add(355, 2);
      break;
    case PacketCommand::kStatus:
      data.add(fault_ ? kTooHot : 0, 4);
      break;
    case PacketCommand::kEncoders:
      for (std::size_t motor = 1; motor <= wheels_.size(); ++motor)
        data.add(static_cast<std::uint32_t>(counts(joint_of(motor))), 4);
      break;
    case PacketCommand::kVelocityPid1:
    case PacketCommand::kVelocityPid2: {
      const RoboclawWheelParameters& wheel =
          parameters_.wheels[joint_of(command == PacketCommand::kVelocityPid1 ? 1 : 2)];
      for (const std::uint32_t gain : {kGain, kGain, 0U}) data.add(gains_ ? gain : 0, 4);
      data.add(static_cast<std::uint32_t>(kQppsMargin * wheel.velocity_limit * std::abs(counts_per_rad(wheel))), 4);
      break;
    }
  }
  if (!roboclaw::is_write(command)) return answer(data);
  const std::uint8_t acknowledged = roboclaw::kAcknowledged;
  board_line().send({&acknowledged, 1});
}

void RoboclawFront::step_board() {
  if (timeout_ > 0 && now_ns() - request_ns_ > timeout_ * kTimeoutStepNs) stop();
  SerialChunk chunk;
  while (board_line().receive(chunk)) {
    if (chunk.time_ns - byte_ns_ > roboclaw::kPacketNs) request_.clear();
    byte_ns_ = chunk.time_ns;
    for (const std::uint8_t byte : chunk.received()) off_ || booting() ? request_.clear() : receive_byte(byte);
  }
}

double RoboclawFront::step_wheel(std::size_t joint, double seconds) {
  if (off_ || booting()) return 0;
  Wheel& wheel = wheels_[joint];
  const double velocity = motion(joint).velocity;
  if (!wheel.driven) {
    wheel.speed_loop.reset();
    return std::clamp(-wheel.damping * velocity, -wheel.limit, wheel.limit);
  }
  const bool blind = stuck_ && parameters_.wheels[joint].motor == 1;
  return wheel.speed_loop.step(wheel.wanted - (blind ? 0 : velocity), wheel.damping, wheel.limit, seconds);
}

bool RoboclawFront::inject_board(std::string_view component, std::string_view kind) {
  const auto is = [kind](auto... words) { return ((kind == words) || ...); };
  if (component == "board" && is("ok", "off", "reset", "brown_out", "fault", "no_gains")) {
    const bool restarts = (off_ && kind != "off") || is("reset", "brown_out");
    off_ = kind == "off";
    fault_ = kind == "fault";
    gains_ = kind != "no_gains";
    if (off_ || restarts || fault_) stop();
    if (!restarts) return true;
    boots_ns_ = now_ns() + kBootNs;
    timeout_ = 0;
    for (std::size_t i = 0; i < wheels_.size(); ++i) wheels_[i].zero = motion(i).position;
    return true;
  }
  if (component != "encoder" || !is("ok", "stuck")) return false;
  stuck_ = false;
  for (std::size_t i = 0; i < wheels_.size(); ++i) wheels_[i].stuck = counts(i);
  stuck_ = kind == "stuck";
  return true;
}

std::unique_ptr<DeviceFront> make_roboclaw_front(const DriveFile& file, FrontSetup setup) {
  const DriveMotors& motors = setup.motors;
  return std::make_unique<RoboclawFront>(parameters_of(dynamic_cast<const RoboclawBlocks&>(file)), motors.brakes,
                                         motors.effort_limits, file.request().period(), std::move(setup));
}

}  // namespace robot_control

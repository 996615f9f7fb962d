#include "drivers/example/example_driver.h"

#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstring>

namespace robot_control {

sockaddr_un board_address(const std::string& path) {
  sockaddr_un board{};
  board.sun_family = AF_UNIX;
  if (path.empty() || path.size() >= sizeof board.sun_path)
    throw DriverError("the address of the board, '" + path + "', is no path of a socket");
  path.copy(board.sun_path, path.size());
  return board;
}

int connect_to_board(const std::string& path) {
  const sockaddr_un board = board_address(path);
  const int descriptor = socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  const sockaddr_un own{.sun_family = AF_UNIX, .sun_path = {}};  // the kernel finds a name, to which the board answers
  if (descriptor < 0 || bind(descriptor, reinterpret_cast<const sockaddr*>(&own), sizeof own.sun_family) != 0 ||
      connect(descriptor, reinterpret_cast<const sockaddr*>(&board), sizeof board) != 0) {
    const std::string why = std::strerror(errno);
    if (descriptor >= 0) close(descriptor);
    throw DriverError("no motor board at " + path + ": " + why +
                      ". Start it first (rosrun robot_control device_simulator)");
  }
  return descriptor;
}

ExampleDriver::ExampleDriver(const ExampleParameters& parameters, std::span<const Brake> brakes,
                             std::span<const double> effort_limits, std::size_t joint_count, double period,
                             int descriptor)
    : parameters_(parameters),
      joint_count_(joint_count),
      period_ns_(std::llround(1.0e9 * period)),
      descriptor_(descriptor) {
  for (std::size_t i = 0; i < brakes.size(); ++i) laws_.emplace_back(brakes[i], effort_limits[i]);
}

ExampleDriver::~ExampleDriver() {
  close(descriptor_);
}

void ExampleDriver::start() {
  stopped_ = false;
  silent_for_ = 0;
  begin();
}

void ExampleDriver::reset() noexcept {
  if (state_ == DriverState::kFault) begin();
}

void ExampleDriver::begin() noexcept {
  state_ = DriverState::kStarting;
  faults_ = 0;
  for (JointLaw& law : laws_) law.reset();
}

/// Reads the reports that came since the last call. Returns whether there was one.
bool ExampleDriver::receive() noexcept {
  bool received = false;
  BoardReport report;
  for (ssize_t got = 0; (got = recv(descriptor_, &report, sizeof report, MSG_DONTWAIT | MSG_TRUNC)) > 0;) {
    if (got != sizeof report || report.head != kBoardReportHead || report.count != laws_.size()) continue;
    report_ = report;
    received = true;
  }
  return received;
}

void ExampleDriver::evaluate_faults() noexcept {
  for (std::size_t i = 0; i < laws_.size(); ++i) {
    const BoardReport::Motor& motor = report_.motors[i];
    if (motor.fault != 0) faults_ |= kFaultDrive;
    if (!std::isfinite(motor.position + motor.velocity + motor.torque)) faults_ |= kFaultNotFinite;
  }
}

void ExampleDriver::read(SensorFrame& sensors) noexcept {
  const bool received = receive();
  silent_for_ = received ? 0 : silent_for_ + 1;
  if (received && state_ == DriverState::kStarting) state_ = DriverState::kRunning;
  if (state_ == DriverState::kRunning) evaluate_faults();
  if (state_ == DriverState::kRunning && silent_for_ > parameters_.max_silence) faults_ |= kFaultLink;
  if (faults_ != 0) state_ = DriverState::kFault;
  sensors.driver_state = state_;
  sensors.faults = faults_;
  sensors.valid = 0;  // kValidGyro …, where there is an IMU
  sensors.joint_count = joint_count_;
  for (std::size_t i = laws_.size(); i < joint_count_; ++i) sensors.joints[i] = {};
  for (std::size_t i = 0; i < laws_.size(); ++i) {
    const BoardReport::Motor& motor = report_.motors[i];
    sensors.joints[i] = {.position = motor.position, .velocity = motor.velocity, .effort = motor.torque};
    sensors.joints[i].fault = static_cast<std::uint32_t>(motor.fault);
    sensors.joints[i].valid = state_ == DriverState::kRunning ? kValidMotion : 0;
    sensors.joints[i].age_ns = static_cast<std::int64_t>(silent_for_) * period_ns_;
  }
}

void ExampleDriver::write(std::span<const JointCommand> commands) noexcept {
  const bool obeys = !stopped_ && commands.size() == joint_count_;
  BoardOrder order{.count = static_cast<std::uint32_t>(laws_.size())};
  for (std::size_t i = 0; i < laws_.size(); ++i) {
    const BoardReport::Motor& motor = report_.motors[i];
    if (state_ != DriverState::kRunning) continue;  // without a report there is no law
    order.torque[i] = laws_[i].step(obeys ? commands[i] : JointCommand{}, motor.position, motor.velocity);
  }
  send(order);
}

void ExampleDriver::send(const BoardOrder& order) const noexcept {
  ::send(descriptor_, &order, sizeof order, MSG_DONTWAIT | MSG_NOSIGNAL);
}

void ExampleDriver::stop() noexcept {
  stopped_ = true;
  send({.count = static_cast<std::uint32_t>(laws_.size())});
}

std::string ExampleDriver::warning() const {
  const std::uint64_t faults = faults_;
  if ((faults & kFaultLink) != 0) return "the motor board is silent: look at its power and its cable, then reset";
  if ((faults & kFaultDrive) != 0) return "a motor reports a fault: repair it, then reset";
  if ((faults & kFaultNotFinite) != 0) return "the motor board sent NaN or infinity: look at its encoders, then reset";
  if (state_ == DriverState::kStarting)
    return "the motor board has sent no report yet: look at its power and its cable";
  return "";
}

}  // namespace robot_control

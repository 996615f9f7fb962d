#include "simulation/devices/example_board.h"

#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>

#include "drivers/example/example_driver.h"

namespace robot_control {
namespace {

constexpr std::uint64_t kInjectedFault = 1;

}  // namespace

int bind_board(const std::string& path) {
  const sockaddr_un own = board_address(path);
  const int descriptor = socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (descriptor >= 0) fchmod(descriptor, S_IRUSR | S_IWUSR);  // the socket file gets this mode
  struct stat left {};
  if (lstat(path.c_str(), &left) == 0) {
    const bool is_socket = S_ISSOCK(left.st_mode);
    const bool answers = is_socket && connect(descriptor, reinterpret_cast<const sockaddr*>(&own), sizeof own) == 0;
    if (!is_socket || answers) {
      close(descriptor);
      throw DriverError(path + (answers ? " is the address of another board" : " is a file and no socket") +
                        ". Choose another address (board.address)");
    }
    unlink(path.c_str());
  }
  if (descriptor < 0 || bind(descriptor, reinterpret_cast<const sockaddr*>(&own), sizeof own) != 0) {
    const std::string why = std::strerror(errno);
    if (descriptor >= 0) close(descriptor);
    throw DriverError("the board cannot be reached at " + path + ": " + why + ". Choose another address");
  }
  return descriptor;
}

ExampleBoard::ExampleBoard(std::span<const Brake> brakes, std::span<const double> effort_limits, double period,
                           int descriptor)
    : brakes_(brakes.begin(), brakes.end()),
      effort_limits_(effort_limits.begin(), effort_limits.end()),
      period_ns_(std::llround(1.0e9 * period)),
      descriptor_(descriptor),
      torques_(brakes.size()) {}

ExampleBoard::~ExampleBoard() {
  close(descriptor_);
}

void ExampleBoard::receive() {
  BoardOrder order;
  sockaddr_un sender{};
  socklen_t size = sizeof sender;
  for (ssize_t got = 0; (got = recvfrom(descriptor_, &order, sizeof order, MSG_TRUNC,
                                        reinterpret_cast<sockaddr*>(&sender), &size)) > 0;) {
    if (got == sizeof order && order.head == kBoardOrderHead && order.count == brakes_.size()) {
      order_ = order;
      order_ns_ = now_ns_;
      driver_ = sender;
      driver_size_ = size;
    }
    size = sizeof sender;
  }
}

void ExampleBoard::run(std::span<const JointSample> joints) {
  receive();
  const bool obeys = now_ns_ - order_ns_ < kBoardWatchdogNs;
  for (std::size_t i = 0; i < brakes_.size(); ++i) {
    if (obeys) brakes_[i].release();
    const double wanted =
        obeys ? order_.torque[i] : brakes_[i].step(torques_[i], joints[i].position, joints[i].velocity);
    torques_[i] = std::clamp(wanted, -effort_limits_[i], effort_limits_[i]);
    if (!std::isfinite(torques_[i]) || fault_ != Fault::kNone) torques_[i] = 0;
  }
  now_ns_ += period_ns_;
  if (fault_ != Fault::kOff) report(joints);
}

void ExampleBoard::report(std::span<const JointSample> joints) {
  BoardReport report{.count = static_cast<std::uint32_t>(brakes_.size())};
  for (std::size_t i = 0; i < brakes_.size(); ++i) {
    report.motors[i] = {.position = joints[i].position,
                        .velocity = joints[i].velocity,
                        .torque = torques_[i],
                        .fault = fault_ == Fault::kFault ? kInjectedFault : 0};
  }
  const auto* driver = driver_size_ > sizeof driver_.sun_family ? reinterpret_cast<const sockaddr*>(&driver_) : nullptr;
  sendto(descriptor_, &report, sizeof report, MSG_DONTWAIT | MSG_NOSIGNAL, driver,
         driver == nullptr ? 0 : driver_size_);
}

std::string ExampleBoard::inject(std::string_view component, std::string_view kind) {
  if (component != "board" || (kind != "ok" && kind != "off" && kind != "fault"))
    return "component must be board; kind ok off fault";
  fault_ = kind == "ok" ? Fault::kNone : kind == "off" ? Fault::kOff : Fault::kFault;
  return "";
}

}  // namespace robot_control

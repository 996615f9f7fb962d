#pragma once
/// An ExampleBoard is the motor board of drivers/example as a device. It takes torques and reports once in each period.
/// It brakes by itself when no order came for kBoardWatchdogNs.
///
/// `inject` takes `board` as the component, with the kinds ok, off (no report, no torque) and fault (of every motor,
/// without torque).

#include <sys/un.h>

#include <span>
#include <string>
#include <vector>

#include "drivers/example/board_messages.h"
#include "gate/brake_law.h"
#include "simulation/devices/device_front.h"

namespace robot_control {

/// Returns a socket that is bound to this path. Throws DriverError.
int bind_board(const std::string& path);

class ExampleBoard final : public DeviceFront {
 public:
  /// `brakes` and `effort_limits` (N·m): one per joint. `period` is in s. `descriptor` is a datagram socket, which the
  /// board closes; it answers to the sender of the last order.
  ExampleBoard(std::span<const Brake> brakes, std::span<const double> effort_limits, double period, int descriptor);
  ~ExampleBoard() override;
  ExampleBoard(const ExampleBoard&) = delete;
  ExampleBoard& operator=(const ExampleBoard&) = delete;

  std::size_t size() const override { return brakes_.size(); }
  std::int64_t now_ns() const override { return now_ns_; }
  void run(std::span<const JointSample> joints) override;
  double torque(std::size_t joint) const override { return torques_.at(joint); }
  std::string inject(std::string_view component, std::string_view kind) override;

 private:
  enum class Fault { kNone, kOff, kFault };

  void receive();
  void report(std::span<const JointSample> joints);

  std::vector<BrakeLaw> brakes_;
  std::vector<double> effort_limits_;
  std::int64_t period_ns_;
  int descriptor_;
  sockaddr_un driver_{};  // the sender of the last order
  unsigned driver_size_ = 0;
  BoardOrder order_;
  std::int64_t now_ns_ = 0;
  std::int64_t order_ns_ = -kBoardWatchdogNs;
  std::vector<double> torques_;
  Fault fault_ = Fault::kNone;
};

}  // namespace robot_control

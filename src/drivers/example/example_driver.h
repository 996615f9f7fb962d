#pragma once
/// A driver to start from: wheels on a motor board that takes torques. It keeps the contract of drivers/driver.h
/// (tests/drivers/driver_contract.h). Replace the messages by those of your board, and add the sensors of your machine.
///
/// `start` returns at once; `read` reports kStarting until the board has sent a report. Its faults are a motor's fault
/// word, a number that is not finite, and silence for more than `max_silence` cycles. They stay until the operator's
/// reset, and the driver orders no torque meanwhile.

#include <sys/un.h>

#include <atomic>
#include <span>
#include <string>
#include <vector>

#include "drivers/driver.h"
#include "drivers/example/board_messages.h"
#include "drivers/example/example_parameters.h"
#include "drivers/joint_law.h"

namespace robot_control {

/// Returns the address of the board at this path. Throws DriverError.
sockaddr_un board_address(const std::string& path);

/// Returns a socket that is connected with the board at this path. Throws DriverError.
int connect_to_board(const std::string& path);

class ExampleDriver final : public Driver {
 public:
  /// The motors move the first joints of a robot that has `joint_count`; the others have no sample. `brakes` and
  /// `effort_limits` (N·m): one per motor. `descriptor` is a datagram socket, which the driver closes.
  ExampleDriver(const ExampleParameters& parameters, std::span<const Brake> brakes,
                std::span<const double> effort_limits, std::size_t joint_count, double period, int descriptor);
  ~ExampleDriver() override;
  ExampleDriver(const ExampleDriver&) = delete;
  ExampleDriver& operator=(const ExampleDriver&) = delete;

  void start() override;
  void reset() noexcept override;
  void read(SensorFrame& sensors) noexcept override;
  void write(std::span<const JointCommand> commands) noexcept override;
  /// The next `write` brakes. Until then the motors have no torque.
  void stop() noexcept override;
  std::string description() const override { return "a motor board that brakes by itself when it hears nothing"; }
  std::string warning() const override;
  /// The motors take torques, so they follow every mode.
  bool accepts(JointMode mode) const noexcept override { return JointLaw::computes(mode); }

 private:
  void begin() noexcept;
  void send(const BoardOrder& order) const noexcept;
  bool receive() noexcept;
  void evaluate_faults() noexcept;

  ExampleParameters parameters_;
  std::vector<JointLaw> laws_;
  std::size_t joint_count_;
  std::int64_t period_ns_;
  int descriptor_;
  BoardReport report_;            // the last good one
  std::uint64_t silent_for_ = 0;  // cycles since then
  std::atomic<DriverState> state_ = DriverState::kStarting;
  std::atomic<std::uint64_t> faults_ = 0;  // bits of DriverFault
  bool stopped_ = false;
};

}  // namespace robot_control

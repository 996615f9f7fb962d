#pragma once
/// A machine whose IMU is a device of another program: a Driver whose frames get the samples of an inbox.
///
/// A sample counts for kImuLife. Until the first one came, `read` reports kStarting. A part of a sample that is not
/// finite or not measured is not valid.

#include <functional>
#include <memory>
#include <string>

#include "bus/latest_value.h"
#include "drivers/driver.h"

namespace robot_control {

struct ExternalImuSample {
  ImuSample imu;
  std::uint64_t valid = 0;    ///< bits of SensorValidity
  std::int64_t time_ns = -1;  ///< of the sample, on the clock of the driver; -1: there is none
};

using ImuInbox = LatestValue<ExternalImuSample>;

class ExternalImu final : public Driver {
 public:
  static constexpr std::int64_t kImuLife = 50'000'000;  ///< ns

  /// `clock` states the present time in ns and is called in each cycle. `exists`: there is an IMU behind the inbox.
  ExternalImu(std::unique_ptr<Driver> machine, std::shared_ptr<const ImuInbox> inbox,
              std::function<std::int64_t()> clock, bool exists = true);

  void start() override { machine_->start(); }
  void reset() noexcept override { machine_->reset(); }
  void read(SensorFrame& sensors) noexcept override;
  void write(std::span<const JointCommand> commands) noexcept override { machine_->write(commands); }
  void stop() noexcept override { machine_->stop(); }
  std::string description() const override { return machine_->description(); }
  std::string warning() const override;
  std::string_view fault_message() const noexcept override { return machine_->fault_message(); }
  bool accepts(JointMode mode) const noexcept override { return machine_->accepts(mode); }
  bool measures(MachineInput input) const noexcept override {
    return input == MachineInput::kImu ? exists_ : machine_->measures(input);
  }

 private:
  std::unique_ptr<Driver> machine_;
  std::shared_ptr<const ImuInbox> inbox_;
  std::function<std::int64_t()> clock_;
  bool exists_;
  ExternalImuSample sample_;
};

}  // namespace robot_control

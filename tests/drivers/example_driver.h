#pragma once
/// A driver to start from: wheels with one motor drive each, on a bus such as CAN. It keeps the contract of
/// drivers/driver.h (driver_contract.h). Replace DriveLink by your bus, and add the sensors of your machine.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "drivers/driver.h"
#include "machine/machine_model.h"

namespace robot_control {

/// The report of a motor drive on its joint, with its fault word; SI, the joint's own sign.
struct DriveStatus {
  JointSample joint;
};

/// The link to one motor drive. Neither call blocks; both exchange what the bus has buffered.
class DriveLink {
 public:
  virtual ~DriveLink() = default;

  /// Reads the newest status since the last call. False: none arrived.
  virtual bool receive(DriveStatus& status) noexcept = 0;

  /// Sends N·m, which hold until the next call. The drive's watchdog brakes by itself when calls stop.
  virtual void send_torque(double torque) noexcept = 0;

  /// Switches to the drive's own brake: damping, then position hold.
  virtual void send_brake() noexcept = 0;
};

class ExampleDriver final : public Driver {
 public:
  /// `links`: one per joint, in the order of MachineModel::joints. `period_ns`: of the loop.
  ExampleDriver(const MachineModel& robot, std::vector<std::unique_ptr<DriveLink>> links, std::int64_t period_ns);

  void start() override;
  void read(SensorFrame& sensors) noexcept override;
  void write(std::span<const JointCommand> commands) noexcept override;
  void stop() noexcept override;
  /// Its drives take torques, so they follow every order.
  bool implements(StopKind) const noexcept override { return true; }

 private:
  struct Joint {
    std::unique_ptr<DriveLink> link;
    double effort_limit = 0;       ///< N·m
    JointSample sample{};          ///< the last good one
    std::uint64_t silent_for = 0;  ///< cycles since the last status
  };

  void receive(Joint& joint) noexcept;
  void brake() noexcept;

  std::vector<Joint> joints_;
  std::int64_t period_ns_;
  DriverState state_ = DriverState::kStarting;
  std::uint64_t faults_ = 0;  ///< DriverFault bits; kept until the next start
  bool stopped_ = false;
};

}  // namespace robot_control

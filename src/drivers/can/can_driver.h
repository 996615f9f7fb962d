#pragma once
/// Motor drives on one CAN bus as a Driver.
///
/// `start` returns at once; `read` reports kStarting until all drives are running, so that the brake of the driver
/// holds from kRunning on. A fault of a drive stays until the next `start`, with which the operator's reset reaches the
/// drives. Meanwhile the other joints brake.
///
/// The torque of every mode, the brake included, is computed here from the newest sample (drivers/joint_law.h). The
/// sample is one or two cycles old, and is brought to the time of the call by its velocity. With an inertia J at the
/// joint and the period h, the brake's damping d is stable below d h / J = 0.6. Half of that is recommended.

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "drivers/can/can_bus.h"
#include "drivers/can/can_parameters.h"
#include "drivers/can/drive_set.h"
#include "drivers/driver.h"
#include "drivers/joint_law.h"

namespace robot_control {

class CanDriver final : public Driver {
 public:
  /// `brakes`: one per joint. `clock` states the present time and is called in each cycle.
  CanDriver(const CanParameters& parameters, std::span<const Brake> brakes, double period, CanSocket socket,
            std::function<CanTime()> clock);

  void start() override;
  void read(SensorFrame& sensors) noexcept override;
  void write(std::span<const JointCommand> commands) noexcept override;
  void stop() noexcept override { stopped_ = true; }

  /// Returns one line per drive: its state, its cause and the remedy.
  std::vector<std::string> words() const;
  const DriveSet& drives() const noexcept { return drives_; }
  const CanBus& bus() const noexcept { return bus_; }

 private:
  static constexpr int kMaxBatches = 8;  // of frames in one cycle, so that a flooded bus does not stop the loop

  bool all_are(DriveState state) const noexcept;
  void judge_faults() noexcept;
  double wanted_torque(std::size_t joint, const JointCommand& command) noexcept;

  CanBus bus_;
  DriveSet drives_;
  std::function<CanTime()> clock_;
  std::vector<JointLaw> laws_;
  std::vector<DriveCommand> commands_;
  FrameBatch send_;
  DriverState state_ = DriverState::kStarting;
  std::uint64_t faults_ = 0;  // bits of DriverFault; kept until the next start
  std::int64_t now_ns_ = 0;
  bool stopped_ = true;
  bool reset_ = false;
};

}  // namespace robot_control

#pragma once
/// Motor drives on one CAN bus as a Driver.
///
/// `start` returns at once; `read` reports kStarting until all drives are running, so that the brake of the driver
/// holds from kRunning on. A fault of a drive stays until the operator's reset, or the next `start`. Meanwhile the
/// other joints brake, and so does this drive by itself (drivers/drive/drive.h).
///
/// The samples of all drives are brought to the time of `read` by their velocities. A sample that is missing therefore
/// moves on, and its age grows.
///
/// Drives that take speeds are given that of kDriveVelocity, with its effort where the dialect has a feed-forward. They
/// brake with the speed zero, which they keep at rest. For other drives the torque of every mode, the brake included,
/// is computed here from the newest sample (drivers/joint_law.h). The sample is one or two cycles old, and is brought
/// to the time of the call by its velocity. With an inertia J at the joint and the period h, the brake's damping d is
/// stable below d h / J = 0.6. Half of that is recommended.

#include <array>
#include <span>
#include <string>
#include <vector>

#include "bus/latest_value.h"
#include "drivers/drive/can_drive_file.h"
#include "drivers/drive/drive_set.h"
#include "drivers/drive_speed.h"
#include "drivers/driver.h"
#include "drivers/joint_law.h"
#include "drivers/line/bus_watch.h"
#include "drivers/line/can_bus.h"

namespace robot_control {

class CanDriver final : public Driver {
 public:
  /// The drives move the first joints of a robot that has `joint_count`; the others have no sample. `brakes`: one per
  /// drive. `clock` states the present time and is called in each cycle.
  CanDriver(CanBusParameters parameters, DriveSet drives, std::span<const Brake> brakes, std::size_t joint_count,
            double period, CanSocket socket, DriverClock clock);

  void start() override;
  void reset() noexcept override {
    if (state_ == DriverState::kFault) begin();
  }
  void read(SensorFrame& sensors) noexcept override;
  void write(std::span<const JointCommand> commands) noexcept override;
  /// The next `write` brakes. Until then the drives have no torque: a drive keeps the last one that it was sent.
  void stop() noexcept override;

  bool accepts(JointMode mode) const noexcept override { return accepted(mode, takes_speeds_); }
  bool measures(MachineInput input) const noexcept override;

  /// Returns the bus with its load, and what each joint does on silence.
  std::string description() const override;

  /// Returns what is wrong with the bus, and the words of every drive that is not running; any thread may call it.
  std::string warning() const override;

  const DriveSet& drives() const noexcept { return drives_; }
  const CanBus& bus() const noexcept { return bus_; }

 private:
  static constexpr int kMaxBatches = 8;  // of frames in one cycle, so that a flooded bus does not stop the loop

  struct Statuses {
    std::array<DriveStatus, kMaxJoints> drives{};
    BusStatus bus;
  };

  void begin() noexcept;
  void send_commands(std::int64_t now_ns) noexcept;
  bool all_are(DrivePhase state) const noexcept;
  LinkStatus link() const noexcept;
  void publish_statuses() noexcept;
  void judge_faults() noexcept;
  DriveCommand wanted(std::size_t joint, const JointCommand& command) noexcept;

  std::size_t joint_count_;
  CanBus bus_;
  BusWatch watch_;
  CanBusParameters parameters_;
  DriveSet drives_;
  bool takes_speeds_;
  double load_;  // of the bus, planned
  DriverClock clock_;
  std::vector<Brake> brakes_;
  std::vector<JointLaw> laws_;
  std::vector<DriveCommand> commands_;
  FrameBatch send_;
  Statuses statuses_{};
  LatestValue<Statuses> published_statuses_;
  DriverState state_ = DriverState::kStarting;
  std::uint64_t faults_ = 0;  // bits of DriverFault; kept until the next start
  std::int64_t now_ns_ = 0;
  bool stopped_ = true;
  bool reset_ = false;
};

}  // namespace robot_control

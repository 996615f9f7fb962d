#pragma once
/// Motor drives on one to kMaxLinks CAN buses as a Driver.
///
/// `start` returns at once; `read` reports kStarting until all drives are running, so that the brake of the driver
/// holds from kRunning on. The first motor is enabled when all drives are ready: no motor has torque before all are
/// checked. A fault of a drive stays until the operator's reset, or the next `start`. Meanwhile the other joints that
/// had torque brake, and so does this drive by itself (drivers/drive/drive.h).
///
/// The samples of all drives are brought to the time of `read` by their velocities. A sample that is missing therefore
/// moves on, and its age grows.
///
/// Drives that take speeds are given that of kDriveVelocity, with its effort where the dialect has a feed-forward. They
/// brake with the speed zero, which they keep at rest. For other drives the torque of every mode, the brake included,
/// is computed here from the newest sample (drivers/joint_law.h). The sample is one or two cycles old, and is brought
/// to the time of the call by its velocity. With an inertia J at the joint and the period h, the brake's damping d is
/// stable below d h / J = 0.6. Half of that is recommended.
///
/// A drive that closes an impedance (DriveParameters::max_stiffness) is given stiffness, damping and their targets. The
/// torque beside them is what is missing from the law's torque at the time of the call. So the sum is within the
/// joint's limit, and gains beyond those of the drive act with the delay of the sample. A torque at its limit is given
/// alone. It brakes with the damping of its Brake.
///
/// A motor that keeps its last order for ever (SilenceReaction::kKeeps) shall stand still with it. So each impedance
/// has at least the stiffness torque_limit / (kHoldSpeed h), about the angle after kHoldPeriods. At that angle the
/// torque is the law's. A frame that is late by h makes a damping of torque_limit / kHoldSpeed, of either sign, which a
/// leg bears (docs/evidence/leg_drives.md, Losses).
///
/// In a fault of another drive that came after kRunning a drive obeys further, because the gate then orders the stop
/// action. A robot on legs folds with it, and would tip over on braked legs.

#include <array>
#include <deque>
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
  /// `sockets`: one for each of `drives.buses()`.
  CanDriver(CanBusParameters parameters, DriveSet drives, std::span<const Brake> brakes, std::size_t joint_count,
            double period, CanSockets sockets, DriverClock clock);

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

  /// Returns the buses with their greatest load, and what each joint does on silence.
  std::string description() const override;

  /// Returns what is wrong with the buses, and the words of every drive that is not running. Drives that wait for the
  /// check of another one are left out. Any thread may call it.
  std::string warning() const override;

  const DriveSet& drives() const noexcept { return drives_; }
  const CanBus& bus(std::size_t i = 0) const noexcept { return lines_[i].bus; }

 private:
  static constexpr double kHoldSpeed = 200;    // rad/s
  static constexpr double kHoldPeriods = 1.5;  // until the middle of the period in which the order acts
  static constexpr int kLastCommands = 3;  // one may be lost, and some motors of legs keep their last order for ever
  static constexpr int kMaxBatches = 8;    // of frames in one cycle, so that a flooded bus does not stop the loop

  struct Statuses {
    std::array<DriveStatus, kMaxJoints> drives{};
    std::array<BusStatus, kMaxLinks> buses{};
  };

  struct Line {
    explicit Line(CanSocket socket) : bus(std::move(socket)) {}

    CanBus bus;
    BusWatch watch;
  };

  void begin() noexcept;
  void send_commands(std::int64_t now_ns) noexcept;
  bool all_are(DrivePhase state) const noexcept;
  bool all_checked() const noexcept;
  bool follows() const noexcept;
  void receive(std::size_t line, const CanTime& now) noexcept;
  void publish_statuses() noexcept;
  void judge_faults() noexcept;
  bool may_have_torque(std::size_t joint) const noexcept;
  DriveCommand wanted(std::size_t joint, const JointCommand& command) noexcept;
  void add_hold(const DriveParameters& drive, const JointSample& now, DriveCommand& wanted) const noexcept;
  void add_impedance(std::size_t joint, const JointCommand& command, const JointSample& now,
                     DriveCommand& wanted) const noexcept;

  std::size_t joint_count_;
  std::deque<Line> lines_;  // of each bus; a CanBus does not move
  CanBusParameters parameters_;
  DriveSet drives_;
  bool takes_speeds_;
  bool closes_impedance_ = true;
  bool ran_ = false;      // since the last start
  bool checked_ = false;  // all drives were ready or running in the last `read`
  double load_ = 0;       // the greatest one of a bus, planned
  DriverClock clock_;
  double period_;  // s
  std::vector<Brake> brakes_;
  std::vector<JointLaw> laws_;
  std::vector<DriveCommand> commands_;
  std::vector<FrameBatch> send_;  // of each bus
  Statuses statuses_{};
  LatestValue<Statuses> published_statuses_;
  DriverState state_ = DriverState::kStarting;
  std::uint64_t faults_ = 0;  // bits of DriverFault; kept until the next start
  std::int64_t now_ns_ = 0;
  bool stopped_ = true;
  bool reset_ = false;
};

}  // namespace robot_control

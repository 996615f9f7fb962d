#include <algorithm>

#include "drivers/cia402/canopen.h"
#include "drivers/cia402/cia402_drive.h"
#include "drivers/drive/can_drive_file.h"

namespace robot_control {
namespace cia402 {
namespace {

/// Sends to all CANopen nodes of a bus: SYNC in each cycle, after the torques, and its heartbeat.
class CanopenHost final : public BusHost {
 public:
  /// A drive reacts after `timeout` s without a heartbeat. Ten are sent in that time, so that a few may be lost.
  CanopenHost(std::uint8_t node, double timeout) noexcept
      : node_(node), heartbeat_ns_(static_cast<std::int64_t>(1.0e9 * timeout / kHeartbeats)) {}

  void step(std::int64_t now_ns, FrameBatch& send) noexcept override {
    send.add(canopen::sync_frame());
    if (now_ns < next_ns_) return;
    next_ns_ = now_ns + heartbeat_ns_;
    send.add(canopen::encode_heartbeat({.node = node_, .state = canopen::NmtState::kOperational}));
  }

  std::vector<PlannedFrames> plan() const override {
    const double heartbeats = 1.0e9 / static_cast<double>(heartbeat_ns_);
    return {{.data_bytes = 0, .per_cycle = 1}, {.data_bytes = 1, .per_second = heartbeats}};
  }

 private:
  static constexpr int kHeartbeats = 10;
  std::uint8_t node_;
  std::int64_t heartbeat_ns_;
  std::int64_t next_ns_ = 0;
};

class Cia402File final : public CanFileOf<Cia402Parameters> {
 public:
  static constexpr double kMinTimeoutPeriods = 10;  ///< in which a drive waits for its host

  explicit Cia402File(DriveFileRequest request);

  DriveSet drives() const override {
    return cia402_drives(joints(), static_cast<std::uint8_t>(bus.host_node), request().period());
  }
  DriveCapability capability(std::size_t joint) const override;

 private:
  void check(const Cia402Parameters& joint, JointValues& values) const override;
  /// The velocity.
  void leave_out_frames() override {
    for (Cia402Parameters& joint : joints_) joint.velocity_has_room = false;
  }
};

Cia402File::Cia402File(DriveFileRequest given) : CanFileOf(std::move(given)) {
  every_.host_timeout = std::max(every_.host_timeout, kMinTimeoutPeriods / request().rate);
}

DriveCapability Cia402File::capability(std::size_t joint) const {
  DriveCapability capability = CanFileOf::capability(joint);
  const Cia402Parameters& parameters = joints()[joint];
  if (parameters.torque_slope > 0) capability.torque_rate = parameters.torque_slope * parameters.drive.gear;
  return capability;
}

void Cia402File::check(const Cia402Parameters& joint, JointValues& values) const {
  const DriveParameters& drive = joint.drive;
  if (drive.node == 0 || drive.node > canopen::kMaxNode || drive.node == bus.host_node)
    values.refuse("node", "must be 1 … 127 and not bus.host_node");
  if (joint.host_timeout < kMinTimeoutPeriods / request().rate * (1 - 1.0e-9)) {
    values.refuse("host_timeout", "must be at least ten periods of the loop (robot.rate)",
                  "set a longer one: a host that is late for a few cycles would stop the drive");
  }
  const bool takes_speeds = request().takes_speeds;
  if (joint.mode != ModeChoice::kAny && is_of_speeds(joint.mode) != takes_speeds) {
    values.refuse("mode",
                  takes_speeds ? "must be any, csv or pv with robot.wheel_command: velocity"
                               : "must be any, cst or tq with robot.wheel_command: torque",
                  "correct it, or set robot.wheel_command");
  }
  if (joint.abort_option == 0 && drive.on_silence != SilenceReaction::kUnknown) {
    values.refuse("on_silence", "contradicts abort_option: 0, with which the drive does nothing", "remove one of them");
  }
}

}  // namespace

DriveSet cia402_drives(const std::vector<Cia402Parameters>& joints, std::uint8_t host_node, double period) {
  std::vector<std::unique_ptr<Drive>> made;
  std::vector<Cia402Drive*> added;
  std::vector<std::string> buses;
  double timeout = joints.empty() ? 1 : joints[0].host_timeout;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    auto drive = std::make_unique<Cia402Drive>(joints[i], host_node, period);
    for (std::size_t j = 0; j < i; ++j) {
      if (joints[j].drive.bus != joints[i].drive.bus || joints[j].drive.node != joints[i].drive.node) continue;
      const bool second = joints[i].axis != 0;
      Cia402Drive::join(second ? *added[j] : *drive, second ? *drive : *added[j]);
    }
    added.push_back(drive.get());
    made.push_back(std::move(drive));
    timeout = std::min(timeout, joints[i].host_timeout);
    bus_index(buses, joints[i].drive.bus);
  }
  std::vector<std::unique_ptr<BusHost>> hosts;
  for (std::size_t i = 0; i < buses.size(); ++i) hosts.push_back(std::make_unique<CanopenHost>(host_node, timeout));
  return DriveSet(std::move(made), std::move(hosts));
}

}  // namespace cia402

std::unique_ptr<DriveFile> make_cia402_file(DriveFileRequest request) {
  return std::make_unique<cia402::Cia402File>(std::move(request));
}

}  // namespace robot_control

#include <algorithm>

#include "drivers/damiao/damiao_drive.h"
#include "drivers/drive/can_drive_file.h"

namespace robot_control {
namespace damiao {
namespace {

class DamiaoFile final : public CanFileOf<DamiaoParameters> {
 public:
  explicit DamiaoFile(DriveFileRequest given) : CanFileOf(std::move(given)) {
    every_.timeout = std::max(every_.timeout, kMinTimeoutPeriods * request().period());
  }
  DriveSet drives() const override { return drives_of<DamiaoDrive>(joints(), request().period()); }

  /// All frames are orders and their answers. Three motors at 1 kHz have 6 of at most 135 bits in 1 ms: one of them may
  /// be repeated in each cycle.
  double max_load() const override { return 0.85; }

 private:
  static constexpr double kMinTimeoutPeriods = 10;  ///< of the loop
  void check(const DamiaoParameters& joint, JointValues& values) const override;
};

void DamiaoFile::check(const DamiaoParameters& joint, JointValues& values) const {
  const DriveParameters& drive = joint.drive;
  if (drive.node == 0 || drive.node > kMaxNode)
    values.refuse("node", "must be 1 … 15: the answers of a Damiao motor hold four bits of it", "set another ESC_ID");
  const std::uint64_t to_motor = joint.answers % 0x100, mode = joint.answers / 0x100;
  if (mode <= 3 && 1 <= to_motor && to_motor <= kMaxNode)
    values.refuse("answers", "must not be an identifier that motors obey: 1 … 15, 257 … 271, 513 … 527, 769 … 783",
                  "set another MST_ID");
  if (drive.torque_limit > joint.ranges.torque * drive.gear)
    values.refuse("torque_limit", "must be at most torque_range · gear, which the motor can be ordered");
  if (drive.velocity_limit * drive.gear > joint.ranges.velocity)
    values.refuse("velocity_limit", "must be at most velocity_range / gear, which the motor can report");
  if (drive.min_voltage != 0)
    values.refuse("min_voltage", "must be 0: a Damiao motor does not send its voltage",
                  "remove it; the motor reports under-voltage by itself (register UV_Value)");
  if (drive.on_silence != SilenceReaction::kUnknown)
    values.refuse("on_silence", "must be left out: the timeout is written to the motor, which then coasts");
  if (joint.timeout < kMinTimeoutPeriods * request().period() * (1 - 1.0e-9))
    values.refuse("timeout", "must be at least ten periods of the loop (robot.rate)",
                  "set a longer one: a host that is late for a few cycles would release the motor");
}

}  // namespace
}  // namespace damiao

std::unique_ptr<DriveFile> make_damiao_file(DriveFileRequest request) {
  return std::make_unique<damiao::DamiaoFile>(std::move(request));
}

}  // namespace robot_control

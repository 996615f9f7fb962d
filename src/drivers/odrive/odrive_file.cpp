#include "drivers/drive/can_drive_file.h"
#include "drivers/odrive/odrive_codec.h"
#include "drivers/odrive/odrive_drive.h"

namespace robot_control {
namespace odrive {
namespace {

class OdriveFile final : public CanFileOf<OdriveParameters> {
 public:
  using CanFileOf::CanFileOf;
  DriveSet drives() const override { return drives_of<OdriveDrive>(joints(), request().period()); }

 private:
  void check(const OdriveParameters& joint, JointValues& values) const override;
};

void OdriveFile::check(const OdriveParameters& joint, JointValues& values) const {
  const DriveParameters& drive = joint.drive;
  if (drive.node > kMaxNode) values.refuse("node", "must be 0 … 63 on an ODrive");
  if (drive.on_silence != SilenceReaction::kUnknown && drive.on_silence != SilenceReaction::kCoasts)
    values.refuse("on_silence", "must be coasts or unknown: an ODrive releases the motor");
  if ((joint.enable_watchdog_endpoint == 0) != (joint.watchdog_timeout_endpoint == 0)) {
    const bool first = joint.enable_watchdog_endpoint == 0;
    values.refuse(first ? "enable_watchdog_endpoint" : "watchdog_timeout_endpoint",
                  "is missing: both endpoints of the watchdog are needed, or none");
  }
  const double fastest = OdriveDrive::kVelocityMargin * drive.velocity_limit * drive.gear;
  if (joint.motor_velocity_limit != 0 && joint.motor_velocity_limit < fastest) {
    values.refuse("motor_velocity_limit",
                  "must be at least 1.5 · velocity_limit · gear: else the axis reduces what was planned",
                  "set a lower velocity_limit, or remove it");
  }
  if (joint.enable_watchdog_endpoint != 0 && joint.firmware == Firmware::k05)
    values.refuse("firmware", "must not be 0.5, which has no endpoints on CAN");
}

}  // namespace
}  // namespace odrive

std::unique_ptr<DriveFile> make_odrive_file(DriveFileRequest request) {
  return std::make_unique<odrive::OdriveFile>(std::move(request));
}

}  // namespace robot_control

#include "drivers/drive/can_drive_file.h"
#include "drivers/vesc/vesc_drive.h"

namespace robot_control {
namespace vesc {
namespace {

class VescFile final : public CanFileOf<VescParameters> {
 public:
  using CanFileOf::CanFileOf;
  DriveSet drives() const override { return drives_of<VescDrive>(joints(), request().period()); }

 private:
  void check(const VescParameters& joint, JointValues& values) const override;
};

void VescFile::check(const VescParameters& joint, JointValues& values) const {
  if (joint.drive.on_silence == SilenceReaction::kHolds || joint.drive.on_silence == SilenceReaction::kKeeps) {
    values.refuse("on_silence", "must be coasts, brakes or unknown: the timeout of a VESC holds nothing at rest");
  }
  if (!request().takes_speeds && joint.torque_constant == 0) {
    values.refuse("torque_constant", "is missing: with robot.wheel_command: torque the currents follow from it",
                  "set N·m per A of the motor, or set robot.wheel_command to velocity");
  }
}

}  // namespace
}  // namespace vesc

std::unique_ptr<DriveFile> make_vesc_file(DriveFileRequest request) {
  return std::make_unique<vesc::VescFile>(std::move(request));
}

}  // namespace robot_control

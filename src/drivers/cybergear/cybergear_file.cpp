#include "drivers/cybergear/cybergear_drive.h"
#include "drivers/drive/mit/mit_drive_file.h"

namespace robot_control {
namespace cybergear {
namespace {

class CybergearFile final : public MitFile<CybergearParameters> {
 public:
  using MitFile::MitFile;
  DriveSet drives() const override { return drives_of<CybergearDrive>(joints(), request().period()); }

  /// All frames are orders and their answers. Three motors at 1 kHz have 6 of at most 160 bits in 1 ms: 0.96. A frame
  /// is repeated only where others have fewer stuffed bits than at worst.
  double max_load() const override { return 0.97; }

 private:
  void check(const CybergearParameters& joint, JointValues& values) const override {
    MitFile::check(joint, values);
    if (joint.drive.node == 0 || joint.drive.node > kMaxNode)
      values.refuse("node", "must be 1 … 127 on a CyberGear or RobStride motor", "set another CAN_ID");
    if (joint.drive.on_silence != SilenceReaction::kUnknown && joint.drive.on_silence != SilenceReaction::kKeeps)
      values.refuse("on_silence", "must be left out, or keeps for a motor without a timeout",
                    "remove it: the timeout is written to the motor, which then coasts");
  }
};

}  // namespace
}  // namespace cybergear

std::unique_ptr<DriveFile> make_cybergear_file(DriveFileRequest request) {
  return std::make_unique<cybergear::CybergearFile>(std::move(request));
}

}  // namespace robot_control

#include "drivers/ak/ak_drive.h"
#include "drivers/drive/mit/mit_drive_file.h"

namespace robot_control {
namespace ak {
namespace {

class AkFile final : public MitFile<AkParameters> {
 public:
  using MitFile::MitFile;
  DriveSet drives() const override { return drives_of<AkDrive>(joints(), request().period()); }

 private:
  void check(const AkParameters& joint, JointValues& values) const override {
    MitFile::check(joint, values);
    if (joint.drive.node == 0) values.refuse("node", "must be 1 … 254: AK motors answer to 0", "set another CAN ID");
    if (joint.drive.on_silence != SilenceReaction::kKeeps)
      values.refuse("on_silence", "must be keeps: an AK motor has no timeout, and keeps its last order for ever",
                    "state it, and keep an emergency stop that cuts the supply of the motors");
  }
};

}  // namespace
}  // namespace ak

std::unique_ptr<DriveFile> make_ak_file(DriveFileRequest request) {
  return std::make_unique<ak::AkFile>(std::move(request));
}

}  // namespace robot_control

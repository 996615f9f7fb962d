#include "drivers/damiao/damiao_drive.h"
#include "drivers/drive/mit/mit_drive_file.h"

namespace robot_control {
namespace damiao {
namespace {

class DamiaoFile final : public MitFile<DamiaoParameters> {
 public:
  using MitFile::MitFile;
  DriveSet drives() const override { return drives_of<DamiaoDrive>(joints(), request().period()); }

 private:
  void check(const DamiaoParameters& joint, JointValues& values) const override;
};

void DamiaoFile::check(const DamiaoParameters& joint, JointValues& values) const {
  MitFile::check(joint, values);
  const DriveParameters& drive = joint.drive;
  if (drive.node == 0 || drive.node > kMaxNode)
    values.refuse("node", "must be 1 … 15: the answers of a Damiao motor hold four bits of it", "set another ESC_ID");
  const std::uint64_t to_motor = joint.answers % 0x100, mode = joint.answers / 0x100;
  if (mode <= 3 && 1 <= to_motor && to_motor <= kMaxNode)
    values.refuse("answers", "must not be an identifier that motors obey: 1 … 15, 257 … 271, 513 … 527, 769 … 783",
                  "set another MST_ID");
  if (drive.on_silence != SilenceReaction::kUnknown)
    values.refuse("on_silence", "must be left out: the timeout is written to the motor, which then coasts");
}

}  // namespace
}  // namespace damiao

std::unique_ptr<DriveFile> make_damiao_file(DriveFileRequest request) {
  return std::make_unique<damiao::DamiaoFile>(std::move(request));
}

}  // namespace robot_control

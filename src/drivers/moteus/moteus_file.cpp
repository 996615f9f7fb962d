#include "drivers/drive/mit/mit_drive_file.h"
#include "drivers/moteus/moteus_drive.h"

namespace robot_control {
namespace moteus {
namespace {

class MoteusFile final : public MitFile<MoteusParameters> {
 public:
  explicit MoteusFile(DriveFileRequest given) : MitFile(std::move(given)) {
    bus.data_rate = 5.0e6;
    every_.drive.on_silence = SilenceReaction::kBrakes;  // as shipped
  }

  Keys line_keys() override {
    return joined({MitFile::line_keys(), {{"data_rate", &bus.data_rate, "bit/s", 1.0e6, 8.0e6, kOptional}}});
  }
  DriveSet drives() const override { return drives_of<MoteusDrive>(joints(), request().period()); }

 private:
  void check(const MoteusParameters& joint, JointValues& values) const override {
    MitFile::check(joint, values);
    if (joint.drive.node == 0 || joint.drive.node >= kBroadcast)
      values.refuse("node", "must be 1 … 126 on a moteus controller", "set another id.id");
    if (joint.drive.on_silence != SilenceReaction::kBrakes && joint.drive.on_silence != SilenceReaction::kCoasts)
      values.refuse("on_silence", "must be brakes or coasts, as servo.timeout_mode of the controller",
                    "set servo.timeout_mode to 12 or 15 (brakes), or to 0 (coasts), and state it");
  }
};

}  // namespace
}  // namespace moteus

std::unique_ptr<DriveFile> make_moteus_file(DriveFileRequest request) {
  return std::make_unique<moteus::MoteusFile>(std::move(request));
}

}  // namespace robot_control

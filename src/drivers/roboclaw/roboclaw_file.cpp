#include "drivers/roboclaw/roboclaw_driver.h"
#include "drivers/roboclaw/roboclaw_parameters.h"

namespace robot_control {
namespace {

class RoboclawFile final : public RoboclawBlocks {
 public:
  using FileOfJoints::FileOfJoints;

  std::string_view line_block() const override { return "roboclaw"; }
  double tolerated_silence() const override { return kRoboclawSilence; }
  std::unique_ptr<Driver> make_driver(const DriveMotors& motors, LineEnd end, DriverClock clock) const override;
};

}  // namespace

std::unique_ptr<Driver> RoboclawFile::make_driver(const DriveMotors& motors, LineEnd end, DriverClock clock) const {
  return std::make_unique<RoboclawDriver>(parameters_of(*this), motors.joint_count, request().period(),
                                          std::get<std::unique_ptr<SerialLine>>(std::move(end)),
                                          time_of(std::move(clock)));
}

std::unique_ptr<DriveFile> make_roboclaw_file(DriveFileRequest request) {
  return std::make_unique<RoboclawFile>(std::move(request));
}

}  // namespace robot_control

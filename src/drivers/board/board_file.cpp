#include <algorithm>
#include <numbers>

#include "drivers/board/board_driver.h"
#include "drivers/board/board_parameters.h"

namespace robot_control {
namespace {

constexpr double kWatchdog = 0.05;  // s
constexpr double kMaxCountsUnseen = 32767;
constexpr double kMaxCountsPerSecond = 0x3FFFFFFF / 256.0;  // firmware/board.c

class BoardFile final : public BoardBlocks {
 public:
  using FileOfJoints::FileOfJoints;

  std::string_view line_block() const override { return "board"; }
  /// kMaxSilence cycles, and no longer than the watchdog of a board waits for an order.
  double tolerated_silence() const override {
    return std::min(static_cast<double>(kMaxSilence) * request().period(), kWatchdog);
  }
  std::unique_ptr<Driver> make_driver(const DriveMotors& motors, LineEnd end, DriverClock clock) const override;

 private:
  void check(const BoardWheelParameters& wheel, JointValues& values) const override;
};

}  // namespace

std::unique_ptr<Driver> BoardFile::make_driver(const DriveMotors& motors, LineEnd end, DriverClock clock) const {
  return std::make_unique<BoardDriver>(parameters_of(*this), motors.brakes, motors.joint_count, request().period(),
                                       std::get<std::unique_ptr<SerialLine>>(std::move(end)),
                                       time_of(std::move(clock)));
}

void BoardFile::check(const BoardWheelParameters& wheel, JointValues& values) const {
  if (wheel.counter_bits != 16 && wheel.counter_bits != 32) values.refuse("counter_bits", "must be 16 or 32");
  const double fastest = wheel.velocity_limit * wheel.counts_per_turn / (2 * std::numbers::pi);
  if (request().takes_speeds && fastest > kMaxCountsPerSecond) {
    values.refuse("velocity_limit", "must be below 4 194 303 counts per second, the greatest speed of an order",
                  "set a lower one, or fewer counts per turn");
  }
  const double unseen = fastest * (static_cast<double>(line.max_silence) + 1) * request().period();
  if (wheel.counter_bits == 16 && unseen > kMaxCountsUnseen) {
    values.refuse("counter_bits",
                  "must be 32: a counter of 16 bits wraps unseen within max_silence at this velocity_limit",
                  "set counts of 32 bits, or a lower max_silence");
  }
  if (wheel.wheel >= request().joints.size() && values.accepted("wheel"))
    values.refuse("wheel", "must be below the number of joints, " + std::to_string(request().joints.size()));
}

std::unique_ptr<DriveFile> make_board_file(DriveFileRequest request) {
  return std::make_unique<BoardFile>(std::move(request));
}

}  // namespace robot_control

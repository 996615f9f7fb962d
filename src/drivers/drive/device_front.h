#pragma once
/// A DeviceFront is the other end of a driver's line: simulated devices with the motors of a simulated robot. The
/// driver sees them through the messages on the line alone.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "drivers/drive/drive_file.h"
#include "signals/joint.h"
#include "signals/sensor_frame.h"

namespace robot_control {

struct FrontSetup {
  const DriveMotors& motors;  ///< the brakes are those of drives that brake by themselves
  std::uint64_t seed = 1;
  std::optional<LineEnd> line{};  ///< the devices' end of a true line; none: one in virtual time
};

class DeviceFront {
 public:
  virtual ~DeviceFront() = default;

  /// Returns the number of joints with a device, the first ones of the robot.
  virtual std::size_t size() const = 0;

  /// Returns whether a motor knows the angle of its joint, as DriveParameters::is_absolute.
  virtual bool is_absolute() const { return false; }

  /// Returns the virtual time.
  virtual std::int64_t now_ns() const = 0;

  /// Returns the driver's end of a line in virtual time, once.
  virtual LineEnd driver_end() = 0;

  /// Returns whether the devices report the IMU of the robot. `sense` then takes its samples.
  virtual bool reports_imu() const { return false; }
  virtual void sense(const ImuSample& /*imu*/) {}

  /// Runs the devices for one period, with what the driver sent since the last call. Their own messages reach the
  /// driver at the end. `joints` hold the true position and velocity of each joint at the beginning.
  virtual void run(std::span<const JointSample> joints) = 0;

  /// Returns the mean torque of a joint over the last call of `run`, N·m.
  virtual double torque(std::size_t joint) const = 0;

  /// From now on a device has a fault. Returns the problem with the list of words; "" if there is none.
  virtual std::string inject(std::string_view component, std::string_view kind) = 0;
};

/// The devices of each drive of the table, as its drive file describes them.
#define DRIVE(name, ...) std::unique_ptr<DeviceFront> make_##name##_front(const DriveFile& file, FrontSetup setup);
#include "drivers/drive_table.def"

}  // namespace robot_control

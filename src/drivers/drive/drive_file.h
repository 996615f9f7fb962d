#pragma once
/// A DriveFile holds what the drive file states about the drives of one robot: a block about their line, and one block
/// per joint. Each drive of drive_table.def has its own, with its keys and the rules across them. It is read by
/// drivers/table/read_drive_file.h, and makes the driver.

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "drivers/drive_motors.h"
#include "drivers/driver.h"
#include "drivers/line/can_bus.h"
#include "drivers/line/datagram_line.h"
#include "drivers/line/serial_line.h"
#include "parameters/block.h"
#include "rt/realtime_thread.h"

namespace robot_control {

/// The end of a line in this process: of each CAN bus, of a serial line, or of a line of datagrams.
using CanSockets = std::vector<CanSocket>;
using LineEnd = std::variant<CanSockets, std::unique_ptr<SerialLine>, std::unique_ptr<DatagramLine>>;

/// States the present time; it is called in each cycle.
using DriverClock = std::function<CanTime()>;

struct DriveFileRequest {
  std::string_view drive{};         ///< its name in drive_table.def
  std::vector<std::string> joints;  ///< names of the robot's joints that have a motor, in their order
  double rate = 1000;               ///< Hz, of the loop
  double min_rate = 1;              ///< Hz, which a remedy may propose
  bool takes_speeds = false;        ///< robot.wheel_command

  double period() const noexcept { return 1 / rate; }
};

/// The greatest motion and torque of a drive at its joint, and the positions that its messages can hold.
struct DriveCapability {
  double velocity = std::numeric_limits<double>::infinity();     ///< rad/s or m/s
  double torque = std::numeric_limits<double>::infinity();       ///< N·m or N
  double torque_rate = std::numeric_limits<double>::infinity();  ///< N·m/s or N/s
  double lower = -std::numeric_limits<double>::infinity();       ///< rad
  double upper = std::numeric_limits<double>::infinity();        ///< rad
};

/// The given values of one joint, for rules across keys.
class JointValues {
 public:
  /// Returns whether the joint's own block has the value, and it is valid by itself.
  virtual bool accepted(const std::string& key) const = 0;
  /// Refuses a value, that of `every_joint` included.
  virtual void refuse(const std::string& key, const std::string& rule, const std::string& remedy = "") = 0;

 protected:
  ~JointValues() = default;
};

class DriveFile {
 public:
  explicit DriveFile(DriveFileRequest request) : request_(std::move(request)) {}
  virtual ~DriveFile() = default;
  DriveFile(const DriveFile&) = delete;
  DriveFile& operator=(const DriveFile&) = delete;

  const DriveFileRequest& request() const noexcept { return request_; }

  /// Returns the name of the block about the line, and its keys.
  virtual std::string_view line_block() const = 0;
  virtual Keys line_keys() = 0;
  virtual void check_line(GivenValues& /*given*/) const {}

  /// Returns the keys of `every_joint`, whose values the joints then begin with.
  virtual Keys every_keys() = 0;
  virtual void begin_joints() = 0;
  virtual Keys joint_keys(std::size_t joint) = 0;
  virtual void check_joint(std::size_t joint, JointValues& values) const = 0;

  /// Returns why the line cannot carry the messages, and the key of `line_block` to which this belongs. Frames that
  /// the drives can do without are left out before.
  struct Overload {
    std::string key, value, rule;
  };
  virtual std::optional<Overload> overload() { return {}; }

  virtual DriveCapability capability(std::size_t joint) const = 0;

  /// Returns the angle of the joint in rad at each start and each reset, if it is stated.
  virtual std::optional<double> start_angle(std::size_t /*joint*/) const { return {}; }

  /// Returns how old in s the samples may become without a fault of the robot, by the nature of the line.
  virtual double tolerated_silence() const { return 0; }

  virtual const std::string& address() const = 0;

  /// Opens the line at `address`. Throws DriverError.
  virtual LineEnd open_line(RealtimePolicy policy, const DriverClock& clock) const = 0;

  /// Returns the driver at the end of its line. Throws DriverError.
  virtual std::unique_ptr<Driver> make_driver(const DriveMotors& motors, LineEnd line, DriverClock clock) const = 0;

 private:
  DriveFileRequest request_;
};

/// The file of each drive of the table.
#define DRIVE(name, ...) std::unique_ptr<DriveFile> make_##name##_file(DriveFileRequest request);
#include "drivers/drive_table.def"

/// Returns the part of a joint's parameters that is common to all drives.
template <class Joint>
auto& common_of(Joint& joint) {
  if constexpr (requires { joint.drive; }) {
    return joint.drive;
  } else {
    return joint;
  }
}

/// A DriveFile whose joints have the keys of Joint. Two joints differ in `Joint::place`, which belongs to the key
/// kPlace of their common part, and is that of a kMotor.
template <class Base, class Joint>
class FileOfJoints : public Base {
 public:
  using Base::Base;

  Keys every_keys() override { return keys(every_); }
  void begin_joints() override {
    for (const std::string& name : this->request().joints) common_of(joints_.emplace_back(every_)).joint = name;
  }
  Keys joint_keys(std::size_t joint) override { return keys(joints_[joint]); }
  void check_joint(std::size_t joint, JointValues& values) const override {
    if (common_of(joints_[joint]).direction == 0) values.refuse("direction", "must be 1 or -1");
    check(joints_[joint], values);
    for (std::size_t other = 0; other < joint; ++other) {
      const auto& before = common_of(joints_[other]);
      if (same_line(joints_[joint], joints_[other]) && joints_[joint].place() == joints_[other].place() &&
          values.accepted(before.kPlace))
        values.refuse(before.kPlace, "is the " + std::string(before.kMotor) + " of " + before.joint + ", too",
                      "each joint has its own");
    }
  }
  DriveCapability capability(std::size_t joint) const override {
    const auto& common = common_of(joints_[joint]);
    DriveCapability capability{.velocity = common.velocity_limit};
    if constexpr (requires { common.torque_limit; }) capability.torque = common.torque_limit;
    return capability;
  }

  std::optional<double> start_angle(std::size_t joint) const override {
    if constexpr (requires { joints_[joint].start_angle; }) return joints_[joint].start_angle;
    return {};
  }

  const std::vector<Joint>& joints() const noexcept { return joints_; }

 protected:
  /// Returns whether the two joints have one line, on which their places differ.
  virtual bool same_line(const Joint& /*joint*/, const Joint& /*other*/) const { return true; }
  /// The rules of this drive.
  virtual void check(const Joint& /*joint*/, JointValues& /*values*/) const {}

  Joint every_;
  std::vector<Joint> joints_;
};

}  // namespace robot_control

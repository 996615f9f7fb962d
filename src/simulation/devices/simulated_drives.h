#pragma once
/// SimulatedDrives are the devices that a drive file describes, on a CAN bus in virtual time. Each is set up as its
/// drive file expects it. The joints are given; the torques of the motors come back.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "drivers/can/can_parameters.h"
#include "signals/joint.h"
#include "simulation/devices/device.h"

namespace robot_control {

/// Errors that bus and devices have all the time.
struct DeviceErrors {
  double frame_loss = 0;  ///< probability with which a frame is lost
  double clock_ppm = 0;   ///< by which the clocks of the devices run fast and slow in turn
  std::uint64_t seed = 1;
};

class SimulatedDrives {
 public:
  /// ns between two steps of a device; frames arrive at their own times.
  static constexpr std::int64_t kStepNs = 250'000;

  explicit SimulatedDrives(const CanParameters& parameters, const DeviceErrors& errors = {});
  SimulatedDrives(const SimulatedDrives&) = delete;
  SimulatedDrives& operator=(const SimulatedDrives&) = delete;

  VirtualCan& bus() noexcept { return bus_; }
  std::size_t size() const noexcept { return motors_.size(); }

  /// Runs until `until_ns`. `joints` hold the true position and velocity of each joint now; meanwhile they move on with
  /// their velocity.
  void run(std::span<const JointSample> joints, std::int64_t until_ns);

  /// Returns the mean torque of a joint over the last call of `run`, N·m.
  double torque(std::size_t joint) const { return torques_.at(joint); }

  /// A fault of a drive with two axes belongs to both.
  void inject(std::size_t joint, DeviceFault fault) { devices_.at(device_of_.at(joint))->inject(fault); }

 private:
  void add(const std::vector<odrive::OdriveParameters>& joints, const DeviceErrors& errors);
  void add(const std::vector<cia402::Cia402Parameters>& joints, const DeviceErrors& errors);
  void move_motors(std::span<const JointSample> joints, double seconds);

  VirtualCan bus_;
  std::vector<double> to_motor_;  // motor angle / joint angle
  std::vector<std::unique_ptr<DeviceMotor>> motors_;
  std::vector<std::unique_ptr<Device>> devices_;
  std::vector<std::size_t> device_of_;  // each joint
  std::vector<double> torques_;
};

}  // namespace robot_control

#pragma once
/// SimulatedDrives are the devices that a drive file describes, on a CAN bus in virtual time. Each is set up as its
/// drive file expects it. Their clocks run fast and slow by kClockPpm in turn. The joints are given; the torques of the
/// motors come back.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "drivers/drive/can_parameters.h"
#include "gate/brake_law.h"
#include "signals/joint.h"
#include "drivers/drive/device.h"

namespace robot_control {

class SimulatedDrives {
 public:
  /// ns between two steps of a device; frames arrive at their own times.
  static constexpr std::int64_t kStepNs = 250'000;

  static constexpr double kClockPpm = 200;
  static constexpr double kFrameLoss = 0.05;  ///< of a lossy bus

  /// `brakes`: one per joint, that of a drive which brakes by itself. `period` is the loop's in s.
  SimulatedDrives(const CanParameters& parameters, std::span<const Brake> brakes, double period, std::uint64_t seed);
  SimulatedDrives(const SimulatedDrives&) = delete;
  SimulatedDrives& operator=(const SimulatedDrives&) = delete;

  VirtualCan& bus() noexcept { return bus_; }
  const VirtualCan& bus() const noexcept { return bus_; }
  std::size_t size() const noexcept { return motors_.size(); }

  /// Runs until `until_ns`. `joints` hold the true position and velocity of each joint now; meanwhile they move on with
  /// their velocity.
  void run(std::span<const JointSample> joints, std::int64_t until_ns);

  /// Returns the mean torque of a joint over the last call of `run`, N·m.
  double torque(std::size_t joint) const { return torques_.at(joint); }

  /// From now on frames are lost with the probability kFrameLoss (`lossy`), and each is late by up to one period
  /// (`late`).
  void disturb(bool lossy, bool late);

  /// A fault of a drive with two axes belongs to both.
  void inject(std::size_t joint, DeviceFault fault) { devices_.at(device_of_.at(joint))->inject(fault); }

 private:
  /// One device per joint.
  template <class Joint>
  void add(const std::vector<Joint>& joints, std::span<const Brake> brakes);
  void add(const std::vector<cia402::Cia402Parameters>& joints, std::span<const Brake> brakes);
  void move_motors(std::span<const JointSample> joints, double seconds);

  VirtualCan bus_;
  std::int64_t period_ns_;
  std::vector<double> to_motor_;  // motor angle / joint angle
  std::vector<std::unique_ptr<DeviceMotor>> motors_;
  std::vector<std::unique_ptr<Device>> devices_;
  std::vector<std::size_t> device_of_;  // each joint
  std::vector<double> torques_;
};

}  // namespace robot_control

#pragma once
/// A DeviceSimulator is a simulated robot whose drives another program commands over a CAN bus, on the wall clock. To
/// that program it is a robot: plant, devices and bus take part only through the frames.
///
/// One call of `step` runs one period. Frames that came since the last call are on the simulated bus from the beginning
/// of the period on. The frames of the devices go out at its end.

#include <span>
#include <string>
#include <vector>

#include "drivers/can/can_bus.h"
#include "drivers/mujoco/mujoco_plant.h"
#include "simulation/devices/simulated_drives.h"

namespace robot_control {

class DeviceSimulator {
 public:
  /// `period` is in s. The bus is that of the drive file. Throws DriverError.
  DeviceSimulator(const DriveTrain& robot, const MujocoPlantParameters& plant, const CanParameters& can, double period);

  void step() noexcept;

  /// Returns the true state at the end of the last step.
  const TruthFrame& truth() const noexcept { return truth_; }

  /// As inject_device_fault.
  std::string inject(std::string_view component, std::string_view kind);

 private:
  MujocoPlant plant_;
  SimulatedDrives drives_;
  CanBus bus_;
  std::int64_t period_ns_;
  std::vector<std::string> joints_;
  std::size_t party_;               // of the other program on the simulated bus
  std::vector<can_frame> to_host_;  // since the last step
  TruthFrame truth_;
  std::vector<JointCommand> torques_;
};

}  // namespace robot_control

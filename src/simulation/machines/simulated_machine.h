#pragma once
/// The simulated machine that the parameters describe is a MuJoCo plant. Its motors are given their torques directly,
/// or they stand behind simulated drives on CAN (Parameters::drives).

#include <memory>
#include <string>
#include <vector>

#include "bus/latest_value.h"
#include "configuration/parameters.h"
#include "drivers/drive/device_front.h"
#include "drivers/driver.h"
#include "drivers/mujoco/mujoco_plant.h"
#include "gate/brake_law.h"
#include "machine/machine_model.h"

namespace robot_control {

/// A DeviceSimulator is a simulated robot whose drives another program commands over a line, on the wall clock. To that
/// program it is a robot: plant, devices and line take part only through the messages.
///
/// One call of `step` runs one period. Messages that came since the last call are on the line from the beginning of the
/// period on. Those of the devices go out at its end.
class DeviceSimulator {
 public:
  /// `period` is in s. Throws DriverError.
  DeviceSimulator(const MachineModel& robot, const MujocoPlantParameters& plant, double period,
                  std::unique_ptr<DeviceFront> devices);

  void step() noexcept;

  /// Any thread: the true state at the end of the last step. False, and `out` is as before, if steps disturbed it.
  bool truth(TruthFrame& out) const noexcept { return published_truth_.load(out); }

  /// As DeviceFront::inject.
  std::string inject(std::string_view component, std::string_view kind) { return devices_->inject(component, kind); }

 private:
  MujocoPlant plant_;
  std::unique_ptr<DeviceFront> devices_;
  TruthFrame truth_;
  LatestValue<TruthFrame> published_truth_;
  std::vector<JointCommand> torques_;
};

/// `brakes` are those of the robot's kind (robots/robot.h). Throws DriverError, and ParameterError with all problems of
/// the drive file.
std::unique_ptr<Driver> make_simulated_machine(const Parameters& parameters, const MachineModel& machine,
                                               const std::vector<Brake>& brakes);

/// Returns the simulated robot for a driver in another program, which finds it at the address of the drive file. Throws
/// as make_simulated_machine.
std::unique_ptr<DeviceSimulator> make_device_simulator(const Parameters& parameters, const MachineModel& machine,
                                                       const std::vector<Brake>& brakes);

}  // namespace robot_control

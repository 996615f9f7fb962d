#include "simulation/machines/simulated_machine.h"

#include <string>
#include <vector>

#include "configuration/drive_file.h"
#include "drivers/mujoco/mujoco_plant.h"
#include "simulation/machines/driven_plant.h"

namespace robot_control {

std::unique_ptr<Driver> make_simulated_machine(const Parameters& parameters, const DriveTrain& robot) {
  const double period = parameters.loop.period();
  if (parameters.drives.empty()) return std::make_unique<MujocoPlant>(robot, parameters.plant, period);
  std::vector<std::string> joints;
  for (const WheelModel& wheel : robot.wheels) joints.push_back(robot.joints[wheel.joint].name);
  const CanParameters can = read_drive_file(parameters.drives, joints, parameters.loop.rate);
  return std::make_unique<DrivenPlant>(robot, parameters.plant, can, period);
}

}  // namespace robot_control

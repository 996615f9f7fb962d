#include "safety/conditions/wheeled/wheeled_conditions.h"

namespace robot_control {

WheeledConditions::WheeledConditions(const SafetyParameters& parameters, const DriveTrain& robot, double period)
    : motion_(robot.wheels.size(), period),
      standstill_(parameters.standstill_speed, period),
      slide_(parameters, robot, period),
      targets_(robot.wheels.size()),
      wheel_limits_(parameters, robot, period),
      wheel_following_(parameters, robot, period),
      torque_oscillation_(parameters, robot, period),
      yaw_agreement_(parameters.yaw_rate, robot, period),
      rim_speed_(robot),
      body_conditions_(parameters, robot, middle_of_axles(robot), period) {}

void WheeledConditions::enter_run() noexcept {
  motion_.enter_run();
  standstill_.enter_run();
  slide_.enter_run();
  targets_.enter_run();
  wheel_limits_.enter_run();
  wheel_following_.enter_run();
  torque_oscillation_.enter_run();
  yaw_agreement_.enter_run();
  body_conditions_.enter_run();
}

void WheeledConditions::step(const MonitorInput& input, std::uint64_t elapsed, double speed_limit,
                             ActiveCauses& out) noexcept {
  const SensorFrame& sensors = *input.sensors;
  motion_.step(sensors);
  standstill_.step(motion_, sensors.head.cycle);
  slide_.step(motion_, standstill_.standing(), elapsed);
  targets_.step(input);
  wheel_limits_.step(sensors, motion_, targets_.passed(), speed_limit, elapsed, out);
  yaw_agreement_.step(sensors, motion_, elapsed, out);
  wheel_following_.step(sensors, targets_, motion_, standstill_, yaw_agreement_.excess(), elapsed, out);
  torque_oscillation_.step(input, targets_, motion_, elapsed, out);
  body_conditions_.step(sensors, elapsed, rim_speed_.value(sensors), standstill_.moving(), out);
}

}  // namespace robot_control

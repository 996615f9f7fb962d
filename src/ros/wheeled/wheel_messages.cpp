#include "ros/wheeled/wheel_messages.h"

#include "signals/names.h"

namespace robot_control {

std_msgs::Float64MultiArray joint_commands(const CommandFrame& command, const DriveTrain& robot) {
  std_msgs::Float64MultiArray message;
  for (const WheelModel& wheel : robot.wheels) message.data.push_back(command.joints[wheel.joint].velocity);
  std_msgs::MultiArrayDimension dimension;
  dimension.label = "wheel";
  dimension.size = dimension.stride = static_cast<std::uint32_t>(message.data.size());
  message.layout.dim.push_back(dimension);
  return message;
}

sensor_msgs::JointState joint_targets(const CommandFrame& command, const DriveTrain& robot, ros::Time stamp) {
  sensor_msgs::JointState message;
  message.header.stamp = stamp;
  for (const WheelModel& wheel : robot.wheels) {
    message.name.push_back(robot.joints[wheel.joint].name);
    message.velocity.push_back(command.joints[wheel.joint].velocity);
  }
  return message;
}

DriveState drive_state(const CommandFrame& command, const CommandFrame& plan, std::uint64_t reasons,
                       const DriveTrain& robot, ros::Time stamp) {
  DriveState message;
  message.header.stamp = stamp;
  for (const BitName& row : kCommandReasonNames) {
    if ((reasons & row.bit) == 0) continue;
    message.reasons.emplace_back(row.name);
    message.sentences.push_back(sentences_of({&row, 1}, row.bit, {.kind = kWheeledKind}));
  }
  for (const WheelModel& wheel : robot.wheels) {
    const double wanted = plan.joints[wheel.joint].velocity;
    const double actual = command.wheeled.velocity[wheel.joint];
    message.name.push_back(robot.joints[wheel.joint].name);
    message.wanted.push_back(wanted);
    message.actual.push_back(actual);
    message.error.push_back(wanted - actual);
    message.effort.push_back(command.joints[wheel.joint].effort);
  }
  return message;
}

}  // namespace robot_control

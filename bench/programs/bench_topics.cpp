/// bench_topics source|relay|sink CYCLES: the frames of the chain from sensors to command as roscpp topics on loopback.
///
/// The source publishes frames of the size of SensorFrame at 1 kHz. The relay answers each with one of the size of
/// StateFrame. The sink prints for each the time from the source's wake-up to its arrival in ns. Connections use
/// tcpNoDelay. All run under ordinary scheduling, as callbacks of roscpp do.

#include <ros/ros.h>
#include <std_msgs/Float64MultiArray.h>

#include <bit>
#include <iostream>
#include <string>

#include "rt/clock.h"
#include "signals/sensor_frame.h"
#include "signals/state_frame.h"

namespace robot_control::bench {

using Message = std_msgs::Float64MultiArray;

Message stamped(std::int64_t stamp_ns, std::size_t bytes) {
  Message message;
  message.data.resize(bytes / sizeof(double));
  message.data[0] = std::bit_cast<double>(stamp_ns);
  return message;
}

std::int64_t stamp_of(const Message& message) {
  return std::bit_cast<std::int64_t>(message.data[0]);
}

int run(const std::string& role, int cycles) {
  ros::NodeHandle handle;
  const auto hints = ros::TransportHints().tcpNoDelay();
  if (role == "source") {
    ros::Publisher sensors = handle.advertise<Message>("sensors", 10);
    std::int64_t deadline_ns = monotonic_ns();
    for (int i = 0; i < cycles && ros::ok(); ++i) {
      deadline_ns += 1'000'000;
      sleep_until(deadline_ns);
      sensors.publish(stamped(monotonic_ns(), sizeof(SensorFrame)));
    }
    return 0;
  }
  if (role == "relay") {
    ros::Publisher state = handle.advertise<Message>("state", 10);
    const auto answer = [&](const Message::ConstPtr& sensors) {
      state.publish(stamped(stamp_of(*sensors), sizeof(StateFrame)));
    };
    const auto subscriber = handle.subscribe<Message>("sensors", 10, answer, {}, hints);
    ros::spin();
    return 0;
  }
  int arrived = 0;
  const auto arrive = [&](const Message::ConstPtr& state) {
    std::cout << monotonic_ns() - stamp_of(*state) << "\n";
    if (++arrived == cycles) ros::requestShutdown();
  };
  const auto subscriber = handle.subscribe<Message>("state", 10, arrive, {}, hints);
  ros::spin();
  return 0;
}

}  // namespace robot_control::bench

int main(int argc, char** argv) {
  const std::string role = argc > 1 ? argv[1] : "";
  ros::init(argc, argv, "bench_" + role);
  if (argc != 3 || (role != "source" && role != "relay" && role != "sink")) {
    std::cerr << "usage: bench_topics source|relay|sink CYCLES\n";
    return 2;
  }
  return robot_control::bench::run(role, std::stoi(argv[2]));
}

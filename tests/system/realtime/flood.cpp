/// flood RATE: sends RATE messages a second on every input topic of a robot. It calls the services as often, or as fast
/// as they are answered. None of them stops the robot. It ends on SIGINT, and then prints how many it sent.

#include <geometry_msgs/TwistStamped.h>
#include <ros/ros.h>
#include <std_msgs/Bool.h>
#include <std_msgs/Empty.h>
#include <std_msgs/Float64.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace robot_control {
namespace {

using Clock = std::chrono::steady_clock;

/// Calls `act` so many times a second, in spells of a millisecond; calls that this program missed are not repeated.
void at_rate(double rate, const std::function<bool()>& act, std::atomic<std::uint64_t>& count) {
  constexpr auto kSpell = std::chrono::milliseconds(1);
  const int each = static_cast<int>(rate / 1000);
  Clock::time_point next = Clock::now();
  while (ros::ok()) {
    for (int i = 0; i < each && ros::ok(); ++i) count += act() ? 1 : 0;
    next = std::max(next + kSpell, Clock::now());
    std::this_thread::sleep_until(next);
  }
}

struct Flow {
  std::string name;
  std::function<bool()> act;
  std::atomic<std::uint64_t> count{0};
};

class Flood {
 public:
  explicit Flood(double rate) : rate_(rate) {
    geometry_msgs::Twist twist;
    twist.linear.x = 1.0;
    geometry_msgs::TwistStamped stamped;
    stamped.twist = twist;
    std_msgs::Bool no_stop;
    no_stop.data = 0;
    std_msgs::Float64 far;
    far.data = 1000.0;
    publish("cmd_vel", twist);
    publish("cmd_vel_stamped", stamped);
    publish("e_stop", no_stop);
    publish("heartbeat", std_msgs::Empty());
    publish("clearance", far);
    std_srvs::SetBool::Request run_on;
    run_on.data = 0;
    call<std_srvs::Trigger::Response>("e_stop_reset",
                                      std_srvs::Trigger::Request());  // in DRIVE: accepted, without effect
    call<std_srvs::Trigger::Response>("reset_odometry", std_srvs::Trigger::Request());
    call<std_srvs::SetBool::Response>("mujoco_plant/set_pause", run_on);
  }

  void run() {
    std::vector<std::thread> threads;
    for (const auto& flow : flows_) {
      threads.emplace_back([this, &flow] { at_rate(rate_, flow->act, flow->count); });
    }
    for (std::thread& thread : threads) thread.join();
    for (const auto& flow : flows_) {
      std::printf("%s %llu\n", flow->name.c_str(), static_cast<unsigned long long>(flow->count.load()));
    }
  }

 private:
  template <class Message>
  void publish(const std::string& topic, const Message& message) {
    const ros::Publisher publisher = handle_.advertise<Message>(topic, 100);
    add(topic, [publisher, message] {
      publisher.publish(message);
      return true;
    });
  }

  template <class Response, class Request>
  void call(const std::string& name, const Request& request) {
    ros::ServiceClient client = handle_.serviceClient<Request, Response>(name, true);
    add(name, [client, request]() mutable {
      Response response;
      return client.call(request, response);
    });
  }

  void add(const std::string& name, std::function<bool()> act) {
    flows_.push_back(std::make_unique<Flow>());
    flows_.back()->name = name;
    flows_.back()->act = std::move(act);
  }

  ros::NodeHandle handle_;
  double rate_;
  std::vector<std::unique_ptr<Flow>> flows_;
};

}  // namespace
}  // namespace robot_control

int main(int argc, char** argv) {
  ros::init(argc, argv, "flood");
  if (argc != 2) {
    std::fprintf(stderr, "usage: flood RATE\n");
    return 2;
  }
  robot_control::Flood(std::atof(argv[1])).run();
  return 0;
}

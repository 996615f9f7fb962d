#pragma once
/// A ServiceNode is a Node beside the loop: its Service uses topics, services and actions alone. The callbacks of ROS
/// run in the ordinary thread, one after the other.
///
/// A Service is constructed of `const Parameters&`: it creates its topics or refuses the start. It has
/// `diagnose(DiagnosticReport&)`. Its `static missing()` returns what it waits for before it is constructed.

#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <memory>
#include <string>
#include <vector>

#include "ros/nodes/node.h"

namespace robot_control {

template <class Service>
class ServiceNode final : public Node {
 public:
  explicit ServiceNode(const Setup& setup) : parameters_(setup.parameters) {}

  void connect(ros::NodeHandle& /*handle*/) override { poll(); }

  void poll() override {
    if (service_) return;
    missing_ = Service::missing();
    if (missing_.empty()) service_ = std::make_unique<Service>(parameters_);
  }

  void publish() override { ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(kWait)); }
  std::int64_t tick_ns() const override { return 0; }
  bool calls_callbacks() const override { return true; }
  bool finished() const override { return false; }
  void stop() override {}
  std::vector<std::string> missing() const override { return missing_; }
  std::vector<std::string> realtime_messages() const override { return {}; }

  void diagnose(DiagnosticReport& report) override {
    if (service_) service_->diagnose(report);
  }

 private:
  static constexpr double kWait = 0.05;  ///< s for a callback, half the period of `poll`

  Parameters parameters_;
  std::vector<std::string> missing_;
  std::unique_ptr<Service> service_;
};

}  // namespace robot_control

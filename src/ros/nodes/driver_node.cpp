#include "ros/nodes/driver_node.h"

#include <robot_control/InjectFault.h>
#include <robot_control/Step.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Clock.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include "drivers/external_imu.h"
#include "files/ascii.h"
#include "loop/processes/driver_process.h"
#include "ros/messages/motion_messages.h"
#include "ros/messages/service_answer.h"
#include "ros/messages/status_messages.h"
#include "ros/nodes/process_node.h"
#include "ros/reports/diagnostics.h"
#include "ros/reports/pacer.h"
#include "ros/reports/robot_report.h"
#include "ros/startup/description.h"
#include "rt/clock.h"

namespace robot_control {
namespace {

constexpr double kClockRate = 100;  // Hz of simulated time

class DriverNode final : public ProcessNode<DriverProcess> {
 public:
  DriverNode(const Setup& setup, MakeDriver make)
      : ProcessNode(setup, Role::kDriver),
        imu_pace_(report().imu_rate),
        truth_pace_(report().truth_rate),
        clock_pace_(kClockRate) {
    auto driver = with_imu(make(parameters(), composed()));
    driver_ = driver.get();
    simulator_ = simulator_of(*driver);
    description_ = std::make_unique<PublishedDescription>(robot(), parameters().urdf);
    process().open_driver(std::move(driver));
  }

  void connect(ros::NodeHandle& handle) override {
    log_robot();
    kind_ = handle.advertise<RobotKind>("robot_kind", 1, true);
    kind_.publish(robot_kind(robot(), programs(), process().services() != nullptr));
    imu_ = handle.advertise<sensor_msgs::Imu>("imu/data_raw", 10);
    truth_ = handle.advertise<nav_msgs::Odometry>("ground_truth/odom", 10);
    if (parameters().loop.clock == ClockMode::kLockstep) clock_ = handle.advertise<rosgraph_msgs::Clock>("/clock", 1);
    if (imu_inbox_) {
      imu_input_ =
          handle.subscribe("imu/input", 10, &DriverNode::receive_imu, this, ros::TransportHints().tcpNoDelay());
    }
    if (simulator_ != nullptr && simulator_->scan_cycles() != 0)
      scan_ = handle.advertise<sensor_msgs::LaserScan>("scan", 5);
    if (process().services() == nullptr) return;  // a real machine is neither paused nor reset
    ros::NodeHandle own("~");
    set_pause_ = own.advertiseService("set_pause", &DriverNode::set_pause, this);
    step_ = own.advertiseService("step", &DriverNode::step, this);
    reset_ = own.advertiseService("reset", &DriverNode::reset, this);
    inject_fault_ = own.advertiseService("inject_fault", &DriverNode::inject_fault, this);
  }

  std::int64_t tick_ns() const override {
    return publish_tick_ns(parameters(), sensors_.head.stamp_ns,
                           {&imu_pace_, &truth_pace_, clock_ ? &clock_pace_ : &truth_pace_});
  }

  void publish() override {
    if (process().sensors().newest(sensors_) != Lookup::kFrame || !process().is_current(sensors_.head)) return;
    const FrameHead& head = sensors_.head;
    time().follow(sensors_);
    describe_machine();
    if (clock_ && clock_pace_.due(head.run, head.stamp_ns)) publish_clock();
    if (imu_pace_.due(head.run, head.stamp_ns)) imu_.publish(imu(sensors_, robot(), time().at(head.stamp_ns)));
    publish_scans();
    if (!truth_pace_.due(head.run, head.stamp_ns) || process().truth().newest(truth_frame_) != Lookup::kFrame) return;
    truth_.publish(
        ground_truth(truth_frame_, report().odom_frame, report().base_frame, time().at(truth_frame_.head.stamp_ns)));
  }

  void stop() override {
    ProcessNode::stop();
    if (finished()) log_end();
  }

  void diagnose(DiagnosticReport& report) override {
    report_driver(report, sensors_, robot(), programs(), process().real_time_factor());
    double slip = 0;
    for (const double wheel : truth_frame_.slip) slip = std::max(slip, wheel);
    report.value("wheel_slip_m_s", slip);
    if (const std::string text = driver_->description(); !text.empty()) report.value("machine", text);
    if (const std::string warning = driver_->warning(); !warning.empty()) report.value("suspicious", warning);
    if (sensors_.driver_state == DriverState::kFault) {
      report.value("fault_message", std::string(driver_->fault_message()));
    }
  }

 private:
  /// An IMU of another node, or none, instead of the driver's.
  std::unique_ptr<Driver> with_imu(std::unique_ptr<Driver> driver) {
    if (parameters().imu == ImuChoice::kDriver) return driver;
    if (simulator_of(*driver) != nullptr)
      throw DriverError("robot.imu is for real robots, and the simulated one has its own IMU: remove robot.imu");
    auto inbox = std::make_shared<ImuInbox>();
    if (parameters().imu == ImuChoice::kTopic) {
      imu_inbox_ = inbox;
    } else {
      inbox->store({.imu = {}, .valid = 0, .time_ns = 0});
    }
    return std::make_unique<ExternalImu>(std::move(driver), std::move(inbox), &monotonic_ns, imu_inbox_ != nullptr);
  }

  void receive_imu(const sensor_msgs::Imu& message) {
    if (message.header.frame_id != imu_frame(robot())) {
      ROS_WARN_THROTTLE(10,
                        "imu/input is refused: it measures in the frame '%s', and the IMU of this robot in '%s' "
                        "(robot.imu_link)",
                        ascii(message.header.frame_id).c_str(), imu_frame(robot()).c_str());
      return;
    }
    const bool stamped = !message.header.stamp.isZero();
    const std::int64_t age_ns = stamped ? (ros::Time::now() - message.header.stamp).toNSec() : 0;
    imu_inbox_->store(imu_sample(message, monotonic_ns(), age_ns));
  }

  /// Says once what the machine is, and which conditions a robot without an IMU does not see.
  void describe_machine() {
    if (described_ || sensors_.driver_state != DriverState::kRunning) return;
    described_ = true;
    if (const std::string text = driver_->description(); !text.empty()) ROS_INFO("%s", text.c_str());
    if ((sensors_.valid & (kValidGyro | kValidAccelerometer)) != 0) return;
    ROS_WARN(
        "there is no IMU: the heading is computed from the wheels only, and these conditions detect nothing: imu_lost, "
        "imu_stuck, imu_jump, yaw_rate, tilt, tip_over, free_fall, impact");
  }

  void log_robot() {
    ROS_INFO("%s", summary(robot()).c_str());
    for (const RobotNote& note : robot().notes) {
      const std::string text = sentence(note);
      if (needs_a_look(note)) {
        ROS_WARN("%s", text.c_str());
      } else {
        ROS_INFO("%s", text.c_str());
      }
    }
    if (const std::string warning = driver_->warning(); !warning.empty()) ROS_WARN("suspicious: %s", warning.c_str());
  }

  void log_end() {
    TruthFrame truth;
    if (process().truth().newest(truth) != Lookup::kFrame) return;
    const auto cycles = static_cast<double>(truth.head.cycle + 1);
    const auto& position = truth.pose_world.position;
    ROS_INFO("the run has ended after %.0f cycles (%g s): the robot is at x = %.3f m, y = %.3f m", cycles,
             cycles * parameters().loop.period(), position[0], position[1]);
  }

  template <class Response>
  static bool log_and_answer(const ServiceAnswer& given, Response& response) {
    if (given.success) {
      ROS_INFO("%s", given.message.c_str());
    } else {
      ROS_WARN("%s", given.message.c_str());
    }
    return answer(response, given.success, given.message);
  }

  bool set_pause(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response) {
    return log_and_answer(process().services()->set_pause(request.data != 0), response);
  }

  bool step(Step::Request& request, Step::Response& response) {
    return log_and_answer(process().services()->step(request.cycles), response);
  }

  bool reset(std_srvs::Trigger::Request& /*request*/, std_srvs::Trigger::Response& response) {
    return log_and_answer(process().services()->reset(), response);
  }

  bool inject_fault(InjectFault::Request& request, InjectFault::Response& response) {
    return log_and_answer(process().services()->inject_fault(request.component, request.kind), response);
  }

  /// Casts the rays here, from copies of the true state.
  void publish_scans() {
    TruthFrame scanned;
    while (process().next_scanned(scanned)) {
      if (!process().is_current(scanned.head) || scan_.getNumSubscribers() == 0) continue;
      scan_.publish(laser_scan(simulator_->scan(scanned), time().at(scanned.head.stamp_ns)));
    }
  }

  void publish_clock() {
    rosgraph_msgs::Clock message;
    message.clock = time().at(sensors_.head.stamp_ns);
    clock_.publish(message);
  }

  const Driver* driver_ = nullptr;
  Simulator* simulator_ = nullptr;  // null: a real machine
  std::unique_ptr<PublishedDescription> description_;
  std::shared_ptr<ImuInbox> imu_inbox_;  // null: the driver's own IMU, or none
  bool described_ = false;
  ros::Subscriber imu_input_;
  ros::Publisher kind_;
  ros::Publisher imu_;
  ros::Publisher truth_;
  ros::Publisher clock_;
  ros::Publisher scan_;
  ros::ServiceServer set_pause_;
  ros::ServiceServer step_;
  ros::ServiceServer reset_;
  ros::ServiceServer inject_fault_;
  Pacer imu_pace_;
  Pacer truth_pace_;
  Pacer clock_pace_;
  SensorFrame sensors_;
  TruthFrame truth_frame_;
};

}  // namespace

std::unique_ptr<Node> make_driver_node(const Setup& setup, MakeDriver make) {
  return std::make_unique<DriverNode>(setup, make);
}

}  // namespace robot_control

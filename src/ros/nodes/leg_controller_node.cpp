#include "ros/nodes/leg_controller_node.h"

#include <ros/ros.h>

#include <algorithm>
#include <utility>

#include "files/ascii.h"
#include "machine/legs/leg_model.h"
#include "ros/inputs/input_topic.h"
#include "ros/messages/leg_messages.h"
#include "ros/messages/motion_messages.h"
#include "ros/nodes/commanded_node.h"
#include "ros/reports/diagnostics.h"
#include "ros/reports/pacer.h"
#include "rt/futex.h"
#include "signals/names.h"

namespace robot_control {
namespace {

constexpr std::int64_t kBeginWait = 1'000'000'000;  // ns, in which the posture must begin to change
constexpr std::int64_t kRepeat = 10'000'000;        // ns; another sender's message may have replaced the request

/// Returns whether the robot already is in this posture, or on its way.
bool begun(StanceMode mode, LegPhase phase) {
  if (mode == kStanceLie) return phase == LegPhase::kLying || phase == LegPhase::kLowering;
  return phase == LegPhase::kGathering || phase == LegPhase::kRising || phase == LegPhase::kStanding;
}

class LegControllerNode final : public CommandedNode {
 public:
  explicit LegControllerNode(const Setup& setup)
      : CommandedNode(setup, input_),
        input_(parameters().leg_control.request_timeout, parameters().leg_control.one_sender),
        pace_(report().leg_state_rate) {}

  void connect(ros::NodeHandle& handle) override {
    leg_state_ = handle.advertise<msg::LegState>("leg_state", 10);
    set_posture_ = handle.advertiseService("set_posture", &LegControllerNode::set_posture, this);
    intake().start(earlier_controller(handle, {"body_pose", "foot_target"}));
    body_pose_.connect_with_sender(handle, [this](const msg::BodyPose& message, const Publisher& sender) {
      receive({.sender = sender, .twist = {}, .posture = posture_of(message)});
    });
    foot_target_.connect_with_sender(handle, [this](const msg::FootTarget& message, const Publisher& sender) {
      const auto request = request_of(message);
      if (request) return receive({.sender = sender, .twist = {}, .posture = request->posture, .mode = request->mode});
      ROS_WARN_THROTTLE(10, "foot_target of %s is refused: there is no foot '%s'; name one of %s", sender.name.c_str(),
                        ascii(message.foot).c_str(), foot_names().c_str());
    });
    cmd_vel_.connect_with_sender(handle, [](const msg::Twist& message, const Publisher& sender) {
      if (zero(twist_of(message))) return;
      ROS_WARN_THROTTLE(10,
                        "cmd_vel of %s is refused: this robot does not walk yet; body_pose moves its body, foot_target "
                        "a foot, set_posture lets it stand up or lie down",
                        sender.name.c_str());
    });
  }

  /// `plan` of a message must still be on the bus.
  std::int64_t tick_ns() const override {
    const std::int64_t kept_ns = static_cast<std::int64_t>(kFrameSlots) / 2 * parameters().loop.period_ns();
    return std::min(kept_ns, publish_tick_ns(parameters(), command_.head.stamp_ns, {&pace_}));
  }

  void publish() override {
    if (!follow_command() || !pace_.due(command_.head.run, command_.head.stamp_ns)) return;
    SensorFrame sensors;
    if (process().sensors().at(command_.head.run, command_.head.cycle, sensors) != Lookup::kFrame) return;
    StateFrame state;
    process().states().at(command_.head.run, command_.head.cycle, state);
    CommandFrame plan;
    if (command_.head.cycle >= 2) process().output().at(command_.head.run, command_.head.cycle - 2, plan);
    msg::LegState message = leg_state({command_, plan, sensors, state, std::exchange(since_message_, 0)},
                                      leg_model_of(robot()), time().at(command_.head.stamp_ns));
    {
      const std::lock_guard lock(input_mutex_);
      const std::vector<std::string> senders = intake().senders(loop_ns()), revoked = intake().revoked();
      message.senders.assign(senders.begin(), senders.end());
      message.revoked.assign(revoked.begin(), revoked.end());
    }
    leg_state_.publish(message);
  }

  void diagnose(DiagnosticReport& report) override {
    const std::lock_guard lock(input_mutex_);
    report_command(report, command_, std::exchange(since_report_, 0), intake().senders(loop_ns()), {},
                   intake().revoked());
    report.value("posture", std::string(name_of(command_.legged.phase)));
  }

 private:
  /// Two topics call this from two threads; the mutex protects their common inbox.
  void receive(const ArrivedCommand& arrived) {
    const std::lock_guard lock(input_mutex_);
    input_.receive(arrived, arrival_of(arrived.sender.name));
    store();
  }

  bool set_posture(msg::SetPostureRequest& request, msg::SetPostureResponse& response) {
    const std::unique_lock one_at_a_time(posture_mutex_, std::try_to_lock);
    const std::string problem =
        one_at_a_time ? reach(request.posture) : "another set_posture is being answered: call again";
    response.success = problem.empty() ? 1 : 0;
    response.message = ascii(problem.empty() ? request.posture : "refused: " + problem);
    if (problem.empty()) {
      ROS_INFO("set_posture: %s", response.message.c_str());
    } else {
      ROS_WARN("set_posture '%s' %s", ascii(request.posture).c_str(), response.message.c_str());
    }
    return true;
  }

  /// Returns "" once the robot is in the posture or on its way to it, or why it is not.
  std::string reach(const std::string& posture) {
    const StanceMode mode = mode_of(posture);
    if (mode == kStanceStay) return "there is no posture '" + posture + "'; name standing or lying";
    for (const std::string& name : missing()) return "the loop does not run: waiting for " + name;
    CommandFrame command;
    for (std::int64_t waited_ns = 0; waited_ns < kBeginWait; waited_ns += kRepeat) {
      if (process().output().newest(command) == Lookup::kFrame && process().is_current(command.head) &&
          (command.reasons & kReasonNoPermit) == 0 && begun(mode, command.legged.phase))
        return "";
      Permit permit;
      const bool found = process().permits().newest(permit) == Lookup::kFrame && process().is_current(permit.head);
      if (std::string problem = no_permission(found, permit, robot()); !problem.empty()) return problem;
      {
        const std::lock_guard lock(input_mutex_);
        input_.receive_once({.twist = {}, .posture = {}, .mode = mode}, arrival_of("set_posture"));
        store();
      }
      sleep_ns(kRepeat);
    }
    return "the posture has not begun to change within 1 s: " + sentences_of(kCommandReasonNames, command.reasons);
  }

  InputTopic<BoundedBodyPose> body_pose_{"body_pose", 1};
  InputTopic<BoundedFootTarget> foot_target_{"foot_target", 1};
  InputTopic<BoundedTwist> cmd_vel_{"cmd_vel", 1};
  ros::Publisher leg_state_;
  ros::ServiceServer set_posture_;
  std::mutex posture_mutex_;  ///< locked only by try_lock
  CommandInput input_;
  Pacer pace_;
};

}  // namespace

std::unique_ptr<Node> make_leg_controller(const Setup& setup) {
  return std::make_unique<LegControllerNode>(setup);
}

}  // namespace robot_control

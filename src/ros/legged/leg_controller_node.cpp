#include "ros/legged/leg_controller_node.h"

#include <ros/ros.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "files/ascii.h"
#include "machine/legs/leg_model.h"
#include "parameters/block.h"
#include "ros/inputs/input_topic.h"
#include "ros/legged/joint_trajectory.h"
#include "ros/legged/leg_messages.h"
#include "ros/messages/motion_messages.h"
#include "ros/messages/service_answer.h"
#include "ros/nodes/commanded_node.h"
#include "ros/reports/diagnostics.h"
#include "ros/reports/name_list.h"
#include "ros/reports/pacer.h"
#include "rt/futex.h"
#include "signals/names.h"

namespace robot_control {
namespace {

constexpr std::int64_t kBeginWait = 1'000'000'000;  // ns, in which the posture must begin to change, gathering apart
constexpr std::int64_t kRepeat = 10'000'000;        // ns; another sender's message may have replaced the request
constexpr std::int64_t kStep = 10'000'000;          // ns of the loop's time between two requests of a trajectory
constexpr double kRefusalPause = 0.1;               // s between two lines about refused trajectories
constexpr double kArrival = 0.3;                    // s after its last point, in which the joints arrive there

double seconds_of(std::int64_t ns) {
  return 1e-9 * static_cast<double>(ns);
}

/// Returns whether the robot already is in this posture, or on its way. It may still refuse while it gathers its legs.
bool begun(const Mode& mode, LegPhase phase) {
  if (mode.kind == ModeKind::kLie) return phase == LegPhase::kLying || phase == LegPhase::kLowering;
  return phase == LegPhase::kRising || phase == LegPhase::kStanding || phase == LegPhase::kWalking;
}

class LegControllerNode final : public CommandedNode {
 public:
  explicit LegControllerNode(const Setup& setup)
      : CommandedNode(setup, input_),
        input_(parameters().leg_control.request_timeout, parameters().leg_control.one_sender, "request_timeout"),
        pace_(report().leg_state_rate) {}

  void connect(ros::NodeHandle& handle) override {
    leg_state_ = handle.advertise<LegState>("leg_state", 10);
    velocity_out_ = handle.advertise<geometry_msgs::TwistStamped>("cmd_vel_out", 10);
    velocity_requested_ = handle.advertise<geometry_msgs::TwistStamped>("cmd_vel_requested", 10);
    set_posture_ = handle.advertiseService("set_posture", &LegControllerNode::set_posture, this);
    set_gait_ = handle.advertiseService("set_gait", &LegControllerNode::set_gait, this);
    intake().start(
        earlier_controller(handle, {"body_pose", "foot_target", "joint_trajectory", "cmd_vel", "cmd_vel_stamped"}));
    body_pose_.connect_with_sender(handle, [this](const BodyPose& message, const Publisher& sender) {
      receive({.sender = sender, .twist = {}, .posture = posture_of(message), .part = StatedPart::kPose});
    });
    foot_target_.connect_with_sender(handle, [this](const FootTarget& message, const Publisher& sender) {
      const auto request = request_of(message);
      if (request) return receive({.sender = sender, .twist = {}, .posture = request->posture, .mode = request->mode});
      ROS_WARN_THROTTLE(10, "foot_target of %s is refused: there is no foot '%s'; set one of %s", sender.name.c_str(),
                        ascii(message.foot).c_str(), foot_names().c_str());
    });
    joint_trajectory_.connect_with_sender(handle, [this](const trajectory_msgs::JointTrajectory& message,
                                                         const Publisher& sender) { begin(message, sender); });
    cmd_vel_.connect_with_sender(handle, [this](const geometry_msgs::Twist& message, const Publisher& sender) {
      receive({.sender = sender, .twist = twist_of(message), .part = StatedPart::kTwist});
    });
    cmd_vel_stamped_.connect_with_sender(handle, [this](const geometry_msgs::TwistStamped& message,
                                                        const Publisher& sender) {
      const auto stamp_ns = static_cast<std::int64_t>(message.header.stamp.toNSec());
      receive({.sender = sender, .twist = twist_of(message.twist), .stamp_ns = stamp_ns, .part = StatedPart::kTwist});
    });
  }

  /// `plan` of a message must still be on the bus.
  std::int64_t tick_ns() const override {
    const std::int64_t kept_ns = static_cast<std::int64_t>(kFrameSlots) / 2 * parameters().loop.period_ns();
    return std::min(kept_ns, publish_tick_ns(parameters(), command_.head.stamp_ns, {&pace_}));
  }

  void publish() override {
    const bool follows = follow_command();
    if (follows) met_.add(reports_.risers, reports_.reaches, command_.head);
    {
      const std::lock_guard lock(input_mutex_);
      if (follows) continue_trajectory();
    }
    if (!follows || !pace_.due(command_.head.run, command_.head.stamp_ns)) return;
    SensorFrame sensors;
    if (process().sensors().at(command_.head.run, command_.head.cycle, sensors) != Lookup::kFrame) return;
    StateFrame state;
    process().states().at(command_.head.run, command_.head.cycle, state);
    CommandFrame plan;
    if (command_.head.cycle >= 2) process().output().at(command_.head.run, command_.head.cycle - 2, plan);
    LegState message = leg_state({command_, plan, sensors, state, gaits_, std::exchange(since_message_, 0), met_},
                                 leg_model_of(robot()), time().at(command_.head.stamp_ns));
    {
      const std::lock_guard lock(input_mutex_);
      message.senders = intake().senders(loop_ns());
      message.revoked = intake().revoked();
      message.chosen_gait = gait_of_mode(input_.chosen_mode(), gaits_);
    }
    leg_state_.publish(message);
    const ros::Time stamp = time().at(command_.head.stamp_ns);
    velocity_out_.publish(velocity_out(command_, report().base_frame, stamp));
    velocity_requested_.publish(velocity_requested(command_, report().base_frame, stamp));
  }

  void diagnose(DiagnosticReport& report) override {
    const std::lock_guard lock(input_mutex_);
    report_command(report, command_, std::exchange(since_report_, 0), programs(), intake().senders(loop_ns()), {},
                   intake().revoked());
    report.value("posture", std::string(name_of(command_.legged.phase)));
    report.value("ground", ground_words(command_.legged));
  }

 private:
  /// Two topics call this from two threads; the mutex protects their common inbox.
  void receive(const ArrivedCommand& arrived) {
    const std::lock_guard lock(input_mutex_);
    end_trajectory("a message of " + arrived.sender.name + " on another topic came");
    input_.receive(arrived, arrival_of(arrived.sender.name));
    store();
  }

  /// A trajectory that is being executed.
  struct Execution {
    JointTrajectory path;
    Publisher sender;                        ///< without its connection
    boost::weak_ptr<const void> connection;  ///< The trajectory ends with it.
    double time = 0;                         ///< s, on the path
    std::int64_t requested_ns = 0;           ///< when it was requested, in the loop's time
    bool moves = false;                      ///< The joints have begun to move.
  };

  void begin(const trajectory_msgs::JointTrajectory& message, const Publisher& sender) {
    const std::lock_guard lock(input_mutex_);
    if (message.points.empty()) {
      end_trajectory(sender.name + " sent an empty one");
      input_.receive({.sender = sender, .twist = {}}, arrival_of(sender.name));
      store();
      return;
    }
    Execution next{
        .path = {}, .sender = {sender.name, nullptr, sender.uri, sender.topic}, .connection = sender.connection};
    next.requested_ns = loop_ns();
    std::string problem = read(message, next);
    // A request during a stop is received, so that its sender is revoked, and not executed.
    const bool accepted =
        problem.empty() && request_path(next, sender, static_cast<std::int64_t>(message.header.stamp.toNSec()));
    if (problem.empty()) problem = refusal_of_permission();
    if (!problem.empty()) {
      ROS_WARN_THROTTLE(kRefusalPause, "joint_trajectory of %s is refused: %s", sender.name.c_str(),
                        ascii(problem).c_str());
    }
    if (!problem.empty() || !accepted) return;
    execution_ = std::move(next);
    ROS_INFO("joint_trajectory of %s: %.3g s", sender.name.c_str(), execution_->path.duration());
  }

  /// Returns why this trajectory cannot begin, but for the permission to move, or "".
  std::string read(const trajectory_msgs::JointTrajectory& message, Execution& to) {
    for (const std::string& name : missing()) return "the loop does not run: waiting for " + name;
    CommandFrame command;
    SensorFrame sensors;
    if (process().output().newest(command) != Lookup::kFrame || !process().is_current(command.head) ||
        process().sensors().newest(sensors) != Lookup::kFrame || !process().is_current(sensors.head))
      return "the loop does not run: send it again when safety_status is READY";
    const LegPhase phase = command.legged.phase;
    if (phase != LegPhase::kLying && phase != LegPhase::kJoints)
      return "the robot does not lie; it is " + std::string(name_of(phase)) + ": call set_posture with 'lying'";
    if (execution_ && execution_->sender.name != to.sender.name) {
      const double left = execution_->path.duration() - execution_->time;
      return "that of " + execution_->sender.name + " is being executed for another " +
             shortest(std::max(0.1, std::round(10 * left) / 10)) + " s; send an empty one to end it";
    }
    const AllJointBounds bounds = joint_bounds(leg_model_of(robot()));
    JointTrajectory::Positions start{};
    for (std::size_t i = 0; i < kLegsJoints; ++i) {
      const bool moves = phase == LegPhase::kJoints && command.joints[i].mode == JointMode::kImpedance;
      if (!moves && !has_position(sensors.joints[i]))
        return "the joint " + robot().joints[i].name +
               " is not measured: check the faults of the driver in /diagnostics";
      start[i] = std::clamp(moves ? command.joints[i].position : sensors.joints[i].position, bounds[i].range.lower,
                            bounds[i].range.upper);
    }
    return to.path.read(message, leg_model_of(robot()), start);
  }

  /// Requests where the joints shall be kHorizon later. Returns false if the intake refuses that; it reports why.
  bool request_path(const Execution& execution, const Publisher& sender, std::int64_t stamp_ns = 0) {
    const std::uint64_t accepted = input_.value().count;
    input_.receive({.sender = sender,
                    .twist = {},
                    .stamp_ns = stamp_ns,
                    .mode = {ModeKind::kJoints},
                    .joints = execution.path.at(execution.time + JointMotion::kHorizon)},
                   arrival_of(sender.name));
    store();
    return input_.value().count != accepted;
  }

  /// Is called with every tick; the caller holds input_mutex_.
  void continue_trajectory() {
    if (!execution_) return;
    const LegPhase phase = command_.legged.phase;
    execution_->moves = execution_->moves || phase == LegPhase::kJoints;
    const bool lies = phase == LegPhase::kJoints || (phase == LegPhase::kLying && !execution_->moves);
    if (const std::string problem = refusal_of_permission(); !problem.empty()) return end_trajectory(problem);
    if (!lies) return end_trajectory("the robot is " + std::string(name_of(phase)));
    Publisher sender = execution_->sender;
    sender.connection = execution_->connection.lock();
    if (sender.connection == nullptr) return end_trajectory("its sender has ended");
    const std::int64_t now_ns = loop_ns();
    const std::int64_t elapsed_ns = now_ns - execution_->requested_ns;
    if (elapsed_ns >= 0 && elapsed_ns < kStep) return;
    execution_->requested_ns = now_ns;
    // The joints wait as long as this thread had to wait.
    execution_->time += std::clamp(seconds_of(elapsed_ns), 0.0, JointMotion::kHorizon);
    if (execution_->time < execution_->path.duration() + kArrival) {
      if (!request_path(*execution_, sender)) end_trajectory("its request was refused");
      return;
    }
    execution_.reset();
    input_.receive({.sender = sender, .twist = {}}, arrival_of(sender.name));
    store();
    ROS_INFO("joint_trajectory of %s: done", sender.name.c_str());
  }

  /// Does nothing where no trajectory is being executed.
  void end_trajectory(const std::string& why) {
    if (!execution_) return;
    ROS_WARN("joint_trajectory of %s ends: %s", execution_->sender.name.c_str(), ascii(why).c_str());
    execution_.reset();
  }

  /// Returns why no motion is permitted, or "".
  std::string refusal_of_permission() {
    Permit permit;
    const bool found = process().permits().newest(permit) == Lookup::kFrame && process().is_current(permit.head);
    return no_permission(found, permit, robot(), programs());
  }

  bool set_gait(SetGait::Request& request, SetGait::Response& response) {
    const std::lock_guard lock(input_mutex_);
    const std::optional<Mode> mode = mode_of_gait(request.gait, gaits_);
    const LegPhase phase = command_.legged.phase;
    std::string problem = refusal_of_permission();
    if (!mode) {
      problem = "unknown gait '" + request.gait + "'; set one of " + joined(gait_words(gaits_));
    } else if (problem.empty() && phase != LegPhase::kStanding && phase != LegPhase::kWalking) {
      problem = "the robot does not stand or walk; it is " + std::string(name_of(phase)) +
                ": call set_posture with 'standing'";
    }
    if (problem.empty()) input_.choose_mode(*mode);
    return answer(response, problem.empty(), problem.empty() ? request.gait : "refused: " + problem);
  }

  bool set_posture(SetPosture::Request& request, SetPosture::Response& response) {
    const std::unique_lock one_at_a_time(posture_mutex_, std::try_to_lock);
    const std::string problem =
        one_at_a_time ? reach(request.posture) : "another set_posture is in progress: call again";
    answer(response, problem.empty(), problem.empty() ? request.posture : "refused: " + problem);
    if (problem.empty()) {
      ROS_INFO("set_posture: %s", response.message.c_str());
    } else {
      ROS_WARN("set_posture '%s' %s", ascii(request.posture).c_str(), response.message.c_str());
    }
    return true;
  }

  /// Returns "" once the robot is in the posture or on its way to it, or why it is not.
  std::string reach(const std::string& posture) {
    const Mode mode = mode_of(posture);
    if (mode == Mode{}) return "unknown posture '" + posture + "'; set standing or lying";
    for (const std::string& name : missing()) return "the loop does not run: waiting for " + name;
    SensorFrame sensors;
    if (process().sensors().newest(sensors) == Lookup::kFrame && sensors.driver_state == DriverState::kPaused)
      return "the simulation is paused: call " + std::string(program_of(Role::kDriver, programs())) +
             "/set_pause with false first";
    CommandFrame command;
    for (std::int64_t waited_ns = 0; waited_ns < kBeginWait; waited_ns += kRepeat) {
      if (std::string problem = refusal_of_permission(); !problem.empty()) return problem;
      if (process().output().newest(command) == Lookup::kFrame && process().is_current(command.head) &&
          (command.reasons & (kReasonNoPermit | kReasonPermitBrake)) == 0) {
        if (begun(mode, command.legged.phase)) return "";
        if (mode.kind == ModeKind::kStand && command.legged.phase == LegPhase::kGathering) waited_ns = 0;
      }
      {
        const std::lock_guard lock(input_mutex_);
        end_trajectory("set_posture was called");
        input_.receive_once({.twist = {}, .posture = {}, .mode = mode}, arrival_of("set_posture"));
        store();
      }
      sleep_ns(kRepeat);
    }
    const std::lock_guard lock(input_mutex_);
    input_.withdraw(mode, loop_ns());
    store();
    StateFrame state;
    process().states().newest(state);
    return "the posture did not begin to change within 1 s: " +
           sentences_of(kCommandReasonNames, command.reasons, programs()) +
           slope_words(command.reasons, state, leg_model_of(robot()));
  }

  InputTopic<BoundedBodyPose> body_pose_{"body_pose", 1};
  InputTopic<BoundedFootTarget> foot_target_{"foot_target", 1};
  InputTopic<BoundedJointTrajectory> joint_trajectory_{"joint_trajectory", 2};
  InputTopic<BoundedTwist> cmd_vel_{"cmd_vel", 1};
  InputTopic<BoundedTwistStamped> cmd_vel_stamped_{"cmd_vel_stamped", 1};
  ros::Publisher leg_state_;
  ros::Publisher velocity_out_, velocity_requested_;
  ros::ServiceServer set_posture_;
  ros::ServiceServer set_gait_;
  std::mutex posture_mutex_;  ///< locked only by try_lock
  CommandInput input_;
  const Gaits gaits_ = all_gaits(parameters().leg_control.gaits);
  std::optional<Execution> execution_;  ///< protected by input_mutex_
  MetGround met_;
  Pacer pace_;
};

}  // namespace

std::unique_ptr<Node> make_leg_controller(const Setup& setup) {
  return std::make_unique<LegControllerNode>(setup);
}

}  // namespace robot_control

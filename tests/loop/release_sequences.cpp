#include "loop/release_sequences.h"

#include <algorithm>
#include <array>
#include <boost/make_shared.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "control/wheeled/derived_tuning.h"
#include "cycle_fixture.h"
#include "drivers/mujoco/mujoco_plant.h"
#include "machine/legs/leg_model.h"
#include "robots/quadruped.h"
#include "ros/inputs/command_input.h"
#include "ros/inputs/command_mux.h"
#include "ros/inputs/e_stop_levels.h"

namespace robot_control {
namespace {

enum Node : std::size_t { kDriverNode, kEstimatorNode, kControllerNode, kMonitorNode, kNodes };
enum class Message { kNone, kZero, kMotion, kNotFinite, kStale, kAgedZero, kAgedMotion };

constexpr double kTimeout = 0.05;  // s, at first
constexpr std::int64_t kTimeoutTicks = 50;
constexpr std::array kTimeouts{0.0, 0.02, kTimeout, 0.1};  // s, that set_parameters takes
constexpr std::array kLegTimeouts{kTimeout, 0.0, 1.25};    // s, request_timeout by seed
constexpr std::int64_t kJudgesMargin = 6;                  // ticks, of the judge's T
constexpr std::int64_t kWithRelease = 100;                 // driver cycles, MotionRequests::in_transit_ns
constexpr std::int64_t kInTransit = 3;  // driver cycles from a message to the command frame that the monitor reads
constexpr std::int64_t kBrakesWithin = kPermitLife + 2;  // driver cycles for which the last permit lives at the gate
constexpr std::int64_t kNever = -1'000'000;

constexpr std::array kSourceTimeouts{0.6 * kTimeout, kTimeout, 60.0, 0.0};  // s

/// One source for each sender.
CommandSourceList two_sources(double first_timeout, double second_timeout) {
  return {.sources = {{"a", "a", first_timeout, 20, false}, {"b", "b", second_timeout, 10, false}},
          .locks = {{"pause", "pause", 0, 255}}};
}

/// One connection of a process.
struct Sender {
  std::string name;
  std::string topic = "cmd_vel";
  StatedPart part = StatedPart::kAll;
  std::string uri = "0";  // of its process
  boost::shared_ptr<const void> connection = boost::make_shared<char>();
  std::int64_t suspended_until = 0;
  Message message = Message::kNone;
  bool zero_first = false;            // the next message is a zero, as of a sender that begins a motion properly
  std::int64_t period = 10;           // ticks
  std::int64_t sent = kNever;         // tick of the last message
  Message received = Message::kNone;  // the last one that this controller's inbox took
  std::int64_t received_at = kNever;
  std::int64_t received_cycle = kNever;  // of all driver cycles

  std::int64_t silence = kTimeoutTicks;  // ticks, the shortest since then after which it is forgotten

  std::int64_t motion_at = kNever;  // tick of the last message except an accepted zero, of this process
  bool zero_since = true;           // the last withdrawal of the permission to drive
  bool owes_zero = false;
  bool requested_lately = false;  ///< it owes one only because of `motion_at`, and the controller has not learned yet
  bool left_requesting = false;   // an earlier process, which owed nothing: its command may be in force

  bool has_requested() const { return received != Message::kNone && received != Message::kZero; }

  bool requests_motion(std::int64_t now) const {
    return has_requested() && now - received_at < silence - kJudgesMargin;
  }
};

/// The request of a connection, or of a service, since the last withdrawal. Its numbers occur in no other one.
struct Statement {
  std::string process, topic;
  Request request;
  std::int64_t cycle = 0;  // of all driver cycles
  Mode gait{};             // that was chosen then, since the last withdrawal
};

/// A publisher of e_stop in the judge's model.
struct Button {
  std::string name;
  bool level = false;      // its last level
  bool withdrawn = false;  // another publisher's first message was false since
  bool present = true;
};

class Sequence {
 public:
  Sequence(std::uint64_t seed, ReleaseFigures& figures) : random_(seed), figures_(figures) {}
  virtual ~Sequence() = default;

  std::optional<std::string> run() {
    for (std::size_t node = 0; node < kNodes; ++node) start(static_cast<Node>(node));
    for (now_ = 0; now_ < undisturbed_ + kReleaseCycles * rarity_; ++now_) {
      if (now_ >= undisturbed_) disturb();
      send();
      step();
      if (const std::string violated = violation(); !violated.empty())
        return "tick " + std::to_string(now_) + ": " + violated;
    }
    return std::nullopt;
  }

 protected:
  virtual const MachineModel& model() const = 0;
  virtual Driver& machine() = 0;
  virtual GateParameters gate() const { return {}; }
  virtual std::unique_ptr<EstimatorLaw> make_estimator() const = 0;
  virtual std::unique_ptr<ControllerLaw> make_controller() const = 0;
  virtual std::unique_ptr<MonitorLaw> make_monitor() const = 0;

  /// Returns true if anything but the brake is commanded.
  virtual bool moves() const = 0;

  /// The rules of one kind.
  virtual std::string body_violation() { return {}; }

  /// Changes cmd_vel_timeout as set_parameters does.
  virtual void tune() {}

  /// Makes a message of motion.
  virtual void request_motion(const Sender&, ArrivedCommand& to) { to.twist.linear[0] = 0.5; }

  /// Returns whether a sender sends nothing for a while.
  virtual bool rests(const Sender&) { return false; }

  /// Makes a message that is not finite.
  virtual void spoil(ArrivedCommand& to) { to.twist.linear[0] = std::numeric_limits<double>::quiet_NaN(); }

  /// Calls the services that request something.
  virtual void call() {}

  /// Returns the mode that set_gait chose since the last withdrawal.
  virtual Mode chosen() const { return {}; }

  /// Returns whether the request in force consists of what one process has stated.
  virtual bool owned(const Request&) { return true; }

  bool chance(unsigned one_in) { return random_() % one_in == 0; }

  /// The same of what disturbs the robot.
  bool disturbs(unsigned one_in) { return chance(one_in * static_cast<unsigned>(rarity_)); }
  std::int64_t below(std::int64_t end) {
    return static_cast<std::int64_t>(random_() % static_cast<std::uint64_t>(end));
  }

  void start(Node node) {
    ++figures_.starts;
    take_release_back();
    unseen_[node] = true;
    switch (node) {
      case kDriverNode:
        driver_ = std::make_unique<DriverCycle>(
            machine(), model(),
            DriverCycle::Channels{sensors_.writer, truth_.writer, &command_.reader, &permit_.reader}, kPeriodNs,
            nullptr, gate());
        driver_->set_driver_instance(random_());
        driver_->begin_run(random_() | 1);
        break;
      case kEstimatorNode:
        estimator_ =
            std::make_unique<EstimatorCycle>(make_estimator(), model().hash, sensors_.reader, state_.writer, nullptr);
        break;
      case kControllerNode:
        controller_ = std::make_unique<ControllerCycle>(
            make_controller(), model().hash,
            ControllerCycle::Channels{&sensors_.reader, &state_.reader, &permit_.reader, command_.writer},
            CommandScript(), nullptr);
        inbox_.emplace(timeout_, one_sender_);
        mux_.emplace(two_sources(source_timeouts_[0], source_timeouts_[1]), timeout_, one_sender_);
        start_intake();
        break;
      case kMonitorNode:
        monitor_ = std::make_unique<MonitorCycle>(
            make_monitor(), model().hash, kLossNs,
            MonitorCycle::Channels{&sensors_.reader, &state_.reader, &command_.reader, permit_.writer}, CommandScript(),
            nullptr);
        operator_input_ = {};
        levels_ = {};
        if ((monitor_->permit().active & kCauseEmergencyStopTopic) != 0) levels_.hold();
        operator_input_.e_stop_level = levels_.stopped() ? 1 : 0;
        for (Button& button : buttons_) button.withdrawn = false;
        buttons_heard_.clear();
        last_permit_ = {};
        break;
      case kNodes:
        break;
    }
  }

  /// Acts as the node does. After a connection without a restart, the judge forgets as the node does, at its first
  /// pass.
  void start_intake() {
    EarlierController earlier;
    CommandFrame command;
    if (command_.reader.newest(command) == Lookup::kFrame) {
      earlier.run = command.head.run;
      earlier.requested = requests_motion(command);
    }
    for (Sender& sender : senders_) {
      earlier.present.push_back({sender.name, nullptr, sender.uri, ""});
      reopen(sender);
      sender.motion_at = kNever;  // It owes a zero since this start, and no more for what it sent before.
    }
    intake().start(earlier);
    earlier_run_ = earlier.run;
    earlier_requested_ = earlier.requested;
    has_looked_ = false;
  }

  /// A zero since the last cycle counts after what happens before the next one: the loop cannot tell their order.
  void take_release_back() {
    started_at_ = now_;
    start_cycle_ = cycles_;
    released_ = released_ && released_cycle_ == cycles_;
    withdraw();
  }

  /// Every earlier request loses its effect.
  void withdraw() {
    withdrawn_cycle_ = cycles_;
    service_requests_ = false;
    statements_.clear();
    for (Sender& sender : senders_) {
      sender.zero_since = sender.left_requesting = false;
      sender.requested_lately = !sender.owes_zero && !sender.has_requested() && lately(sender);
      sender.owes_zero |= sender.has_requested() || sender.requested_lately;
    }
  }

  bool lately(const Sender& sender) const { return now_ - sender.motion_at < sender.silence - kJudgesMargin; }

  /// The controller counts T back from the moment at which it learns of a withdrawal; a node may sleep until then.
  void learn(const MotionPermission& permission) {
    const std::uint64_t before = std::exchange(withdrawals_, permission.withdrawals);
    if (permission.withdrawals == before) return;
    for (Sender& sender : senders_) {
      if (std::exchange(sender.requested_lately, false) && !lately(sender)) sender.owes_zero = false;
    }
  }

  /// The robot may drive again: a request during the stop without a later zero has no effect, either.
  void release() {
    for (Sender& sender : senders_) {
      const bool with_release = sender.zero_since && cycles_ - sender.received_cycle <= kWithRelease;
      sender.owes_zero |= sender.has_requested() && !with_release;
      if (sender.owes_zero)
        std::erase_if(statements_, [&](const Statement& one) {
          return one.process == process(sender) && one.topic == sender.topic;
        });
    }
  }

  static std::string process(const Sender& sender) { return sender.name + " " + sender.uri; }

  /// The same process closes its connection and opens another one, or does so to another controller.
  static void reopen(Sender& sender) {
    sender.connection = boost::make_shared<char>();
    sender.received_at = kNever;
  }

  void restart(const Sender& of) {
    const std::string name = of.name, uri = std::to_string(++processes_);
    for (Sender& sender : senders_) {
      if (sender.name != name) continue;
      reopen(sender);
      sender.uri = uri;
      forget(sender);
    }
  }

  static void forget(Sender& sender) {
    sender.left_requesting |= sender.has_requested() && !sender.owes_zero;
    sender.received = Message::kNone;
    sender.motion_at = kNever;
    sender.zero_since = true;
    sender.owes_zero = sender.requested_lately = false;
  }

  void end(Node node) {
    if (node == kDriverNode) driver_.reset();
    if (node == kEstimatorNode) estimator_.reset();
    if (node == kControllerNode) controller_.reset();
    if (node == kMonitorNode) monitor_.reset();
  }

  void disturb() {
    for (std::size_t i = 0; i < kNodes; ++i) {
      const Node node = static_cast<Node>(i);
      if (dead_[i] && now_ >= away_until_[i]) {
        dead_[i] = false;
        start(node);
      }
      if (now_ < away_until_[i]) continue;
      if (disturbs(700)) {
        end(node);
        dead_[i] = true;
        away_until_[i] = now_ + 1 + below(chance(2) ? 4 : 80);
      } else if (disturbs(700)) {
        away_until_[i] = now_ + 1 + below(chance(2) ? 4 : 80);  // stopped, and goes on
      }
    }
    if (driver_ && disturbs(900)) {
      driver_->begin_run(random_() | 1);
      take_release_back();
    }
    pause();
    if (chance(300) && controller_ && !away(kControllerNode)) tune();
    if (controller_ && !away(kControllerNode)) call();
    if (!monitor_ || away(kMonitorNode)) return;
    if (disturbs(500)) {
      ++operator_input_.e_stop_services;
      stop();
    }
    press();
    if (chance(20)) reset();
  }

  /// A zero that is sent in the pause counts after it, because nothing older may move then.
  void pause() {
    if (driver_ && !away(kDriverNode) && now_ > pause_until_ && disturbs(700)) {
      pause_until_ = now_ + 1 + below(chance(2) ? 4 : 80);
      take_release_back();
    }
    if (driver_ && now_ == pause_until_) {
      driver_->count_resume();
      release();
    }
  }

  void stop() {
    if (!stopped_) {
      stop_cycle_ = cycles_;
      withdraw();
    }
    stopped_ = true;
  }

  void set_timeout(double timeout) {
    silence_before_ = silence();
    timeout_ = timeout;
    inbox_->set_timeout(timeout_);
    mux_->set_timeout(timeout_);
    for (Sender& sender : senders_) sender.silence = std::min(sender.silence, silence());
  }

  std::int64_t silence() const { return std::llround(silence_needed(timeout_) / kPeriod); }

  /// The shorter of the present timeout and the one before it, whose frames may still be under way.
  std::int64_t shortest_silence() const { return std::min(silence(), silence_before_); }

  /// Publishers of e_stop: two that come and go, and now and then one that sends a single false.
  void press() {
    for (Button& button : buttons_) {
      if (chance(400)) button.present = !button.present;
      if (button.present && (button.level ? chance(60) : disturbs(400))) publish(button, !button.level);
    }
    if (!chance(100)) return;
    Button once{.name = "/once_" + std::to_string(now_)};
    publish(once, false);
  }

  void publish(Button& button, bool level) {
    button.level = level;
    button.withdrawn = false;
    levels_.receive(button.name, level);
    operator_input_.e_stop_level = levels_.stopped() ? 1 : 0;
    ++operator_input_.e_stop_messages;
    if (level) ++operator_input_.e_stop_triggers;
    if (level) stop();
    const bool first = std::exchange(buttons_heard_[button.name], true) == false;
    if (level || !first) return;
    for (Button& other : buttons_) other.withdrawn |= other.name != button.name;
  }

  void reset() {
    std::vector<std::string> present;
    for (const Button& button : buttons_) {
      if (button.present) present.push_back(button.name);
    }
    levels_.settle(present);
    operator_input_.e_stop_level = levels_.stopped() ? 1 : 0;
    ++operator_input_.resets;
    // The levels that end with this request are decided now, whatever the publishers do until the answer.
    for (Button& button : buttons_) button.level = button.level && (button.present || !button.withdrawn);
    held_ = std::ranges::any_of(buttons_, &Button::level);
  }

  bool away(Node node) const { return dead_[node] || now_ < away_until_[node]; }

  void send() {
    for (Sender& sender : senders_) {
      if (now_ < undisturbed_) {
        const bool begins = now_ >= (sender.part == StatedPart::kPose ? undisturbed_ / 2 : kTimeoutTicks);
        sender.message = sender.name != "/a" ? Message::kNone : begins ? Message::kMotion : Message::kZero;
      } else if (disturbs(150)) {
        constexpr std::array kChoices{Message::kNone,  Message::kNone,     Message::kZero,
                                      Message::kZero,  Message::kMotion,   Message::kNotFinite,
                                      Message::kStale, Message::kAgedZero, Message::kAgedMotion};
        sender.message = kChoices[random_() % kChoices.size()];
        if (chance(3)) sender.message = Message::kMotion;
        if (rests(sender)) sender.message = Message::kNone;
        sender.zero_first = chance(2);
        sender.period = 1 + below(kTimeoutTicks - 2 * kJudgesMargin);
      }
      if (disturbs(300)) sender.suspended_until = now_ + below(4 * ticks_);
      if (disturbs(400)) restart(sender);
      if (disturbs(400)) reopen(sender);
      if (now_ < sender.suspended_until) continue;
      if (sender.message == Message::kNone || now_ - sender.sent < sender.period) continue;
      sender.sent = now_;
      last_sent_ = now_;
      if (!controller_) continue;  // lost
      // A stopped process receives the newest message of each sender when it goes on.
      waiting_[static_cast<std::size_t>(&sender - senders_.data())] = true;
    }
    if (!controller_) waiting_ = {};
    if (away(kControllerNode)) return;
    for (std::size_t i = 0; i < senders_.size(); ++i) {
      if (std::exchange(waiting_[i], false)) receive(senders_[i]);
    }
    follow_permission();
    if (with_list_ && chance(200)) mux_->receive_lock(0, chance(3), loop_ns());
    intake().update(loop_ns());
    controller_->inbox().store(intake().value());
  }

  /// Acts as the node does, before each message and at each of its ticks.
  void follow_permission() {
    Permit permit;
    if (permit_.reader.newest(permit) != Lookup::kFrame) return;
    if (!current(sensors_.reader, permit.head, model().hash)) return;
    const MotionPermission permission = motion_permission(permit);
    if (!std::exchange(has_looked_, true) && !permission.stopped && permission.run != earlier_run_ &&
        !earlier_requested_) {
      for (Sender& sender : senders_) forget(sender);
    }
    intake().follow(permission, loop_ns());
    learn(permission);
  }

  void receive(Sender& sender) {
    follow_permission();
    ArrivedCommand arrived{.sender = {sender.name, sender.connection, sender.uri, sender.topic},
                           .twist = {},
                           .stamp_ns = 0,
                           .part = sender.part};
    const Message message = std::exchange(sender.zero_first, false) ? Message::kZero : sender.message;
    if (message == Message::kMotion || message == Message::kAgedMotion) request_motion(sender, arrived);
    if (message == Message::kNotFinite) spoil(arrived);
    if (message == Message::kStale) arrived.stamp_ns = 1;
    // The clock of the senders' stamps jumps at random.
    const ArrivalTime time{.ros_ns = 1'000'000'000'000 + below(2'000'000'000), .loop_ns = loop_ns()};
    const bool aged = message == Message::kAgedZero || message == Message::kAgedMotion;
    if (aged) arrived.stamp_ns = time.ros_ns - below(150'000'000) + (chance(5) ? 120'000'000 : 0);
    const std::uint64_t refused = intake().value().stale, accepted = intake().value().count;
    const Request stated{
        .twist = arrived.twist, .posture = arrived.posture, .mode = arrived.mode, .joints = arrived.joints};
    if (with_list_) {
      mux_->receive(static_cast<std::size_t>(&sender - senders_.data()), arrived, time);
    } else {
      inbox_->receive(arrived, time);
    }
    if (intake().value().count != accepted)
      statements_.push_back({process(sender), sender.topic, stated, cycles_, chosen()});
    const bool accepted_zero =
        parts_of(stated) == 0 && intake().value().stale == refused;  // without a timeout none is old
    sender.received = accepted_zero ? Message::kZero : Message::kMotion;
    if (accepted_zero) {
      sender.zero_since = true;
      sender.owes_zero = sender.requested_lately = false;
    } else {
      sender.motion_at = now_;
    }
    sender.received_at = now_;
    sender.silence = shortest_silence();
    sender.received_cycle = cycles_;
    const bool alone = std::ranges::none_of(
        senders_, [&](const Sender& other) { return &other != &sender && other.requests_motion(now_); });
    if (sender.received != Message::kZero || !alone) return;
    released_ = true;
    released_cycle_ = cycles_;
  }

  CommandIntake& intake() {
    if (with_list_) return *mux_;
    return *inbox_;
  }

  std::int64_t loop_ns() const { return cycles_ * kPeriodNs; }

  void step() {
    ticked_ = driver_ && !away(kDriverNode) && now_ >= pause_until_;
    if (driver_ && now_ < pause_until_ && !away(kDriverNode)) driver_->publish_paused();
    if (ticked_) {
      driver_->step();
      ++cycles_;
    }
    if (estimator_ && !away(kEstimatorNode) && estimator_->step()) note_frame(kEstimatorNode, state_);
    if (controller_ && !away(kControllerNode) && controller_->step()) note_frame(kControllerNode, command_);
    if (!monitor_ || away(kMonitorNode)) return;
    monitor_->inbox().store(operator_input_);
    if (!monitor_->step() && !ticked_) monitor_->idle();  // as its waits end, or its ordinary thread polls
    Permit permit;
    if (permit_.reader.newest(permit) != Lookup::kFrame || permit.head.run != monitor_->published_run()) return;
    accepted_ = permit.resets_handled != last_permit_.resets_handled && permit.reset_refusal == 0 &&
                last_permit_.causes != 0 && permit.causes == 0;
    last_permit_ = permit;
  }

  /// The monitor uses frames of the newest cycle alone (safety/latch/motion_release.h) and learns of a start from the
  /// first one. A node whose frames all come later is lost within loss_cycles.
  template <class Frame>
  void note_frame(Node node, TestChannel<Frame>& channel) {
    Frame published;
    SensorFrame sensors;
    if (channel.reader.newest(published) != Lookup::kFrame || sensors_.reader.newest(sensors) != Lookup::kFrame) return;
    if (published.head.cycle != sensors.head.cycle) return;
    if (std::exchange(unseen_[node], false)) start_cycle_ = withdrawn_cycle_ = cycles_;
  }

  std::string violation() {
    if (!released_ && now_ - std::max(started_at_, last_sent_) >= shortest_silence() - kJudgesMargin) {
      released_ = true;
      if (last_permit_.causes == 0) release();  // else the accepted reset grants it
    }
    if (std::exchange(accepted_, false)) {
      ++figures_.accepted_resets;
      release();
      stopped_ = false;
      if (held_) return "a reset was accepted while a publisher's last word on e_stop was true";
      for (const Sender& sender : senders_) {
        if (sender.requests_motion(now_) && cycles_ - sender.received_cycle >= kInTransit)
          return "a reset was accepted while a motion was requested";
      }
    }
    if (std::string violated = body_violation(); !violated.empty()) return violated;
    if (!ticked_ || !moves()) return {};
    ++figures_.moving_cycles;
    if (!released_ && cycles_ - start_cycle_ > kBrakesWithin) return "motion before a zero request";
    if (stopped_ && cycles_ - stop_cycle_ > kBrakesWithin) return "motion after an emergency stop";
    const bool requested = service_requests_ || std::ranges::any_of(senders_, [](const Sender& sender) {
                             return sender.left_requesting || (sender.has_requested() && !sender.owes_zero);
                           });
    CommandFrame command;  // the request in force; a ramp to zero may outlast it
    const bool in_force = command_.reader.newest(command) == Lookup::kFrame && parts_of(command.requested) != 0;
    if (!in_force || (requested && owned(command.requested))) requested_cycle_ = cycles_;
    if (cycles_ - std::max(requested_cycle_, withdrawn_cycle_) > kBrakesWithin)
      return "motion that was requested before a withdrawal, or by no sender";
    return {};
  }

  std::mt19937_64 random_;
  ReleaseFigures& figures_;
  double timeout_ = kTimeout;  ///< s
  bool one_sender_ = false;
  std::int64_t undisturbed_ = 0;  ///< ticks at the beginning, in which one sender requests motion
  std::int64_t rarity_ = 1;       ///< a disturbance comes so many times less often, in so many times more ticks
  TestChannel<SensorFrame> sensors_;
  TestChannel<TruthFrame> truth_;
  TestChannel<StateFrame> state_;
  TestChannel<CommandFrame> command_;
  TestChannel<Permit> permit_;
  std::unique_ptr<DriverCycle> driver_;
  std::unique_ptr<EstimatorCycle> estimator_;
  std::unique_ptr<ControllerCycle> controller_;
  std::unique_ptr<MonitorCycle> monitor_;
  bool with_list_ = false;
  std::array<double, 2> source_timeouts_{};
  std::optional<CommandInput> inbox_;
  std::optional<CommandMux> mux_;   ///< instead, with a list of sources
  std::uint64_t earlier_run_ = 0;   ///< of the last command before this controller
  bool earlier_requested_ = false;  ///< motion was requested at that command
  bool has_looked_ = false;         ///< this controller, at a permit
  std::uint64_t withdrawals_ = 0;   ///< that this controller has learned of
  int processes_ = 0;               ///< of senders
  OperatorInput operator_input_;
  EStopLevels levels_;
  std::array<Button, 2> buttons_{Button{.name = "/panel"}, Button{.name = "/gate"}};
  std::map<std::string, bool> buttons_heard_;
  bool held_ = false;  ///< at the last reset request a level was not to end
  std::int64_t silence_before_ = kTimeoutTicks;
  std::vector<Sender> senders_{Sender{.name = "/a"}, Sender{.name = "/b"}};
  std::array<bool, 4> waiting_{};
  std::vector<Statement> statements_;
  bool service_requests_ = false;       ///< a service has requested something since the last withdrawal
  std::int64_t ticks_ = kTimeoutTicks;  ///< of the timeout at first
  std::array<bool, kNodes> dead_{};
  std::array<bool, kNodes> unseen_{};  ///< no frame that the monitor can use since its start
  std::array<std::int64_t, kNodes> away_until_{};
  std::int64_t now_ = 0;
  std::int64_t started_at_ = 0;
  std::int64_t last_sent_ = kNever;
  bool ticked_ = false;
  bool released_ = false;    ///< motion was released since the last start
  bool stopped_ = false;     ///< an emergency stop was requested since the last accepted reset
  bool accepted_ = false;    ///< a reset was accepted in this tick
  Permit last_permit_;       ///< of this monitor
  std::int64_t cycles_ = 0;  ///< that the driver has ticked, in all runs
  std::int64_t start_cycle_ = 0;
  std::int64_t released_cycle_ = kNever;  ///< of the last zero that released motion
  std::int64_t stop_cycle_ = 0;
  std::int64_t withdrawn_cycle_ = 0;
  std::int64_t requested_cycle_ =
      0;  ///< cycle in which a sender that owed nothing requested motion, or none was in force
  std::int64_t pause_until_ = kNever;  ///< tick
};

class WheeledSequence final : public Sequence {
 public:
  WheeledSequence(std::uint64_t seed, ReleaseFigures& figures, WheelCommand drives) : Sequence(seed, figures) {
    robot_.wheel_command = drives;
    if (drives == WheelCommand::kVelocity) machine_.measured = monitored_.joint_numbers = kValidKinematics;
    parameters_.cmd_vel_timeout = timeout_;
    one_sender_ = chance(3);
    with_list_ = chance(3);
    for (double& timeout : source_timeouts_) timeout = kSourceTimeouts[random_() % kSourceTimeouts.size()];
  }

 private:
  const MachineModel& model() const override { return robot_; }
  Driver& machine() override { return machine_; }
  std::unique_ptr<EstimatorLaw> make_estimator() const override {
    return std::make_unique<EstimatorOf<Estimator>>(EstimatorParameters{}, robot_, kPeriod);
  }
  std::unique_ptr<ControllerLaw> make_controller() const override {
    return std::make_unique<ControllerOf<DriveController>>(parameters_, robot_, kPeriod);
  }
  std::unique_ptr<MonitorLaw> make_monitor() const override {
    return std::make_unique<MonitorOf<SafetyMonitor>>(monitored_, robot_, kPeriod);
  }
  bool moves() const override { return machine_.mode != JointMode::kBrake; }

  void tune() override {
    parameters_.cmd_vel_timeout = kTimeouts[random_() % kTimeouts.size()];
    set_timeout(parameters_.cmd_vel_timeout);
    DriveTuning tuning = drive_tuning(parameters_, robot_, kPeriod);
    tuning.count = ++tunings_;
    controller_->tunings().store(tuning_of(tuning));
  }

  DriveTrain robot_ = two_wheels();
  DriveControllerParameters parameters_;
  StandingMachine machine_;
  SafetyParameters monitored_;
  std::uint64_t tunings_ = 0;
};

/// Quadbot, simulated, with all conditions of its monitor. It stands up and walks before it is disturbed.
class LeggedSequence final : public Sequence {
 public:
  LeggedSequence(std::uint64_t seed, ReleaseFigures& figures) : Sequence(seed, figures), parameters_(of_quadbot(seed)) {
    one_sender_ = chance(3);
    undisturbed_ = 4000;
    rarity_ = 4;
    timeout_ = parameters_.leg_control.request_timeout;
    silence_before_ = ticks_ = silence();
    senders_[0].part = StatedPart::kTwist;
    senders_[1].topic = "all parts";
    senders_.push_back({.name = "/a", .topic = "body_pose", .part = StatedPart::kPose});
    senders_.push_back({.name = "/c", .topic = "body_pose", .part = StatedPart::kPose});
    for (Sender& sender : senders_) sender.silence = ticks_;
    machine_.start();
  }

 private:
  static Parameters of_quadbot(std::uint64_t seed) {
    Parameters parameters = read_parameters(PROJECT_DIRECTORY "/config/robot_params.yaml");
    parameters.urdf = PROJECT_DIRECTORY "/urdf/quadbot.urdf";
    parameters.robot = {};
    parameters.leg_control.request_timeout = kLegTimeouts[seed % kLegTimeouts.size()];
    parameters.plant.seed = seed;
    return parameters;
  }

  static constexpr int kRests = 1500;       // driver cycles after which a stopped robot lies (docs/legs.md)
  static constexpr double kStands = 0.1;    // m, of the body above where it lay
  static constexpr double kHeight = 0.02;   // m, of a body that lies
  static constexpr double kUpright = 0.15;  // rad
  static constexpr double kMoved = 0.003;   // m, from then on: 0.01 m/s for the 0.3 s of bench/faults/sequence_judge.py

  const MachineModel& model() const override { return robot_.machine(); }
  Driver& machine() override { return machine_; }
  GateParameters gate() const override { return robot_.gate(); }
  std::unique_ptr<EstimatorLaw> make_estimator() const override { return robot_.make_estimator(); }
  std::unique_ptr<ControllerLaw> make_controller() const override { return robot_.make_controller(); }
  std::unique_ptr<MonitorLaw> make_monitor() const override { return robot_.make_monitor(); }
  bool moves() const override { return driver_->trace().gate.verdict != GateVerdict::kBrake; }

  void request_motion(const Sender& sender, ArrivedCommand& to) override {
    const double number = 1e-9 * static_cast<double>(++asked_);  // no two requests are the same
    const std::uint64_t kind = now_ < undisturbed_ ? 0 : random_() % 6;
    if (sender.part == StatedPart::kPose) {
      to.posture = {.height = -0.02, .roll = 0.1 + number};
    } else if (sender.part == StatedPart::kTwist || kind < 2) {
      to.twist.linear[0] = 0.3 + number;
      if (sender.part == StatedPart::kAll)
        to.mode = random_() % 2 == 0 ? Mode{} : Mode{ModeKind::kGait, 1 + random_() % 3};
    } else if (kind == 2) {
      to.posture = {.height = -0.02, .pitch = 0.1 + number};
    } else if (kind == 3) {
      to.posture = {.height = 0.08 + number};
      to.mode = {ModeKind::kLift, random_() % kLegs};
    } else {
      to.joints.fill(0.1 + number);
      to.mode = {ModeKind::kJoints};
    }
  }

  /// Three processes that request something all the time would never be released.
  bool rests(const Sender& sender) override { return sender.name != "/a" && !chance(3); }

  void spoil(ArrivedCommand& to) override {
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    (to.part == StatedPart::kTwist ? to.twist.linear[0] : to.posture.yaw) = kNaN;
  }

  /// Acts as the node's set_posture and set_gait.
  void call() override {
    Permit permit;
    CommandFrame command;
    const bool granted = permit_.reader.newest(permit) == Lookup::kFrame && permit.action == PermitAction::kDrive &&
                         current(sensors_.reader, permit.head, model().hash) &&
                         command_.reader.newest(command) == Lookup::kFrame;
    if (granted && chance(400)) {
      chosen_ = {{ModeKind::kGait, 1 + random_() % 3}, cycles_};
      inbox_->choose_mode(chosen_.first);
    }
    if (posture_ == Mode{} && granted && disturbs(200)) {
      posture_.kind = chance(2) ? ModeKind::kStand : ModeKind::kLie;
      called_at_ = now_;
    }
    if (posture_ == Mode{} || (now_ - called_at_) % 10 != 0) return;
    const LegPhase phase = command.legged.phase;
    const bool begun = posture_.kind == ModeKind::kLie ? phase == LegPhase::kLying || phase == LegPhase::kLowering
                                                       : phase > LegPhase::kLying && phase < LegPhase::kLowering;
    if (granted && !begun && now_ - called_at_ < 1000) {
      follow_permission();
      const std::uint64_t accepted = inbox_->value().count;
      inbox_->receive_once({.twist = {}, .posture = {}, .mode = posture_}, {.ros_ns = 0, .loop_ns = loop_ns()});
      if (inbox_->value().count != accepted) statements_.push_back({"service", "", inbox_->value().content, cycles_});
      service_requests_ |= released_ && !stopped_;
      return;
    }
    if (granted && !begun) inbox_->withdraw(posture_, loop_ns());
    posture_ = {};
  }

  Mode chosen() const override { return chosen_.second >= withdrawn_cycle_ ? chosen_.first : Mode{}; }

  bool owned(const Request& request) override {
    const Statement* twist = nullptr;
    const Statement* rest = nullptr;
    const bool walks = !zero(request.twist);
    const auto is = [](const Posture& a, const Posture& b) {
      return a.height == b.height && a.roll == b.roll && a.pitch == b.pitch;
    };
    const bool has_rest = !is(request.posture, {}) || (request.mode != Mode{} && !walks);
    for (const Statement& one : statements_) {
      if (one.cycle < withdrawn_cycle_ || (timeout_ > 0 && cycles_ - one.cycle > 2 * ticks_ + kMaxAway)) continue;
      if (walks && one.request.twist.linear == request.twist.linear) twist = &one;
      const bool same_mode = one.request.mode == request.mode && one.request.joints == request.joints;
      if (has_rest && is(one.request.posture, request.posture) && (walks || same_mode)) rest = &one;
    }
    if (walks && twist == nullptr) return false;
    if (walks && request.mode != twist->request.mode && request.mode != twist->gait) return false;
    return !has_rest || (rest != nullptr && (!walks || rest->process == twist->process));
  }

  std::string body_violation() override {
    TruthFrame truth;
    if (!ticked_ || truth_.reader.newest(truth) != Lookup::kFrame) return {};
    const double height = truth.pose_world.position[2];
    lay_at_ = std::min(lay_at_, height);
    if (height > lay_at_ + kStands) ++figures_.standing_cycles;
    braked_ = moves() || std::exchange(run_, truth.head.run) != truth.head.run ? 0 : braked_ + 1;
    if (braked_ < kRests) return {};
    ++figures_.lying_cycles;
    const Quaternion& q = truth.pose_world.orientation;
    const Vector3& place = truth.pose_world.position;
    if (braked_ == kRests) rests_at_ = place;
    const double tilt = 2 * std::hypot(q[0], q[1]);
    const double moved = std::hypot(place[0] - rests_at_[0], place[1] - rests_at_[1], place[2] - rests_at_[2]);
    if (height <= lay_at_ + kHeight && tilt <= kUpright && moved <= kMoved) return {};
    return "a robot that has been stopped for " + std::to_string(braked_) + " cycles is " +
           std::to_string(height - lay_at_) + " m above where it lay, tilted by " + std::to_string(tilt) +
           " rad, and moved by " + std::to_string(moved) + " m since it had to rest";
  }

  Parameters parameters_;
  Quadruped robot_{parameters_, read_legs(load_description(parameters_.urdf), {}, {})};
  MujocoPlant machine_{robot_.machine(), parameters_.plant, kPeriod};
  static constexpr std::int64_t kMaxAway = 100;  ///< ticks, more than a node is stopped
  std::uint64_t asked_ = 0;
  std::pair<Mode, std::int64_t> chosen_{{}, kNever};  ///< mode of the last set_gait, and its driver cycle
  Mode posture_;                                      ///< mode of the set_posture that is being answered
  std::int64_t called_at_ = 0;                        ///< tick
  double lay_at_ = 1;                                 ///< m, the lowest height of the body
  std::uint64_t run_ = 0;
  Vector3 rests_at_{};  ///< m, the place of the body
  int braked_ = 0;      ///< driver cycles of this run; another one begins the stop again
};

}  // namespace

std::optional<std::string> release_violation(std::uint64_t seed, ReleaseFigures& figures, WheelCommand drives) {
  return WheeledSequence(seed, figures, drives).run();
}

std::optional<std::string> walking_release_violation(std::uint64_t seed, ReleaseFigures& figures) {
  return LeggedSequence(seed, figures).run();
}

}  // namespace robot_control

#pragma once
/// CommandInput checks messages of `cmd_vel` and `cmd_vel_stamped`, passes them to the controller's inbox and reports
/// about them. It is pure.
///
/// A message passes these checks:
///   1. its stamp (judge_stamp): a message that is too old or in the future is refused. The last command stays in
///      force until its timeout, and the sender of the refused message does not count as a sender;
///   2. its sender: with `one_sender`, two or more senders within cmd_vel_timeout, but at least
///      within kSenderWindow, exclude each other while one of them requests motion: all their messages are refused. The
///      robot ramps to rest until one sender is left, or none requests motion. Without `one_sender` each message
///      overrides the previous one, and that is reported;
///   3. its numbers: NaN and infinity are refused. What this message would have replaced ends if it is its sender's, a
///      pose beside a twist alone; the command of another sender stays in force;
///   4. its connection (motion_requests.h): motion is refused while the connection is revoked.
///
/// The command in force has one sender, one time and one end. Twist and pose of one process are parts of it. A twist
/// keeps the pose that the same process sent within the timeout, and a pose its twist. The age of the command is that
/// of its oldest part which is not zero. While a twist is in force, a pose of another process is refused
/// (VelocityCommand::crowded). Every other message replaces the whole.
///
/// A zero velocity is contested (VelocityCommand::contested) if another connection has requested motion within
/// cmd_vel_timeout (1 s if that is 0). It is executed, but does not count as evidence (safety/latch/motion_release.h).
/// The command in force ends when the permission to move is withdrawn. Until permission is granted again, it also ends
/// when no connection requests motion any more, whatever its timeout.
///
/// One warning is reported per sender with wrong stamps, per revoked sender and per set of competing senders. A warning
/// is repeated after kRepeatAfter at the earliest, in the loop's time.

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "ros/inputs/command_intake.h"
#include "ros/inputs/motion_requests.h"
#include "ros/reports/report_line.h"
#include "signals/velocity_command.h"

namespace robot_control {

/// ns, the largest accepted difference of two clocks. It is far above that of machines synchronised by NTP (RFC 5905,
/// abstract: down to tens of microseconds). It is far below any usual cmd_vel_timeout. So only clocks that are not
/// synchronised are reported.
inline constexpr std::int64_t kClockSkew = 100'000'000;

enum class StampVerdict { kUsable, kTooOld, kFuture };

/// The stamp of a command is checked once, when the command arrives.
///
///   age = arrival − stamp   both on the sender's clock, the time of day or /clock; a stamp of 0 is none: age 0
///
/// A command is usable if −kClockSkew ≤ age ≤ timeout. An age below zero counts as zero, so that no command outlives
/// the timeout. An older command timed out in transport. A stamp in the future means that the two clocks differ and the
/// age is not known. With timeout 0 stamps are not checked, and no command is too old.
struct JudgedStamp {
  StampVerdict verdict = StampVerdict::kUsable;
  std::int64_t age_ns = 0;  ///< ≥ 0 if usable, else as measured
};

constexpr JudgedStamp judge_stamp(std::int64_t stamp_ns, std::int64_t arrival_ns, std::int64_t timeout_ns) noexcept {
  if (stamp_ns == 0 || timeout_ns <= 0) return {};
  const std::int64_t age_ns = arrival_ns - stamp_ns;
  if (age_ns > timeout_ns) return {StampVerdict::kTooOld, age_ns};
  if (age_ns < -kClockSkew) return {StampVerdict::kFuture, age_ns};
  return {StampVerdict::kUsable, std::max<std::int64_t>(0, age_ns)};
}

/// s, the default of cmd_vel_timeout. A shorter timeout may be below the senders' periods, so that two of them would
/// never be counted at the same time.
inline constexpr double kSenderWindow = 1.25;
inline constexpr std::int64_t kRepeatAfter = 10'000'000'000;  ///< ns

/// The part of a request that a message states.
enum class StatedPart { kAll, kTwist, kPose };

struct ArrivedCommand {
  Publisher sender;
  Twist twist;
  std::int64_t stamp_ns = 0;                    ///< 0 if the message has none
  Posture posture{};                            ///< of robots on legs
  Mode mode{};                                  ///< likewise
  std::array<double, kRequestJoints> joints{};  ///< likewise
  StatedPart part = StatedPart::kAll;
};

/// The time at which a message arrived, on two clocks.
struct ArrivalTime {
  std::int64_t ros_ns = 0;   ///< on the clock that senders use for stamps
  std::int64_t loop_ns = 0;  ///< stamp of the newest sensor frame; 0 before the first
};

class CommandInput final : public CommandIntake {
 public:
  /// `timeout` is the value of `parameter` in s; 0 means that commands never time out.
  CommandInput(double timeout, bool one_sender, std::string parameter = "cmd_vel_timeout");

  /// Sets the timeout in s for the next message and all later ones.
  void set_timeout(double timeout) override;

  /// Sets for how many seconds (> 0) a sender's last message requests motion, if that is not `timeout`.
  void set_silence(double silence);

  void receive(const ArrivedCommand& arrived, const ArrivalTime& time);

  /// Receives a request of no sender, which ends by itself or with the permission to move: a service was called. It has
  /// no effect without that permission.
  void receive_once(const Request& request, const ArrivalTime& time);

  /// Sets the mode of later messages that state a twist, until the permission to move ends.
  void choose_mode(const Mode& mode) { mode_ = mode; }
  const Mode& chosen_mode() const { return mode_; }

  /// Ends the request in force, if it has this mode.
  void withdraw(const Mode& mode, std::int64_t loop_ns);

  void start(const EarlierController& earlier) override {
    unread_ns_ = unread_ns(earlier.period_ns);
    requests_.start(earlier);
  }

  /// Removes senders that have become silent. Returns true if that changed the value of the inbox.
  bool update(std::int64_t loop_ns) override;

  const VelocityCommand& value() const noexcept override { return value_; }
  std::vector<ReportLine> lines() override;
  std::vector<std::string> senders(std::int64_t loop_ns) override;

  bool follow(const MotionPermission& permission, std::int64_t loop_ns) override;

  std::vector<std::string> revoked() const override { return requests_.revoked_names(); }

  /// Returns whether any connection requests motion.
  bool motion_requested(std::int64_t loop_ns) const { return requests_.any(loop_ns); }

 private:
  void accept(const ArrivedCommand& arrived, Request content, std::int64_t age_ns, const ArrivalTime& time);
  void set_command(const Request& content, const Publisher& sender, std::uint64_t contested, const ArrivalTime& time,
                   std::int64_t age_ns = 0);
  void end_pose(const ArrivalTime& time);
  bool in_time(std::int64_t since_ns, const ArrivalTime& time) const;
  void end_command(std::int64_t loop_ns);
  void warn(std::string text, std::int64_t loop_ns);
  void refuse_stamp(const Publisher& from, const JudgedStamp& stamp, std::int64_t loop_ns);
  void report_senders(std::int64_t loop_ns);
  bool may_report(const std::string& what, std::int64_t loop_ns);

  bool one_sender_;
  std::string parameter_;
  double timeout_ = 0;  ///< s
  std::int64_t timeout_ns_ = 0;
  MotionRequests requests_;
  VelocityCommand value_;
  std::int64_t command_ns_ = 0;          ///< when the command in force arrived
  Publisher sender_;                     ///< of the command in force, without its connection; empty: it has none
  std::int64_t twist_ns_ = 0;            ///< when its twist was stamped, or arrived
  std::optional<std::int64_t> pose_ns_;  ///< the same of its posture, if that is a pose other than zero
  Mode mode_;                            ///< of later twists
  std::int64_t unread_ns_ = unread_ns(0);
  std::map<std::string, StampVerdict> reported_stamps_;  ///< last reported verdict of each sender with wrong stamps
  std::map<std::string, std::int64_t>
      reported_ns_;  ///< time of each report, by sender and verdict or by the competing senders' names
  std::vector<std::string> reported_senders_;  ///< last reported competing senders; empty: one sender, or none
  std::vector<ReportLine> lines_;
};

}  // namespace robot_control

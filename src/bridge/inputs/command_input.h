#pragma once
/// Messages on `cmd_vel` and `cmd_vel_stamped` → the controller's inbox, and the reports about them. Pure.
///
/// A message passes these checks:
///   1. its stamp (command_stamp.h): refused if it is too old or in the future. The last command stays in force until
///      its timeout, and the sender of the refused message does not count as a sender;
///   2. its sender (command_senders.h): with `one_sender`, while messages of two or more senders arrived within
///      cmd_vel_timeout, but no less than kSenderWindow, the messages of all of them are refused, and the robot ramps
///      to rest until one sender is left. Without it each message overrides the one before, and that is reported;
///   3. its connection (motion_requests.h): motion is refused while the connection is revoked;
///   4. NaN and infinity are refused by the controller (control/command_watch.h).
///
/// A zero velocity that arrives while another connection requests motion, by a message within cmd_vel_timeout (1 s if
/// that is 0), is contested (VelocityCommand::contested): it is executed, but is no evidence
/// (safety/latch/motion_release.h). When the permission to move is withdrawn, the command in force ends; until it is
/// granted again, it ends as well when no connection requests motion any more, whatever its timeout.
///
/// Reports: one warning per sender with wrong stamps, one per revoked sender, one per set of competing senders;
/// repeated after kRepeatAfter at the earliest, in the loop's time.

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "bridge/inputs/command_intake.h"
#include "bridge/inputs/command_senders.h"
#include "bridge/inputs/command_stamp.h"
#include "bridge/inputs/motion_requests.h"
#include "bridge/reports/command_report.h"
#include "signals/velocity_command.h"

namespace robot_control {

/// s; the default of cmd_vel_timeout. A shorter timeout may lie below the senders' periods, and would then show no two
/// of them at once.
inline constexpr double kSenderWindow = 1.25;
inline constexpr std::int64_t kRepeatAfter = 10'000'000'000;  ///< ns

struct ArrivedCommand {
  Publisher sender;
  Twist twist;
  std::int64_t stamp_ns = 0;  ///< 0: none
};

/// When a message arrived.
struct ArrivalTime {
  std::int64_t ros_ns = 0;   ///< on the clock that senders stamp with
  std::int64_t loop_ns = 0;  ///< stamp of the newest sensor frame; 0 before the first
};

class CommandInput final : public CommandIntake {
 public:
  /// `timeout`: cmd_vel_timeout, s; 0: never.
  CommandInput(double timeout, bool one_sender);

  /// Another timeout, s, from the next message on.
  void set_timeout(double timeout) override;

  /// Seconds for which a sender's last message requests motion, > 0, where that is not `timeout`.
  void set_silence(double silence);

  void receive(const ArrivedCommand& arrived, const ArrivalTime& time);

  void start(const EarlierController& earlier) override { requests_.start(earlier); }

  /// If nothing arrived: removes senders that have become silent. True if that changed the value of the inbox.
  bool look(std::int64_t loop_ns) override;

  const VelocityCommand& value() const noexcept override { return value_; }
  std::vector<ReportLine> lines() override;
  std::vector<std::string> senders(std::int64_t loop_ns) override { return senders_.at(loop_ns); }

  bool follow(const MotionPermission& permission, std::int64_t loop_ns) override;

  std::vector<std::string> revoked() const override { return requests_.revoked_names(); }

  /// A connection requests motion, as above.
  bool motion_requested(std::int64_t loop_ns) const { return requests_.any(loop_ns); }

 private:
  void end_command();
  void refuse_revoked(const std::string& sender, std::int64_t loop_ns);
  void refuse_stamp(const std::string& sender, const JudgedStamp& stamp, std::int64_t loop_ns);
  void report_senders(std::int64_t loop_ns);
  bool may_report(const std::string& what, std::int64_t loop_ns);

  bool one_sender_;
  double timeout_ = 0;  ///< s
  std::int64_t timeout_ns_ = 0;
  CommandSenders senders_;
  MotionRequests requests_;
  VelocityCommand value_;
  std::map<std::string, StampVerdict> reported_stamps_;  ///< of senders with wrong stamps, as last reported
  std::map<std::string, std::int64_t> reported_ns_;      ///< by sender and verdict, or by the names of a crowd
  std::vector<std::string> reported_senders_;            ///< as last reported; empty: one sender, or none
  std::vector<ReportLine> lines_;
};

}  // namespace robot_control

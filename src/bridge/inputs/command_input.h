#pragma once
/// Messages on `cmd_vel` and `cmd_vel_stamped` → the controller's inbox, and what is to be told about them. Pure.
///
/// A message passes in this order:
///   1. its stamp (command_stamp.h): refused where it is too old or of the future; the command before it stands, as
///      long as it lives, and whoever sent it is no sender;
///   2. its sender (command_senders.h): with `one_sender`, while two or more were heard within cmd_vel_timeout, but no
///      less than kSenderWindow, messages of all of them are refused, and the robot ramps to rest until one is left.
///      Without, each message overrides the one before, and that is told;
///   3. NaN and infinity are the controller's to refuse (control/command_watch.h).
///
/// A sender requests motion from a message that is refused or not of zero velocity until its next accepted zero
/// velocity, or for cmd_vel_timeout (1 s where that is 0). A zero velocity that arrives while another sender requests
/// motion is contested (VelocityCommand::contested): it is obeyed, and proves nothing (safety/latch/motion_release.h).
///
/// Told: one warning per sender whose stamps are wrong, one per crowd and newcomer; again after kToldAgain at the
/// earliest, in the loop's time.

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "bridge/inputs/command_senders.h"
#include "bridge/inputs/command_stamp.h"
#include "bridge/reports/command_report.h"
#include "signals/velocity_command.h"

namespace robot_control {

/// s; the default of cmd_vel_timeout. A shorter timeout may lie below the senders' periods, and would then show no two
/// of them at once.
inline constexpr double kSenderWindow = 1.25;
inline constexpr std::int64_t kToldAgain = 10'000'000'000;  ///< ns

struct ArrivedCommand {
  std::string sender;  ///< the publisher's node
  Twist twist;
  std::int64_t stamp_ns = 0;  ///< 0: none
};

/// When a message arrived.
struct ArrivalTime {
  std::int64_t ros_ns = 0;   ///< on the clock that senders stamp with
  std::int64_t loop_ns = 0;  ///< stamp of the newest sensor frame; 0 before the first
};

class CommandInput {
 public:
  /// `timeout`: cmd_vel_timeout, s; 0: never.
  CommandInput(double timeout, bool one_sender);

  /// Another timeout, s, from the next message on.
  void limit(double timeout);

  void hear(const ArrivedCommand& arrived, const ArrivalTime& time);

  /// When nothing arrived: who fell silent is no sender any more. True where that changed what the inbox shall hold.
  bool look(std::int64_t loop_ns);

  /// What the inbox shall hold.
  const VelocityCommand& value() const noexcept { return value_; }

  /// What is new to tell since the last call.
  std::vector<ReportLine> lines();

  /// Sorted by name.
  std::vector<std::string> senders(std::int64_t loop_ns) { return senders_.at(loop_ns); }

 private:
  void refuse_stamp(const std::string& sender, const JudgedStamp& stamp, std::int64_t loop_ns);
  void tell_crowd(std::int64_t loop_ns);
  bool may_tell(const std::string& what, std::int64_t loop_ns);

  bool one_sender_;
  double timeout_ = 0;  ///< s
  std::int64_t timeout_ns_ = 0;
  CommandSenders senders_;
  CommandSenders moving_;  ///< those that request motion
  VelocityCommand value_;
  std::map<std::string, StampVerdict> told_wrong_;  ///< of senders whose stamps are wrong, as last told
  std::map<std::string, std::int64_t> told_ns_;     ///< by sender and verdict, or by the names of a crowd
  std::vector<std::string> crowd_;                  ///< as last told; empty: one sender, or none
  std::vector<ReportLine> lines_;
};

}  // namespace robot_control

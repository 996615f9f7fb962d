#pragma once
/// Which connections request motion, and whose requests are revoked. Pure.
///
/// A connection requests motion from a message that is refused or not of zero velocity until its next accepted zero
/// velocity. A latched stop, a start of a node and the end of a pause are withdrawals of the permission to move
/// (Permit::withdrawals).
/// A connection is revoked
///   - by a withdrawal, if it requests motion then or did so within `window` before;
///   - when permission is granted again, if it requests motion then: such a request was made during the stop. A request
///     that follows a zero velocity and is no older than kInTransit was made with the grant;
///   - from the beginning, if this controller was restarted and the process of the sender was there before
///     (EarlierController): what it requested of the earlier controller, until this one started, is not known.
/// It stays revoked until its own next accepted zero velocity. A connection that a process (same_process) opens goes on
/// where one that it has closed ended; a process that was restarted owes nothing. Of closed connections kMostClosed
/// are remembered, the newest ones.
///
/// Time is that of the loop's frames.

#include <boost/weak_ptr.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bridge/inputs/publisher.h"
#include "signals/permit.h"

namespace robot_control {

/// May the robot move, as the safety monitor says?
struct MotionPermission {
  std::uint64_t run = 0;          ///< of the driver; 0: not known yet
  std::uint64_t withdrawals = 0;  ///< Permit::withdrawals
  bool granted = false;           ///< SupervisorState::kReady or kDrive
  bool stopped = false;           ///< a stop is latched
};

inline MotionPermission motion_permission(const Permit& permit) {
  return {.run = permit.head.run,
          .withdrawals = permit.withdrawals,
          .granted = permit.action == PermitAction::kDrive,
          .stopped = permit.causes != 0};
}

/// What was there when this controller started. That was a restart if the run that it finds had a command before, or if
/// a stop is latched.
struct EarlierController {
  std::vector<Publisher> present;  ///< publishers of command topics, without connections
  std::uint64_t run = 0;           ///< of the last command of an earlier controller; 0: none
};

class MotionRequests {
 public:
  /// ns from a zero velocity that releases motion to the permit that says so, at 100 Hz.
  static constexpr std::int64_t kInTransit = 100'000'000;
  static constexpr std::size_t kMostClosed = 256;

  /// `window_ns` > 0: a request without another message ends after it, but for the rules of revocation.
  void set_window(std::int64_t window_ns) { window_ns_ = window_ns; }

  /// Before the first call of `follow`.
  void start(const EarlierController& earlier) { earlier_ = earlier; }

  /// A message that was refused or is not of zero velocity.
  void request(const Publisher& sender, std::int64_t now_ns);

  /// An accepted zero velocity.
  void end(const Publisher& sender);

  /// Returns true if the command in force ends: the permission was withdrawn, or its grant revoked a connection.
  bool follow(const MotionPermission& permission, std::int64_t now_ns);

  /// The robot may move, as of the last call of `follow`.
  bool granted() const { return permission_.granted; }

  /// Of a connection that has sent a message.
  bool revoked(const Publisher& sender) const;

  /// A connection requested motion within the window, and has neither ended its request nor closed.
  bool any(std::int64_t now_ns) const;

  /// Names of the revoked connections that have not closed, sorted.
  std::vector<std::string> revoked_names() const;

 private:
  struct Record {
    Publisher sender;  ///< without its connection
    boost::weak_ptr<const void> connection;
    std::optional<std::int64_t> requested_ns;  ///< of the last request
    bool requests = false;
    bool zero_sent = false;  ///< since the last withdrawal
    bool revoked = false;
  };

  Record& record_of(const Publisher& sender);
  void forget_the_oldest_closed();
  bool recent(const Record& record, std::int64_t now_ns) const;

  std::int64_t window_ns_ = 0;
  EarlierController earlier_;
  std::int64_t started_ns_ = 0;  ///< first call of `follow`
  MotionPermission permission_;
  std::vector<Record> records_;
};

}  // namespace robot_control

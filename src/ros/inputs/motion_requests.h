#pragma once
/// MotionRequests records which connections send, which of them request motion, and which are revoked. It is pure.
///
/// A connection requests motion from a message whose stamp is refused, or that is not of zero velocity, until its next
/// zero velocity. A latched stop, a start of a node and the end of a pause withdraw the permission to move
/// (Permit::withdrawals). A connection is revoked
///   - by a withdrawal, if it requests motion then or did so within `window` before;
///   - when permission is granted again, if it requests motion then: such a request was made during the stop. A request
///     that follows a zero velocity and is no older than in_transit_ns and `window` was made with the grant;
///   - by a request whose stamp is older than the last grant by more than in_transit_ns: it was made before that grant;
///   - from the beginning, if this controller was restarted and the sender's process was present at its start
///     (EarlierController): its requests to the earlier controller are not known.
/// It stays revoked until its own next zero velocity. A new connection of a process (same_process) continues the state
/// of one to its topic that the process has closed. A revoked one comes first. If there is none, it begins revoked
/// where a closed one to another topic is. A restarted process begins without revocation. The state of the newest
/// kMaxClosed closed connections is kept.
///
/// Time is that of the loop's frames.

#include <algorithm>
#include <boost/weak_ptr.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ros/inputs/publisher.h"
#include "signals/permit.h"

namespace robot_control {

/// The permission to move, as the safety monitor publishes it.
struct MotionPermission {
  std::uint64_t run = 0;          ///< run of the driver; 0: not known yet
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

/// The situation at the start of this controller. The start was a restart if the present run already had a command, or
/// if a stop is latched. It also was one if the last command before it reports that motion was requested.
struct EarlierController {
  std::vector<Publisher> present;  ///< publishers of command topics, without connections
  std::uint64_t run = 0;           ///< run of the last command of an earlier controller; 0: none
  bool requested = false;          ///< the last message of its run was received, and was no zero velocity
  std::int64_t period_ns = 0;      ///< of the loop
};

class MotionRequests {
 public:
  /// Returns the ns from a zero velocity that releases motion to the permit that grants it: ten periods, at least
  /// 100 ms.
  static constexpr std::int64_t in_transit_ns(std::int64_t period_ns) noexcept {
    constexpr std::int64_t kInTransit = 100'000'000;
    return std::max(kInTransit, 10 * period_ns);
  }
  static constexpr std::size_t kMaxClosed = 256;
  static constexpr std::size_t kMaxNames = 16;

  /// Sets after which silence a request ends (`window_ns` > 0), except for the rules of revocation.
  void set_window(std::int64_t window_ns) { window_ns_ = window_ns; }

  /// Sets the situation at the start; is called before the first call of `follow`.
  void start(const EarlierController& earlier) { earlier_ = earlier; }

  /// Records a message with a usable stamp.
  void sent(const Publisher& sender, std::int64_t now_ns) { record_of(sender).sent_ns = now_ns; }

  /// Returns the names of the nodes that sent within `window_ns`, sorted, and at most kMaxNames of them. A node that
  /// only advertises a topic is not one of them. If time goes back by more than the window (a new simulation), none is.
  std::vector<std::string> senders(std::int64_t now_ns, std::int64_t window_ns) const;

  /// Records a message that was refused or is not of zero velocity, of this age by its stamp (0 without one).
  void request(const Publisher& sender, std::int64_t now_ns, std::int64_t age_ns = 0);

  /// Records a zero velocity with a usable stamp.
  void end(const Publisher& sender);

  /// Applies the monitor's permission. Returns true if the command in force ends, because permission was withdrawn or
  /// its grant revoked a connection.
  bool follow(const MotionPermission& permission, std::int64_t now_ns);

  /// Returns whether the robot was permitted to move at the last call of `follow`.
  bool granted() const { return permission_.granted; }

  /// Returns whether a connection that has sent a message is revoked.
  bool revoked(const Publisher& sender) const;

  /// Returns whether an open connection has requested motion within the window and has not ended its request.
  bool any(std::int64_t now_ns) const;

  /// Returns the names of the revoked open connections, sorted.
  std::vector<std::string> revoked_names() const;

 private:
  struct Record {
    Publisher sender;  ///< without its connection
    boost::weak_ptr<const void> connection;
    std::optional<std::int64_t> sent_ns;       ///< time of the last message with a usable stamp
    std::optional<std::int64_t> requested_ns;  ///< time of the last request
    bool requests = false;
    bool zero_sent = false;  ///< a zero velocity was received since the last withdrawal
    bool revoked = false;
  };

  Record& record_of(const Publisher& sender);
  void forget_the_oldest_closed();
  bool recent(const Record& record, std::int64_t now_ns) const;

  std::int64_t window_ns_ = 0;
  EarlierController earlier_;
  std::int64_t started_ns_ = 0;  ///< time of the first call of `follow`
  std::int64_t granted_ns_ = 0;  ///< time of the last grant
  MotionPermission permission_;
  std::vector<Record> records_;
};

}  // namespace robot_control

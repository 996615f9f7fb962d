#pragma once
/// Which connections request motion, and whose requests are revoked. Pure.
///
/// A connection requests motion from a message that is refused or not of zero velocity until its next accepted zero
/// velocity. A latched stop, a start of a node and the end of a pause are withdrawals of the permission to move
/// (Permit::withdrawals).
/// A connection is revoked
///   - by a withdrawal, if it requests motion then or did so within `window` before;
///   - when permission is granted again, if it requests motion then: such a request was made during the stop. A request
///     that follows a zero velocity and is no older than kInTransit was made with the grant.
/// It stays revoked until its own next accepted zero velocity. A connection that has ended is forgotten: a sender that
/// was restarted is another one.
///
/// Time is that of the loop's frames.

#include <boost/weak_ptr.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bridge/inputs/publisher.h"

namespace robot_control {

/// May the robot move, as the safety monitor says?
struct MotionPermission {
  std::uint64_t run = 0;          ///< of the driver; 0: not known yet
  std::uint64_t withdrawals = 0;  ///< Permit::withdrawals
  bool granted = false;           ///< SupervisorState::kReady or kDrive
};

class MotionRequests {
 public:
  /// ns from a zero velocity that releases motion to the permit that says so, at 100 Hz.
  static constexpr std::int64_t kInTransit = 100'000'000;

  /// `window_ns` > 0: a request without another message ends after it, but for the rules of revocation.
  void set_window(std::int64_t window_ns) { window_ns_ = window_ns; }

  /// A message that was refused or is not of zero velocity.
  void request(const Publisher& sender, std::int64_t now_ns);

  /// An accepted zero velocity.
  void end(const Publisher& sender);

  /// Returns true if the command in force ends: the permission was withdrawn, or its grant revoked a connection.
  bool follow(const MotionPermission& permission, std::int64_t now_ns);

  /// The robot may move, as of the last call of `follow`.
  bool granted() const { return permission_.granted; }

  bool revoked(const Publisher& sender) const;

  /// A connection requested motion within the window, and has not ended its request.
  bool any(std::int64_t now_ns) const;

  /// Names of the revoked connections that have not ended, sorted.
  std::vector<std::string> revoked_names() const;

 private:
  struct Record {
    std::string name;
    boost::weak_ptr<const void> connection;
    std::optional<std::int64_t> requested_ns;  ///< of the last request
    bool requests = false;
    bool zero_sent = false;  ///< since the last withdrawal
    bool revoked = false;
  };

  Record& record_of(const Publisher& sender);
  bool recent(const Record& record, std::int64_t now_ns) const;

  std::int64_t window_ns_ = 0;
  MotionPermission permission_;
  std::vector<Record> records_;
};

}  // namespace robot_control

#pragma once
/// Connections never take the last file descriptors of this process.
///
/// A connection that others make brings observers of topics and callers of services, no command: cmd_vel, e_stop and
/// heartbeat come over connections that this process makes itself. So where descriptors run out, an accepted connection
/// gives way to a new one: e_stop_trigger stays reachable. accepted_sockets.cpp puts an accept(2) of its own before the
/// C library's, for every socket of the program:
///
///   a descriptor is the lowest free number (POSIX), so its value says how many are in use. At
///   value ≥ limit − kReserve, or where accept fails for want of descriptors, one connection is shut down:
///     of those that never sent a byte the oldest, if it is older than 200 ms or there are more than 16;
///     else of those that are younger than 200 ms the oldest, if there are more than 16;
///     else of the others the youngest.
///   So a flood of connections displaces itself: a call has 200 ms, and observers from before the flood stay.
///   roscpp then closes it as if the peer had.
///
/// A connection that this process makes, too, takes a descriptor, and XML-RPC's publisherUpdate makes it connect to
/// whatever it names. So socket(2) is replaced likewise: where half of all descriptors are such connections, or in the
/// last 6/8 of the reserve, it fails with EMFILE for Internet sockets, which roscpp takes for a peer that cannot be
/// reached.
///
/// The reserve is what the process needs itself: shared memory, connections to publishers, to the master, log files;
/// XML-RPC of roscpp refuses where fewer than 32 are free. An observer in roscpp that lost its connection connects
/// again, one in rospy when the master next names the publishers.

#include <cstdint>

namespace robot_control {

inline constexpr std::uint64_t kReserve = 64;  ///< descriptors, of a limit of 256 or more; else a quarter of it

/// Descriptors that accepted connections leave free under this limit (RLIMIT_NOFILE).
constexpr std::uint64_t reserve_of(std::uint64_t limit) {
  return limit >= 4 * kReserve ? kReserve : limit / 4;
}

/// Connections shut down for want of descriptors, so far. Any thread.
std::uint64_t evicted_connections() noexcept;

}  // namespace robot_control

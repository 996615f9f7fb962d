#pragma once
/// Connections never take the last file descriptors of this process.
///
/// A connection made by another process serves an observer of topics or a caller of services. Commands, e_stop and
/// heartbeat arrive over connections that this process makes itself. When descriptors run out, an accepted connection
/// is therefore closed for a new one: e_stop_trigger stays reachable. The file accepted_sockets.cpp replaces the C
/// library's accept(2) for every socket of the program:
///
///   a descriptor is the lowest free number (POSIX), so its value says how many are in use. At
///   value ≥ limit − kReserve, or if accept fails because descriptors ran out, one connection is shut down:
///     the oldest of those that never sent a byte, if it is older than 200 ms or there are more than 16;
///     else the oldest of those that are younger than 200 ms, if there are more than 16;
///     else the youngest of the others.
///   In a flood, new connections therefore displace each other: a call has 200 ms, and earlier observers stay.
///   roscpp then closes the connection as if the peer had closed it.
///
/// Connections that this process makes take descriptors as well, and XML-RPC's publisherUpdate makes it connect to
/// every peer that the request names. So socket(2) is also replaced. For Internet sockets it fails with EMFILE if half
/// of all descriptors are such connections, or in the last 6/8 of the reserve. To roscpp such a peer cannot be reached.
///
/// The reserve covers the needs of the process: shared memory, connections to publishers and to the master, log files.
/// The XML-RPC of roscpp refuses requests if fewer than 32 descriptors are free. A roscpp observer that lost its
/// connection connects again, a rospy observer when the master next names the publishers.

#include <cstdint>

namespace robot_control {

inline constexpr std::uint64_t kReserve =
    64;  ///< descriptors, for a limit of 256 or more; below, a quarter of the limit

/// Returns the number of descriptors that accepted connections leave free under this limit (RLIMIT_NOFILE).
constexpr std::uint64_t reserve_of(std::uint64_t limit) {
  return limit >= 4 * kReserve ? kReserve : limit / 4;
}

/// Returns how many connections were shut down so far because descriptors ran out. Any thread may call it.
std::uint64_t evicted_connections() noexcept;

}  // namespace robot_control

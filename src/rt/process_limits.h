#pragma once
/// These functions handle the limits that the system sets to a process (getrlimit(2)).

#include <string>

namespace robot_control {

/// Makes a write beyond the limit on file sizes (RLIMIT_FSIZE, `ulimit -f`) fail with EFBIG, like a full disk. By
/// default SIGXFSZ would end the process without a message.
void ignore_file_size_signal() noexcept;

/// A node needs about thirty descriptors for libraries, epoll, the master, channels and log, and further ones for each
/// peer of its topics.
inline constexpr unsigned long kMinDescriptors = 64;

/// Raises the soft limit on descriptors (RLIMIT_NOFILE) to kMinDescriptors, if the hard limit permits it. Otherwise
/// returns the reason why the node must not start, with its remedy; "" if it may start.
std::string descriptor_problem();

}  // namespace robot_control

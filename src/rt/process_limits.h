#pragma once
/// Limits that the system sets to a process (getrlimit(2)).

#include <string>

namespace robot_control {

/// A write beyond the limit on file sizes (RLIMIT_FSIZE, `ulimit -f`) fails with EFBIG, as on a full disk; by default
/// SIGXFSZ would end the process without a word.
void ignore_file_size_signal() noexcept;

/// A node holds some thirty descriptors of its own: libraries, epoll, the master, channels, log. Others come with
/// every peer of its topics.
inline constexpr unsigned long kMinDescriptors = 64;

/// Raises the soft limit on descriptors (RLIMIT_NOFILE) to kMinDescriptors, where the hard one permits. What stands
/// against a start, with its remedy; empty: nothing.
std::string descriptor_problem();

}  // namespace robot_control

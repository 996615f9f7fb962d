#include "rt/process_limits.h"

#include <sys/resource.h>

#include <csignal>

namespace robot_control {

void ignore_file_size_signal() noexcept {
  std::signal(SIGXFSZ, SIG_IGN);
}

std::string descriptor_problem() {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur >= kMinDescriptors) return "";
  const rlim_t max_descriptors = limit.rlim_max;
  if (max_descriptors >= kMinDescriptors) {
    limit.rlim_cur = kMinDescriptors;
    if (setrlimit(RLIMIT_NOFILE, &limit) == 0) return "";
  }
  return "only " + std::to_string(max_descriptors) +
         " files may be open at a time (RLIMIT_NOFILE), but a node needs at least " + std::to_string(kMinDescriptors) +
         "; remedy: `ulimit -n 1024` before the start, or LimitNOFILE= of its service";
}

}  // namespace robot_control

#include "rt/thread_priority.h"

#include <sched.h>
#include <sys/resource.h>

namespace robot_control {

bool precede_ordinary_threads() noexcept {
  constexpr int kLowest = 1;
  if (rlimit limit{}; getrlimit(RLIMIT_RTPRIO, &limit) == 0 && limit.rlim_cur < kLowest) {
    limit.rlim_cur = limit.rlim_max;
    setrlimit(RLIMIT_RTPRIO, &limit);
  }
  const sched_param parameter{.sched_priority = kLowest};
  return sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &parameter) == 0;
}

}  // namespace robot_control

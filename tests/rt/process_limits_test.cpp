#include "rt/process_limits.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include "support/processes/child_process.h"

namespace robot_control::tests {

/// Returns 0 without a problem, 1 with one that names the limit and the remedy.
int verdict_with(rlim_t soft, rlim_t hard) {
  return ChildProcess([&] {
           const rlimit limit{soft, hard};
           if (setrlimit(RLIMIT_NOFILE, &limit) != 0) return 2;
           const std::string problem = descriptor_problem();
           if (problem.empty()) return 0;
           return problem.find("only " + std::to_string(hard) + " files") != std::string::npos &&
                          problem.find("ulimit -n") != std::string::npos
                      ? 1
                      : 3;
         })
      .wait();
}

TEST(ProcessLimits, TooFewDescriptorsAreRefusedWithTheRemedy) {
  for (const rlim_t count : {8u, 16u, 32u, 63u}) EXPECT_EQ(verdict_with(count, count), 1) << count;
}

TEST(ProcessLimits, ASoftLimitOnDescriptorsIsRaised) {
  EXPECT_EQ(verdict_with(8, 64), 0);
  EXPECT_EQ(verdict_with(64, 64), 0);
}

}  // namespace robot_control::tests

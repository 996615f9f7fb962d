/// Another program takes the chain's core, in real time. The test needs SCHED_FIFO, and a core for itself.

#include <sched.h>
#include <sys/prctl.h>

#include <atomic>

#include "losses_fixture.h"

namespace robot_control {
namespace {

constexpr double kHogSeconds = 2.0;  // it ends by itself if it is not ended

bool may_run_in_real_time() {
  return ChildProcess([] {
           const sched_param wanted{.sched_priority = 1};
           return sched_setscheduler(0, SCHED_FIFO, &wanted);
         }).wait() == 0;
}

void stay_on(const cpu_set_t& cores) {
  sched_setaffinity(0, sizeof cores, &cores);
}

/// Spins on the chain's core when signalled.
class Hog {
 public:
  Hog(int priority, std::int64_t core) : process_([this, priority, core] { return spin(priority, core); }) {
    while (!state_->ready.load()) sleep_ns(1'000'000);
  }
  void begin() { state_->go.store(true); }
  void end() { process_.kill(); }

 private:
  struct State {
    std::atomic<bool> ready;
    std::atomic<bool> go;
  };

  int spin(int priority, std::int64_t core) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    cpu_set_t cores;
    CPU_ZERO(&cores);
    CPU_SET(static_cast<std::size_t>(core), &cores);
    stay_on(cores);
    const sched_param wanted{.sched_priority = priority};
    sched_setscheduler(0, SCHED_FIFO, &wanted);
    state_->ready.store(true);
    while (!state_->go.load()) sleep_ns(200'000);
    const std::int64_t end_ns = monotonic_ns() + static_cast<std::int64_t>(kHogSeconds * 1e9);
    while (monotonic_ns() < end_ns) {
    }
    return 0;
  }

  AnonymousMemory<State> state_;
  ChildProcess process_;
};

class AHog : public Losses {
 protected:
  static Parameters on_one_core() {
    Parameters parameters = DrivingRobot::quick(kParams);
    parameters.loop.core = 0;
    return parameters;
  }
  AHog() : Losses(on_one_core()) {}

  /// The chain must not starve the test.
  void SetUp() override {
    if (!may_run_in_real_time()) GTEST_SKIP() << "SCHED_FIFO is not granted";
    CPU_ZERO(&before_);
    sched_getaffinity(0, sizeof before_, &before_);
    cpu_set_t others = before_;
    CPU_CLR(0, &others);
    if (CPU_COUNT(&others) == 0) GTEST_SKIP() << "there is one core only";
    stay_on(others);
    moved_ = true;
  }
  void TearDown() override {
    if (moved_) stay_on(before_);
  }

 private:
  cpu_set_t before_{};
  bool moved_ = false;
};

TEST_F(AHog, AtTheControllersPriorityStarvesItAndTheRobotBrakes) {
  Hog hog(static_cast<int>(LoopPriority::kController), 0);
  robot_.poll();
  log().forget();
  const std::uint64_t before = robot_.cycle();
  hog.begin();
  EXPECT_TRUE(robot_.await([&] { return log().rested(DrivingRobot::kRestCycles); }, kHogSeconds / 2))
      << robot_.situation();
  hog.end();
  const std::uint64_t braked = log().braking_since().value_or(before + 1000);
  std::printf("  brake after %llu cycles\n", static_cast<unsigned long long>(braked - before));
  EXPECT_LE(braked, before + kBrakeWithin);
  expect_latched_until_reset_and_new_command(kCauseControllerLost);
}

/// Nothing of this software runs then. In the simulation the world stands still, too. On a machine it does not, and
/// only the drives' own watchdogs brake.
TEST_F(AHog, AboveTheDriverStopsEverythingAndAfterItNothingJumps) {
  constexpr std::int64_t kSpell = 300'000'000;  // ns; less than what the kernel's real-time throttling lets pass
  Hog hog(static_cast<int>(LoopPriority::kDriver) + 1, 0);
  robot_.poll();
  log().forget();
  hog.begin();
  sleep_ns(kSpell / 3);
  const std::uint64_t during = robot_.cycle();
  sleep_ns(kSpell / 3);
  EXPECT_EQ(robot_.cycle(), during) << "not one cycle: no software brakes";
  hog.end();
  EXPECT_TRUE(robot_.await([&] { return log().last().cycle > during + 200; })) << robot_.situation();
  expect_no_jump();
  for (const LoopNode node : kLoop) expect_lives(node);
  robot_.drive_at_full_speed();
  expect_undisturbed();
}

}  // namespace
}  // namespace robot_control

/// Every test runs in a child: locked memory, limits and capabilities belong to a whole process.

#include "rt/realtime_thread.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <thread>

#include "support/allocation_guard.h"
#include "support/file_content.h"
#include "support/processes/child_process.h"
#include "support/temporary_folder.h"

namespace robot_control::tests {

int first_core() {
  cpu_set_t cores;
  sched_getaffinity(0, sizeof cores, &cores);
  for (std::size_t core = 0; core < CPU_SETSIZE; ++core) {
    if (CPU_ISSET(core, &cores)) return static_cast<int>(core);
  }
  return -1;
}

/// The attributes of the calling thread.
struct Self {
  int policy = -1;
  int priority = -1;
  int cores = -1;
  int core = -1;
  std::string name;
};

Self self() {
  Self found;
  sched_param parameter{};
  pthread_getschedparam(pthread_self(), &found.policy, &parameter);
  found.priority = parameter.sched_priority;
  cpu_set_t cores;
  pthread_getaffinity_np(pthread_self(), sizeof cores, &cores);
  found.cores = CPU_COUNT(&cores);
  found.core = sched_getcpu();
  char name[16] = {};
  pthread_getname_np(pthread_self(), name, sizeof name);
  found.name = name;
  return found;
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Returns the resident bytes of code and constants of a library.
std::size_t resident_bytes(std::string_view library) {
  std::ifstream maps("/proc/self/smaps");
  std::size_t kilobytes = 0;
  bool wanted = false;
  for (std::string line; std::getline(maps, line);) {
    if (line.find('-') < line.find(' ')) {
      const std::size_t access = line.find(' ') + 1;
      wanted = contains(line, std::string(library)) && line[access] == 'r' && line[access + 1] == '-';
    } else if (wanted && line.starts_with("Rss:")) {
      kilobytes += std::stoul(line.substr(4));
    }
  }
  return kilobytes * 1024;
}

/// Drops every limit and capability that would grant anything. Returns false if that is not possible.
bool drop_privileges() {
  for (const auto resource : {RLIMIT_RTPRIO, RLIMIT_MEMLOCK}) {
    const rlimit none{0, 0};
    if (setrlimit(resource, &none) != 0) return false;
  }
  if (geteuid() == 0 && setresuid(65534, 65534, 65534) != 0) return false;
  const sched_param parameter{.sched_priority = 1};
  return pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameter) != 0;
}

/// Exit codes of a child: 0: the claim holds, kSkip: it cannot be tested here, else the number of the failed claim.
constexpr int kSkip = 77;

template <class Body>
void expect_in_child(Body body) {
  ChildProcess child(body);
  const int code = child.wait();
  if (code == kSkip) GTEST_SKIP() << "this process has, or has not, the privileges that this test is about";
  EXPECT_EQ(code, 0) << "number of the claim";
}

TEST(RealtimeThread, RunsItsBodyUnderItsName) {
  expect_in_child([] {
    Self found;
    {
      const RealtimeThread thread({.name = "loop_of_the_test", .policy = RealtimePolicy::kOff},
                                  [&] { found = self(); });
    }
    return found.name == "loop_of_the_tes" ? 0 : 1;
  });
}

TEST(RealtimeThread, AloneTakesTheCore) {
  expect_in_child([] {
    if (self().cores < 2) return kSkip;
    Self inside;
    std::atomic<bool> stop{false};
    Self before;
    std::thread earlier([&] {
      while (!stop.load()) std::this_thread::yield();
      before = self();
    });
    const int core = first_core();
    RealtimeThread thread({.policy = RealtimePolicy::kOff, .core = core}, [&] { inside = self(); });
    thread.join();
    stop.store(true);
    earlier.join();
    Self after;
    std::thread later([&] { after = self(); });
    later.join();
    if (inside.cores != 1 || inside.core != core) return 1;
    if (thread.report().core != Grant::kGranted) return 2;
    if (before.cores < 2 || after.cores < 2 || self().cores < 2) return 3;
    return thread.report().refusals.empty() ? 0 : 4;
  });
}

TEST(RealtimeThread, TakesTheCoreWithoutAnyPrivilege) {
  expect_in_child([] {
    if (!drop_privileges()) return kSkip;
    Self inside;
    RealtimeThread thread({.policy = RealtimePolicy::kPreferred, .priority = 80, .core = first_core()},
                          [&] { inside = self(); });
    thread.join();
    if (inside.cores != 1) return 1;
    return thread.report().core == Grant::kGranted ? 0 : 2;
  });
}

TEST(RealtimeThread, AsksNothingElseWhenOff) {
  expect_in_child([] {
    Self inside;
    RealtimeThread thread({.policy = RealtimePolicy::kOff, .priority = 80}, [&] { inside = self(); });
    thread.join();
    if (inside.policy != SCHED_OTHER || inside.priority != 0) return 1;
    const RealtimeReport& report = thread.report();
    return report.memory_lock == Grant::kNotRequested && report.priority == Grant::kNotRequested &&
                   report.core == Grant::kNotRequested && report.refusals.empty()
               ? 0
               : 2;
  });
}

TEST(RealtimeThread, PreferredRunsWithoutPrivilegesAndSaysOnceWhatIsMissingWithTheRemedy) {
  expect_in_child([] {
    if (!drop_privileges()) return kSkip;
    bool ran = false;
    RealtimeThread thread({.policy = RealtimePolicy::kPreferred, .priority = 80}, [&] { ran = true; });
    thread.join();
    const RealtimeReport& report = thread.report();
    if (!ran) return 1;
    if (report.memory_lock != Grant::kRefused || report.priority != Grant::kRefused) return 2;
    if (report.refusals.size() != 2) return 3;
    if (!contains(report.refusals[0], "memlock unlimited") || !contains(report.refusals[0], "CAP_IPC_LOCK")) return 4;
    if (!contains(report.refusals[1], "rtprio") || !contains(report.refusals[1], "CAP_SYS_NICE")) return 5;
    return contains(report.refusals[1], "80") ? 0 : 6;
  });
}

TEST(RealtimeThread, RequiredRefusesWithoutPrivilegesAndTheBodyNeverRuns) {
  expect_in_child([] {
    if (!drop_privileges()) return kSkip;
    bool ran = false;
    try {
      const RealtimeThread thread({.policy = RealtimePolicy::kRequired, .priority = 80}, [&] { ran = true; });
      return 1;
    } catch (const RealtimeError& error) {
      if (ran) return 2;
      return contains(error.what(), "memlock") && contains(error.what(), "rtprio") ? 0 : 3;
    }
  });
}

TEST(RealtimeThread, RequiredRefusesACoreThatIsNotThere) {
  expect_in_child([] {
    if (prepare_process(RealtimePolicy::kRequired).memory_lock != Grant::kGranted) return kSkip;
    try {
      const RealtimeThread thread({.policy = RealtimePolicy::kRequired, .core = 5000}, [] {});
      return 1;
    } catch (const RealtimeError& error) {
      return contains(error.what(), "core 5000") && contains(error.what(), "taskset") ? 0 : 2;
    }
  });
}

TEST(RealtimeThread, PreferredRunsUnpinnedWhereTheCoreIsNotThere) {
  expect_in_child([] {
    bool ran = false;
    RealtimeThread thread({.policy = RealtimePolicy::kOff, .core = 1000}, [&] { ran = true; });
    thread.join();
    return ran && thread.report().core == Grant::kRefused && thread.report().refusals.size() == 1 ? 0 : 1;
  });
}

TEST(RealtimeThread, AloneHasThePriorityWhereItIsGranted) {
  expect_in_child([] {
    Self inside;
    RealtimeThread thread({.policy = RealtimePolicy::kPreferred, .priority = 80}, [&] { inside = self(); });
    thread.join();
    if (thread.report().priority != Grant::kGranted) return kSkip;
    if (inside.policy != SCHED_FIFO || inside.priority != 80) return 1;
    return self().policy == SCHED_OTHER ? 0 : 2;
  });
}

/// The number of µs that holds for the machine; -1 if it cannot be read.
std::int32_t cpu_latency() {
  std::int32_t latency = -1;
  const int device = open(kLatencyDevice, O_RDONLY);
  if (device < 0) return -1;
  if (read(device, &latency, sizeof latency) != sizeof latency) latency = -1;
  close(device);
  return latency;
}

TEST(RealtimeThread, LimitsIdleStatesWhileItExists) {
  expect_in_child([] {
    if (cpu_latency() < 0) return kSkip;
    std::int32_t inside = -1;
    {
      RealtimeThread thread({.policy = RealtimePolicy::kPreferred, .cpu_latency_us = 7},
                            [&] { inside = cpu_latency(); });
      thread.join();
      if (thread.report().cpu_latency != Grant::kGranted) return kSkip;
    }
    if (inside < 0 || inside > 7) return 1;  // a program beside the test may request less
    return inside < 7 || cpu_latency() != 7 ? 0 : 2;
  });
}

TEST(RealtimeThread, RequestsNoIdleStatesWhenOff) {
  expect_in_child([] {
    RealtimeThread thread({.policy = RealtimePolicy::kOff, .cpu_latency_us = 7}, [] {});
    thread.join();
    return thread.report().cpu_latency == Grant::kNotRequested && thread.report().refusals.empty() ? 0 : 1;
  });
}

TEST(RealtimeThread, SaysTheRemedyWhereIdleStatesAreRefused) {
  expect_in_child([] {
    if (!drop_privileges() || access(kLatencyDevice, F_OK) != 0 || access(kLatencyDevice, W_OK) == 0) return kSkip;
    RealtimeThread thread({.policy = RealtimePolicy::kPreferred, .cpu_latency_us = 7}, [] {});
    thread.join();
    if (thread.report().cpu_latency != Grant::kRefused) return 1;
    const std::string said = thread.report().refusals.at(1);
    return contains(said, "cpu_dma_latency 7 us") && contains(said, "scripts/privileges install") ? 0 : 2;
  });
}

TEST(LatencyRequest, WritesThirtyTwoBitsToTheDevice) {
  const TemporaryFolder folder;
  const std::filesystem::path device = folder.write("cpu_dma_latency", "");
  EXPECT_EQ(LatencyRequest(258, device.c_str()).refusal(), "");
  EXPECT_EQ(content(device), std::string("\x02\x01\0\0", 4));
}

TEST(LatencyRequest, SaysThatTheKernelHasNoDevice) {
  const LatencyRequest request(0, "/nonexistent");
  EXPECT_TRUE(contains(request.refusal(), "/nonexistent: No such file or directory; remedy: remove"));
}

TEST(AnOrdinaryThreadThatPrecedesOthers, HasTheLowestRealTimePriorityAndItsThreadsHaveNone) {
  expect_in_child([] {
    if (!precede_ordinary_threads()) return kSkip;
    sched_param parameter{};
    int policy = 0;
    pthread_getschedparam(pthread_self(), &policy, &parameter);
    if ((policy & ~SCHED_RESET_ON_FORK) != SCHED_FIFO || parameter.sched_priority != 1) return 1;
    int inherited = SCHED_FIFO;
    std::thread([&] { inherited = sched_getscheduler(0); }).join();
    return inherited == SCHED_OTHER ? 0 : 2;
  });
}

TEST(PrepareProcess, LocksNothingUnderAFiniteLimitSoThatLaterMappingsSucceed) {
  expect_in_child([] {
    if (!drop_privileges()) return kSkip;
    if (prepare_process(RealtimePolicy::kPreferred).memory_lock != Grant::kRefused) return 1;
    void* memory = mmap(nullptr, 64 << 20, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    return memory != MAP_FAILED ? 0 : 2;
  });
}

TEST(PrepareProcess, LaterThreadsHaveSmallStacksWhereMemoryIsLocked) {
  expect_in_child([] {
    if (prepare_process(RealtimePolicy::kPreferred).memory_lock != Grant::kGranted) return kSkip;
    std::size_t bytes = 0;
    std::thread later([&] {
      pthread_attr_t attributes;
      pthread_getattr_np(pthread_self(), &attributes);
      pthread_attr_getstacksize(&attributes, &bytes);
      pthread_attr_destroy(&attributes);
    });
    later.join();
    return bytes <= 2u << 20 ? 0 : 1;
  });
}

TEST(PrepareProcess, AnUnlockedLibraryIsNotResidentAndStillWorks) {
  if (!AllocationGuard::kCounts) GTEST_SKIP() << "the sanitizer locks no memory";
  expect_in_child([] {
    constexpr std::string_view kLibrary = "libm.";
    if (prepare_process(RealtimePolicy::kPreferred).memory_lock != Grant::kGranted) return kSkip;
    const std::size_t before = resident_bytes(kLibrary);
    if (unlock_libraries({&kLibrary, 1}) < before / 2 || resident_bytes(kLibrary) > before / 10) return 1;
    const volatile double angle = 0.5;
    return std::abs(std::sin(angle) - 0.479425538604203) < 1e-15 ? 0 : 2;
  });
}

TEST(PrepareProcess, SaysTheSameEachTime) {
  expect_in_child([] {
    const RealtimeReport first = prepare_process(RealtimePolicy::kPreferred);
    const RealtimeReport second = prepare_process(RealtimePolicy::kRequired);
    return first.memory_lock == second.memory_lock && first.refusals == second.refusals ? 0 : 1;
  });
}

}  // namespace robot_control::tests

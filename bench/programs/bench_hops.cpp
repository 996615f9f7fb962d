/// bench_hops HOPS CYCLES: a bare futex ping-pong as reference of the chain from sensors to command.
///
/// A thread that is paced at 1 kHz wakes a process, which wakes the next one, and so on. All have the core and the
/// priorities of the loop. Each line of the output is the time of one cycle in ns. It begins with the wake-up of the
/// first thread and ends with that of the last one.

#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdlib>
#include <iostream>
#include <new>
#include <vector>

#include "rt/clock.h"
#include "rt/futex.h"
#include "rt/realtime_thread.h"

namespace robot_control::bench {

constexpr int kMaxHops = 8;
constexpr int kPriority = 83;  // LoopPriority::kDriver
constexpr std::int64_t kPeriod = 1'000'000;
constexpr std::int64_t kWait = 100'000'000;

struct Shared {
  std::array<std::atomic<std::uint32_t>, kMaxHops + 1> words{};
  std::atomic<std::int64_t> arrived_ns{0};
  std::atomic<bool> end{false};
};

/// Wakes hop `index + 1` for each wake-up of hop `index`; the last one notes the time.
void relay(Shared& shared, int index, int hops) {
  const auto place = static_cast<std::size_t>(index);
  const RealtimeParameters parameters{.name = "hop", .priority = kPriority - index, .core = 0};
  RealtimeThread(parameters, [&] {
    std::uint32_t seen = 0;
    while (!shared.end.load()) {
      if (!futex_wait(shared.words[place], seen, kWait)) continue;
      seen = shared.words[place].load();
      if (index == hops) {
        shared.arrived_ns.store(monotonic_ns());
      } else {
        shared.words[place + 1].fetch_add(1, std::memory_order_release);
        futex_wake_all(shared.words[place + 1]);
      }
    }
  }).join();
}

std::vector<std::int64_t> pace(Shared& shared, int cycles) {
  std::vector<std::int64_t> times(static_cast<std::size_t>(cycles));
  RealtimeThread({.name = "pace", .priority = kPriority, .core = 0}, [&] {
    std::int64_t deadline_ns = monotonic_ns() + kPeriod;
    for (std::size_t i = 0; i < times.size(); ++i) {
      sleep_until(deadline_ns);
      deadline_ns += kPeriod;
      if (i > 0) times[i - 1] = shared.arrived_ns.load() - times[i - 1];
      times[i] = monotonic_ns();
      shared.words[1].fetch_add(1, std::memory_order_release);
      futex_wake_all(shared.words[1]);
    }
  }).join();
  times.pop_back();
  return times;
}

int run(int hops, int cycles) {
  void* const memory = mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) return 1;
  Shared& shared = *new (memory) Shared;
  for (int hop = 1; hop <= hops; ++hop) {
    if (fork() != 0) continue;
    relay(shared, hop, hops);
    std::_Exit(0);
  }
  sleep_ns(300'000'000);
  const std::vector<std::int64_t> times = pace(shared, cycles);
  shared.end.store(true);
  while (wait(nullptr) > 0) {
  }
  for (const std::int64_t time : times) std::cout << time << "\n";
  return 0;
}

}  // namespace robot_control::bench

int main(int argc, char** argv) {
  const int hops = argc == 3 ? std::atoi(argv[1]) : 0;
  const int cycles = argc == 3 ? std::atoi(argv[2]) : 0;
  if (hops < 1 || hops > robot_control::bench::kMaxHops || cycles < 2) {
    std::cerr << "usage: bench_hops HOPS CYCLES, with 1 … 8 hops\n";
    return 2;
  }
  return robot_control::bench::run(hops, cycles);
}

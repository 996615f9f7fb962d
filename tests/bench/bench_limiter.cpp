/// bench_limiter FIRST RUNS: so many random command sequences over the limiter (tests/control/limiter_properties.h),
/// on all cores. The first violations go to stderr, each with its seed.

#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "bench/rows.h"
#include "control/limiter_properties.h"
#include "rt/clock.h"

namespace robot_control::bench {
namespace {

constexpr std::uint64_t kTold = 20;           // violations
constexpr std::uint64_t kBlock = 1000;        // seeds that a thread takes at a time
constexpr std::uint64_t kProgress = 100'000;  // seeds between two lines

class Trials {
 public:
  Trials(std::uint64_t first, std::uint64_t runs) : first_(first), runs_(runs) {}

  /// The number of seeds that violate a property.
  std::uint64_t run() {
    std::vector<std::thread> threads;
    for (unsigned i = 0; i < std::max(1u, std::thread::hardware_concurrency()); ++i)
      threads.emplace_back([&] { work(); });
    for (std::thread& thread : threads) thread.join();
    return failed_;
  }

 private:
  void work() {
    for (std::uint64_t from = next_.fetch_add(kBlock); from < runs_; from = next_.fetch_add(kBlock)) {
      if (from > 0 && from % kProgress == 0) tell(std::to_string(from) + " of " + std::to_string(runs_));
      for (std::uint64_t i = from; i < std::min(from + kBlock, runs_); ++i) judge(first_ + i);
    }
  }

  void judge(std::uint64_t seed) {
    const auto violated = limiter_violation(seed);
    if (violated && failed_.fetch_add(1) < kTold) {
      tell("seed " + std::to_string(seed) + ": " + *violated + "\n    again: scripts/bench limiter --first " +
           std::to_string(seed) + " --runs 1");
    }
  }

  void tell(const std::string& text) {
    const std::lock_guard lock(telling_);
    std::cerr << text << std::endl;
  }

  std::uint64_t first_;
  std::uint64_t runs_;
  std::atomic<std::uint64_t> next_{0};
  std::atomic<std::uint64_t> failed_{0};
  std::mutex telling_;
};

void run(std::uint64_t first, std::uint64_t runs) {
  const std::int64_t start = monotonic_ns();
  const auto failed = static_cast<double>(Trials(first, runs).run());
  const double seconds = 1e-9 * static_cast<double>(monotonic_ns() - start);
  const auto sequences = static_cast<double>(runs);
  print("limiter", {{"sequences", sequences, "of 200 cycles", 0, "none", 0},
                    {"sequences failed", failed, "", 0, "none", 0},
                    {"speed", sequences / seconds, "1/s", 0, "none", 0}});
}

}  // namespace
}  // namespace robot_control::bench

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: bench_limiter FIRST RUNS\n";
    return 2;
  }
  robot_control::bench::run(std::strtoull(argv[1], nullptr, 10), std::strtoull(argv[2], nullptr, 10));
}

#pragma once
/// Runs many seeds of one property on all cores. The first violations go to stderr, each with its seed.

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <functional>
#include <iostream>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace robot_control::bench {

class SeedTrials {
 public:
  /// Returns the violated property, its place and its cause; it is called from several threads.
  using Violation = std::function<std::optional<std::string>(std::uint64_t seed)>;

  SeedTrials(std::string bench, Violation violation) : bench_(std::move(bench)), violation_(std::move(violation)) {}

  /// The number of seeds that violate a property, of `runs` from `first` on.
  std::uint64_t run(std::uint64_t first, std::uint64_t runs) {
    first_ = first;
    runs_ = runs;
    std::vector<std::thread> threads;
    for (unsigned i = 0; i < std::max(1u, std::thread::hardware_concurrency()); ++i)
      threads.emplace_back([&] { work(); });
    for (std::thread& thread : threads) thread.join();
    return failed_;
  }

 private:
  static constexpr std::uint64_t kTold = 20;  // violations

  void work() {
    const std::uint64_t block = std::max<std::uint64_t>(1, runs_ / 1000);  // seeds that a thread takes at a time
    for (std::uint64_t from = next_.fetch_add(block); from < runs_; from = next_.fetch_add(block)) {
      if (from > 0 && from / block % 100 == 0) report(std::to_string(from) + " of " + std::to_string(runs_));
      for (std::uint64_t i = from; i < std::min(from + block, runs_); ++i) test_seed(first_ + i);
    }
  }

  void test_seed(std::uint64_t seed) {
    const auto violated = violation_(seed);
    if (violated && failed_.fetch_add(1) < kTold) {
      report("seed " + std::to_string(seed) + ": " + *violated + "\n    again: scripts/bench " + bench_ + " --first " +
             std::to_string(seed) + " --runs 1");
    }
  }

  void report(const std::string& text) {
    const std::lock_guard lock(telling_);
    std::cerr << text << std::endl;
  }

  std::string bench_;
  Violation violation_;
  std::uint64_t first_ = 0;
  std::uint64_t runs_ = 0;
  std::atomic<std::uint64_t> next_{0};
  std::atomic<std::uint64_t> failed_{0};
  std::mutex telling_;
};

}  // namespace robot_control::bench

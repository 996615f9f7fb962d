/// bench_bags FIRST RUNS: reads RUNS damaged bags (tests/log/bag/bag_trials.h) on all cores.

#include <sys/resource.h>

#include <cstdlib>

#include "bench/programs/rows.h"
#include "bench/programs/seed_trials.h"
#include "log/bag/bag_trials.h"
#include "rt/clock.h"

namespace robot_control::bench {

constexpr double kMaxMegabytes =
    512;  // memory of the process: two bags of some 10 kB at a time, which inflate to 64 MiB

double peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1000;
}

void run(std::uint64_t first, std::uint64_t runs) {
  std::mutex adding;
  BagFigures all;
  const std::int64_t start = monotonic_ns();
  auto failed = static_cast<double>(SeedTrials("bags", [&](std::uint64_t seed) {
                                      BagFigures figures;
                                      auto violated = bag_violation(seed, figures);
                                      const std::lock_guard lock(adding);
                                      all.refused += figures.refused;
                                      all.cut += figures.cut;
                                      all.whole += figures.whole;
                                      return violated;
                                    }).run(first, runs));
  const double seconds = 1e-9 * static_cast<double>(monotonic_ns() - start);
  if (peak_megabytes() > kMaxMegabytes) {
    std::cerr << "peak memory " << peak_megabytes() << " MB, more than " << kMaxMegabytes << std::endl;
    ++failed;
  }
  print("bags", {{"damaged bags", static_cast<double>(runs), "", 0, "none", 0},
                 {"sequences failed", failed, "", 0, "none", 0},
                 {"refused", static_cast<double>(all.refused), "", 0, "none", 0},
                 {"read up to the damage", static_cast<double>(all.cut), "", 0, "none", 0},
                 {"read as undamaged", static_cast<double>(all.whole), "", 0, "none", 0},
                 {"peak memory", peak_megabytes(), "MB", 0, "none", 0},
                 {"speed", static_cast<double>(runs) / seconds, "1/s", 0, "none", 0}});
}

}  // namespace robot_control::bench

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: bench_bags FIRST RUNS\n";
    return 2;
  }
  robot_control::bench::run(std::strtoull(argv[1], nullptr, 10), std::strtoull(argv[2], nullptr, 10));
}

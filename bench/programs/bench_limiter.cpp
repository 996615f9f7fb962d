/// bench_limiter FIRST RUNS: random command sequences over the limiter
/// (tests/control/wheeled/limits/limiter_properties.h), on all cores.

#include <cstdlib>

#include "bench/programs/rows.h"
#include "bench/programs/seed_trials.h"
#include "control/wheeled/limits/limiter_properties.h"
#include "rt/clock.h"

namespace robot_control::bench {

void run(std::uint64_t first, std::uint64_t runs) {
  const std::int64_t start = monotonic_ns();
  const auto failed = static_cast<double>(SeedTrials("limiter", limiter_violation).run(first, runs));
  const double seconds = 1e-9 * static_cast<double>(monotonic_ns() - start);
  const auto sequences = static_cast<double>(runs);
  print("limiter", {{"sequences", sequences, "of 200 cycles", 0, "none", 0},
                    {"sequences failed", failed, "", 0, "none", 0},
                    {"speed", sequences / seconds, "1/s", 0, "none", 0}});
}

}  // namespace robot_control::bench

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: bench_limiter FIRST RUNS\n";
    return 2;
  }
  robot_control::bench::run(std::strtoull(argv[1], nullptr, 10), std::strtoull(argv[2], nullptr, 10));
}

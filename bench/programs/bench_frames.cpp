/// bench_frames PARAMS.yaml [COUNT]: frames and rows between two processes over shared memory, 10⁹ of each.
///
/// The parameters are not used. The run has kRounds parts, each beside a bare memcpy of as many frames in one process.
/// Rates are the median over the parts; torn and reordered frames are counted over all of them. A frame counts as read
/// if a look-up found it; look-ups alternate between the newest frame and an earlier one.

#include <cstring>
#include <iostream>
#include <string>
#include <vector>

#include "bench/programs/rows.h"
#include "support/bus/torture.h"

namespace robot_control::bench {

constexpr std::uint64_t kCount = 1'000'000'000;
constexpr std::uint64_t kRounds = 20;

/// Copies per second.
double memcpy_rate(std::uint64_t copies) {
  const AnonymousMemory<std::array<TortureFrame, kFrameSlots>> slots;
  TortureFrame frame = torture_frame(1);
  std::uint64_t sum = 0;
  const std::int64_t begin_ns = monotonic_ns();
  for (std::uint64_t i = 0; i < copies; ++i) {
    frame.head.cycle = i;
    std::memcpy(&(*slots.get())[i % kFrameSlots], &frame, sizeof frame);
    asm volatile("" : : "r"(slots.get()) : "memory");  // the copy is used
    sum += (*slots.get())[i % kFrameSlots].head.cycle;
  }
  const double seconds = 1e-9 * static_cast<double>(monotonic_ns() - begin_ns);
  return sum == 0 ? 0 : static_cast<double>(copies) / seconds;
}

struct Total {
  std::vector<double> written_rate;
  std::vector<double> read_rate;
  std::vector<double> reference;
  TortureCount count;

  void add(const TortureCount& part, double memcpy_per_second) {
    written_rate.push_back(static_cast<double>(part.written) / part.seconds);
    read_rate.push_back(static_cast<double>(part.read) / part.seconds);
    reference.push_back(memcpy_per_second);
    count.written += part.written;
    count.read += part.read;
    count.distinct += part.distinct;
    count.overtaken += part.overtaken;
    count.torn += part.torn;
    count.reordered += part.reordered;
  }
};

Row rate(const std::string& name, const std::vector<double>& rates, const Total& total) {
  return {name, median(rates), "1/s", median(total.reference), "bare memcpy", median_ratio(rates, total.reference)};
}

Row number(const std::string& name, std::uint64_t value) {
  return {name, static_cast<double>(value), "", 0, "none", 0};
}

int run(std::uint64_t count) {
  Total frames;
  Total rows;
  const std::uint64_t part = count / kRounds;
  for (std::uint64_t round = 1; round <= kRounds; ++round) {
    const double reference = memcpy_rate(part);
    frames.add(torture_frames(part), reference);
    rows.add(torture_ring(part), reference);
    std::cerr << "frames: " << round << " of " << kRounds << " parts, " << frames.count.read << " frames and "
              << rows.count.read << " rows, torn or reordered " << frames.count.errors() + rows.count.errors() << "\n";
  }
  print("frames", {rate("frames published", frames.written_rate, frames), rate("frames read", frames.read_rate, frames),
                   number("frames read in all", frames.count.read), number("different ones", frames.count.distinct),
                   number("look-ups overtaken", frames.count.overtaken), number("frames torn", frames.count.torn),
                   number("frames reordered", frames.count.reordered), rate("rows", rows.read_rate, rows),
                   number("rows in all", rows.count.read), number("rows torn", rows.count.torn),
                   number("rows reordered or lost", rows.count.reordered)});
  return 0;
}

}  // namespace robot_control::bench

int main(int argc, char** argv) {
  if (argc != 2 && argc != 3) {
    std::cerr << "usage: bench_frames PARAMS.yaml [COUNT]\n";
    return 2;
  }
  try {
    return robot_control::bench::run(argc == 3 ? std::stoull(argv[2]) : robot_control::bench::kCount);
  } catch (const std::exception& error) {
    std::cerr << "bench_frames: " << error.what() << "\n";
    return 1;
  }
}

#pragma once
/// The output of a benchmark: one JSON object. Every absolute figure stands beside its ratio to a reference of the same
/// run, measured interleaved.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <limits>
#include <string>
#include <thread>
#include <vector>

namespace robot_control::bench {

struct Row {
  std::string name;
  double value = 0;
  std::string unit;
  double reference = 0;
  std::string reference_name = {};
  double ratio = 0;
};

inline double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The median of the pairwise ratios, which a machine whose speed drifts does not distort.
inline double median_ratio(const std::vector<double>& values, const std::vector<double>& references) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < values.size(); ++i) ratios.push_back(values[i] / references[i]);
  return median(ratios);
}

/// The least of up to 240 rounds of `ratio`, spread over a minute, or the first within `bound`. Another load on the
/// same core halves throughput for seconds, and hardly changes the kernel's latency. A step that costs too much does so
/// in every round; one good round proves that it does not.
template <typename Ratio>
double best_ratio(double bound, const Ratio& ratio) {
  constexpr int kRounds = 240;
  constexpr std::chrono::milliseconds kBetweenRounds(250);
  double best = std::numeric_limits<double>::infinity();
  for (int round = 0; round < kRounds && best > bound; ++round) {
    if (round > 0) std::this_thread::sleep_for(kBetweenRounds);
    best = std::min(best, ratio());
  }
  return best;
}

inline void print(const std::string& bench, const std::vector<Row>& rows) {
  std::printf("{\"bench\": \"%s\", \"rows\": [", bench.c_str());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& row = rows[i];
    std::printf(
        "%s\n  {\"name\": \"%s\", \"value\": %.6g, \"unit\": \"%s\", \"reference\": %.6g, \"reference_name\": \"%s\", "
        "\"ratio\": %.6g}",
        i == 0 ? "" : ",", row.name.c_str(), row.value, row.unit.c_str(), row.reference, row.reference_name.c_str(),
        row.ratio);
  }
  std::printf("\n]}\n");
}

/// The main function of a program that is called with PARAMS.yaml; `run` throws what ends it with an error.
inline int run_with_parameters(int argc, char** argv, void (*run)(const std::string& path)) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: %s PARAMS.yaml\n", argv[0]);
    return 2;
  }
  try {
    run(argv[1]);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", argv[0], error.what());
    return 1;
  }
}

}  // namespace robot_control::bench

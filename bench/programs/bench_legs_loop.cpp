/// bench_legs_loop ROW FIRST SEEDS RATE LATE URDF…: measures robots on legs in the closed loop, on the simulated
/// machine.
///
/// RATE is that of the loop in Hz. Each command is late by LATE cycles, in addition to the one of the bus. The rows of
/// the cost are those of 1000 Hz alone.
///
/// ROW is the name of one of kRows. A value is the worst one of SEEDS seeds from FIRST on. bench/legs.py judges it.

#include <cstdlib>
#include <iterator>

#include "bench/programs/legs/loop_rows.h"

namespace robot_control::bench {

struct NamedRow {
  std::string_view name;
  void (*measure)(const LegModel&, std::uint64_t, WorstValues&);
};

constexpr NamedRow kRows[] = {{"postures", postures},
                              {"pose", body_pose},
                              {"circle", circle},
                              {"stop", stop},
                              {"push", push},
                              {"rest", rest},
                              {"silent", silent},
                              {"hour", hour},
                              {"replayed", replayed},
                              {"cost", cost},
                              {"odometry", odometry},
                              {"contact", contact},
                              {"trot", trot},
                              {"gaits", gaits},
                              {"robots", robots},
                              {"walking_stop", walking_stop},
                              {"switches", switches},
                              {"disturbances", disturbances},
                              {"kicks", kicks},
                              {"push_limits", push_limits},
                              {"faults", faults},
                              {"faults_uneven", faults_uneven},
                              {"walking_hours", walking_hours},
                              {"walking_silent", walking_silent},
                              {"walking_cost", walking_cost},
                              {"walking_replayed", walking_replayed},
                              {"leaning_walks", leaning_walks},
                              {"weak_hips", weak_hips},
                              {"slopes", slopes},
                              {"steps", steps},
                              {"stairs", stairs},
                              {"terrain", terrain}};

int run(int argc, char** argv) {
  const auto found = std::find_if(std::begin(kRows), std::end(kRows),
                                  [&](const NamedRow& row) { return argc > 6 && row.name == argv[1]; });
  if (found == std::end(kRows)) {
    std::fprintf(stderr, "usage: bench_legs_loop ROW FIRST SEEDS RATE LATE URDF...\n");
    return 1;
  }
  const std::uint64_t first = std::strtoull(argv[2], nullptr, 10), seeds = std::strtoull(argv[3], nullptr, 10);
  QuadrupedLoop::given_rate = std::strtod(argv[4], nullptr);
  QuadrupedLoop::given_lateness = std::strtoull(argv[5], nullptr, 10);
  std::vector<Row> rows;
  for (int i = 6; i < argc; ++i) {
    const LegModel model = read_legs(load_description(argv[i]), {}, {});
    WorstValues worst;
    for (std::uint64_t seed = first; seed < first + seeds; ++seed) found->measure(model, seed, worst);
    worst.write(model.name, rows);
  }
  print("legs", rows);
  return 0;
}

}  // namespace robot_control::bench

int main(int argc, char** argv) {
  return robot_control::bench::run(argc, argv);
}

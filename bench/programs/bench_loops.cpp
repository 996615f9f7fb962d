/// bench_loops PARAMS.yaml: many closed loops in threads against the bare physics engine.
///
/// bench_loops PARAMS.yaml count: runs a closed loop for 2,000 cycles, which callgrind counts (bench/loops.py).
///
/// Each round runs 64 loops for 20 cycles, some steps with one thread and then with two. The reference is mj_step of as
/// many states of the same model with native friction, in the same threads. The figures are cycles per second of all
/// loops, median over the rounds, and the ratio to the bare ones of the same round.

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "bench/programs/rows.h"
#include "drivers/mujoco/model/mujoco_model.h"
#include "machine/wheeled/drive_train.h"
#include "rt/clock.h"
#include "simulation/closed_loops.h"

namespace robot_control::bench {
namespace {

constexpr std::size_t kLoops = 64;
constexpr std::uint64_t kCycles = 20;
constexpr int kSteps = 5, kRounds = 31;
constexpr int kCounted = 2000;
constexpr Twist kCurve{.linear = {0.5, 0, 0}, .angular = {0, 0, 0.2}};

/// States of one model, whose wheels a constant torque drives.
class Bare {
 public:
  Bare(const Parameters& parameters, std::size_t threads)
      : model_(compiled(parameters)), pool_(threads), data_(kLoops) {
    for (MujocoData& data : data_) data = set_down(model_);
  }
  void step() {
    pool_.for_each(data_.size(), [&](std::size_t i) {
      constexpr double kTorque = 0.05;  // N·m
      for (std::uint64_t cycle = 0; cycle < kCycles; ++cycle) {
        for (const int address : model_.joint_velocity) data_[i]->qfrc_applied[address] = kTorque;
        for (int step = 0; step < model_.substeps; ++step) mj_step(model_.model.get(), data_[i].get());
      }
    });
  }

 private:
  static MujocoModel compiled(const Parameters& parameters) {
    MujocoPlantParameters native = parameters.plant;
    native.tyre = TyreModel::kNative;
    return compile_model(read_drive_train(load_description(parameters.urdf), parameters.robot), native,
                         parameters.loop.period());
  }

  MujocoModel model_;
  WorkerPool pool_;
  std::vector<MujocoData> data_;
};

/// The loops drive a curve.
class Closed {
 public:
  Closed(const Parameters& parameters, std::size_t threads)
      : loops_(parameters, std::vector<std::uint64_t>(kLoops, 1), threads) {}
  void step() { loops_.step(kCycles, twists_, {}, {}); }

 private:
  ClosedLoops loops_;
  std::vector<Twist> twists_ = std::vector<Twist>(kLoops, kCurve);
};

template <class Stepped>
double rate(Stepped& stepped) {
  const std::int64_t start = monotonic_ns();
  for (int k = 0; k < kSteps; ++k) stepped.step();
  return static_cast<double>(kSteps * kLoops * kCycles) * 1e9 / static_cast<double>(monotonic_ns() - start);
}

std::vector<double> quotients(const std::vector<double>& values, const std::vector<double>& references) {
  std::vector<double> all;
  for (std::size_t i = 0; i < values.size(); ++i) all.push_back(values[i] / references[i]);
  return all;
}

void run(const std::string& path) {
  const Parameters parameters = read_parameters(path);
  Bare bare_one(parameters, 1), bare_two(parameters, 2);
  Closed one(parameters, 1), two(parameters, 2);
  std::vector<double> bare_ones, bare_twos, ones, twos;
  for (int round = 0; round < kRounds; ++round) {
    bare_ones.push_back(rate(bare_one));
    ones.push_back(rate(one));
    bare_twos.push_back(rate(bare_two));
    twos.push_back(rate(two));
  }
  const std::string unit = "cycles per s";
  const std::string by_one = "bare mj_step, 1 thread", by_two = "bare mj_step, 2 threads";
  const std::vector<double> scaling = quotients(twos, ones), bare_scaling = quotients(bare_twos, bare_ones);
  print("loops",
        {{by_one, median(bare_ones), unit, median(bare_ones), "itself", 1},
         {by_two, median(bare_twos), unit, median(bare_twos), "itself", 1},
         {"ClosedLoops, 1 thread", median(ones), unit, median(bare_ones), by_one, median_ratio(ones, bare_ones)},
         {"ClosedLoops, 2 threads", median(twos), unit, median(bare_twos), by_two, median_ratio(twos, bare_twos)},
         {"scaling from 1 thread to 2", median(scaling), "", median(bare_scaling), "that of bare mj_step",
          median_ratio(scaling, bare_scaling)}});
}

/// Callgrind counts what happens in this function.
[[gnu::noinline]] void counted_cycles(ClosedLoop& loop) {
  for (int k = 0; k < kCounted; ++k) {
    if (k % 500 == 0) loop.command(kCurve);
    loop.step();
  }
}

void count(const std::string& path) {
  ClosedLoop loop(read_parameters(path));
  counted_cycles(loop);
}

}  // namespace
}  // namespace robot_control::bench

int main(int argc, char** argv) {
  using namespace robot_control::bench;
  const bool counts = argc == 3 && std::string(argv[2]) == "count";
  return run_with_parameters(counts ? 2 : argc, argv, counts ? count : run);
}

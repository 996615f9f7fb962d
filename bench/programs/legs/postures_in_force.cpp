#include "bench/programs/legs/loop_rows.h"
#include "support/robots/quadruped_trials.h"

namespace robot_control::bench {

void leaning_walks(const LegModel& model, std::uint64_t seed, WorstValues& worst) {
  const LeaningWalk walk = leaning_walk(model, walking_parameters(seed));
  worst.add("stopped walks with poses", walk.stopped ? 1 : 0, "runs");
  worst.add("joint speed of walks with poses", walk.joint_speed, "of the limit");
  worst.add("joint beyond its range in walks with poses", std::max(0.0, walk.beyond_range), "rad");
  if (walk.stopped || walk.joint_speed > 1 || walk.beyond_range > 0)
    std::fprintf(stderr, "%s, seed %llu: %s, joint speed %.3f, range %.4f\n", model.name.c_str(),
                 static_cast<unsigned long long>(seed), walk.causes.c_str(), walk.joint_speed, walk.beyond_range);
}

void weak_hips(const LegModel& model, std::uint64_t seed, WorstValues& worst) {
  const LeaningWalk walk = leaning_walk(with_weak_hips(model), walking_parameters(seed), false);
  worst.add("stopped walks with weak hips", walk.stopped ? 1 : 0, "runs");
  if (walk.stopped)
    std::fprintf(stderr, "%s, seed %llu: %s\n", model.name.c_str(), static_cast<unsigned long long>(seed),
                 walk.causes.c_str());
}

void slopes(const LegModel& model, std::uint64_t seed, WorstValues& worst) {
  constexpr double kPhases = 0.38 / 5;  // s, a fifth of a period of the trot
  const auto judge = [&](const std::string& on, double heading, const SlopeTrial& trial) {
    worst.add("neither stands nor refuses " + on, trial.stands || trial.refuses ? 0 : 1, "runs");
    worst.add("turned over " + on, trial.turned_over ? 1 : 0, "runs");
    worst.average("stops " + on, trial.stopped ? 1 : 0, "of the runs");
    worst.average("stands " + on, trial.stands ? 1 : 0, "of the runs");
    if (!trial.stands || trial.stopped || trial.turned_over)
      std::fprintf(stderr, "%s %s, seed %llu, heading %.0f deg: %s %s, tilt %.3f\n", model.name.c_str(), on.c_str(),
                   static_cast<unsigned long long>(seed), heading * 180 / kPi, trial.refuses ? "refuses" : "",
                   trial.causes.c_str(), trial.tilt);
  };
  for (const double degrees : {10, 15, 18, 20, 25}) {
    const double heading = static_cast<double>(seed % 8) * kPi / 4, slope = degrees * kPi / 180;
    const std::string on = "on " + std::to_string(static_cast<int>(degrees)) + " deg";
    judge(on, heading, stand_up_on(model, walking_parameters(seed), slope, heading));
    Parameters parameters = walking_parameters(seed);
    parameters.plant.sensor_errors = ErrorLevel::kField;
    judge("walking " + on, heading,
          walk_on(model, parameters, slope, heading, static_cast<double>(seed / 8 % 5) * kPhases));
  }
}

}  // namespace robot_control::bench

/// bench_legs URDF…: measures kinematics and equations of motion of robots on four legs.
///
/// It measures per robot how exactly `inverse` leads back to 10⁵ reachable feet, and how far mass matrix and bias are
/// from MuJoCo's in 10³ random states. The times are those of the fastest round; the time of one sine and one cosine is
/// that of the same run.

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "bench/programs/rows.h"
#include "machine/legs/leg_dynamics.h"
#include "machine/legs/mujoco_equations.h"
#include "rt/clock.h"
#include "support/allocation_guard.h"

namespace robot_control::bench {

constexpr int kFeet = 100000;
constexpr int kStates = 1000;
constexpr int kRounds = 21;
constexpr int kCalls = 20000;
constexpr double kTurn = 3.14159265358979323846;

volatile double sink = 0;

template <class Call>
double nanoseconds(Call call) {
  const std::int64_t start = monotonic_ns();
  for (int i = 0; i < kCalls; ++i) call(static_cast<std::size_t>(i));
  return static_cast<double>(monotonic_ns() - start) / kCalls;
}

class Robot {
 public:
  explicit Robot(const std::string& path) : model_(read_legs(load_description(path), {}, {})), dynamics_(model_) {
    std::mt19937_64 random(31);
    for (int i = 0; i < kFeet; ++i) {
      const LegKinematics& leg = model_.legs[static_cast<std::size_t>(i) % kLegs].kinematics;
      LegAngles angles;
      for (std::size_t n = 0; n < kLegJoints; ++n) {
        std::uniform_real_distribution<double> draw(std::max(leg.range(n).lower, -kTurn),
                                                    std::min(leg.range(n).upper, kTurn));
        angles[static_cast<Eigen::Index>(n)] = draw(random);
      }
      angles_.push_back(angles);
      feet_.push_back(leg.position(angles));
    }
  }

  void measure(std::vector<Row>& rows) {
    double worst = 0;
    int unreached = 0;
    const AllocationGuard guard;
    for (std::size_t i = 0; i < feet_.size(); ++i) {
      const LegKinematics& leg = model_.legs[i % kLegs].kinematics;
      const LegSolution solution = leg.inverse(feet_[i]);
      if (solution.reach != FootReach::kReached) ++unreached;
      worst = std::max(worst, (leg.position(solution.angles) - feet_[i]).norm());
    }
    const auto allocations = static_cast<double>(guard.count());
    const EquationsDifference difference = difference_from_mujoco(model_, kStates);
    const auto add = [&](const char* what, double value, const char* unit) {
      rows.push_back({.name = model_.name + " " + what, .value = value, .unit = unit});
    };
    add("round trip of reachable feet", worst, "m");
    add("reachable feet not reached", unreached, "feet");
    add("allocations", allocations, "calls");
    add("mass matrix against MuJoCo", difference.mass, "of its norm");
    add("bias against MuJoCo", difference.bias, "of its norm");
    std::vector<double> reference, jacobian, inverse, equations;
    LeggedMotion motion;
    LeggedEquations result;
    for (int round = 0; round < kRounds; ++round) {
      reference.push_back(
          nanoseconds([&](std::size_t i) { sink = std::sin(angles_[i][0]) + std::cos(angles_[i][0]); }));
      jacobian.push_back(nanoseconds([&](std::size_t i) {
        Eigen::Vector3d foot;
        sink = model_.legs[i % kLegs].kinematics.jacobian(angles_[i], foot)(1, 1) + foot.x();
      }));
      inverse.push_back(
          nanoseconds([&](std::size_t i) { sink = model_.legs[i % kLegs].kinematics.inverse(feet_[i]).angles[2]; }));
      equations.push_back(nanoseconds([&](std::size_t i) {
        for (std::size_t n = 0; n < kLegsJoints; ++n) motion.angles[n] = angles_[i][static_cast<Eigen::Index>(n % 3)];
        dynamics_.step(motion, result);
        sink = result.bias[7];
      }));
    }
    const auto fastest = [](const std::vector<double>& times) {
      return *std::min_element(times.begin(), times.end()) / 1000;
    };
    add("sine and cosine of an angle", fastest(reference), "us");
    add("position and Jacobian of a leg", fastest(jacobian), "us");
    add("inverse of a leg", fastest(inverse), "us");
    add("mass matrix and bias", fastest(equations), "us");
  }

 private:
  LegModel model_;
  LegDynamics dynamics_;
  std::vector<LegAngles> angles_;
  std::vector<Eigen::Vector3d> feet_;
};

}  // namespace robot_control::bench

int main(int count, char** arguments) {
  std::vector<robot_control::bench::Row> rows;
  for (int i = 1; i < count; ++i) robot_control::bench::Robot(arguments[i]).measure(rows);
  robot_control::bench::print("legs", rows);
}

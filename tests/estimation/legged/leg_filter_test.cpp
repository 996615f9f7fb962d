#include "estimation/legged/leg_filter.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <random>

#include "estimation/legged/small_turn.h"
#include "machine/gravity.h"
#include "support/allocation_guard.h"

namespace robot_control::tests {

using Eigen::Quaterniond;
using Eigen::Vector3d;

Vector3d vector_of(const Vector3& v) {
  return {v[0], v[1], v[2]};
}

/// A body that sways and turns on four feet, and the filter that follows it. The densities of all errors are those that
/// the filter assumes.
struct Walk {
  static constexpr double kPeriod = 0.001;  // s
  static constexpr double kCreep = 0.003;   // m/√s
  explicit Walk(std::uint64_t seed, bool errors = true) : random(seed), noisy(errors) {
    state.covariance = {};
    LegFilter filter(state);
    filter.begin(Quaterniond::Identity(), Vector3d::Zero(), 0, 0);
    for (int i = 0; i < 3; ++i) {
      filter.set_variance(LegFilter::kRateBias + i, noisy ? 1e-4 : 0);
      filter.set_variance(LegFilter::kForceBias + i, noisy ? 1e-4 : 0);
    }
    if (noisy) rate_bias = 0.01 * normal(), force_bias = 0.01 * normal();
    for (std::size_t foot = 0; foot < kLegs; ++foot) land(foot);
  }

  Vector3d normal() { return {draw(random), draw(random), draw(random)}; }
  Vector3d noise(double density) {
    return noisy ? Vector3d(density / std::sqrt(kPeriod) * normal()) : Vector3d::Zero();
  }
  Vector3d place(std::size_t foot) const { return turn.conjugate() * (feet[foot] - position); }
  Vector3d seen(std::size_t foot) { return place(foot) + (noisy ? LegFilter::kFoot : 0) * normal(); }
  void land(std::size_t foot) {
    feet[foot] = position + turn * Vector3d(foot < 2 ? 0.2 : -0.2, foot % 2 == 0 ? 0.15 : -0.15, -0.3);
    LegFilter(state).land(foot, seen(foot));
  }

  void step() {
    time += kPeriod;
    const Vector3d rate(0.3 * std::cos(20 * time), 0.3 * std::sin(17 * time), 0.5);
    const Vector3d acceleration(2 * std::cos(15 * time), std::sin(13 * time), 3 * std::cos(30 * time));
    const Quaterniond middle = turn * turned_by(kPeriod / 2 * rate);
    const Vector3d force = middle.conjugate() * (acceleration + Vector3d(0, 0, kGravity));
    turn = (turn * turned_by(kPeriod * rate)).normalized();
    position += kPeriod * (velocity + kPeriod / 2 * acceleration);
    velocity += kPeriod * acceleration;
    for (Vector3d& foot : feet) foot += kPeriod * noise(kCreep);
    LegFilter filter(state);
    filter.predict(rate + rate_bias + noise(LegFilter::kGyroNoise),
                   force + force_bias + noise(LegFilter::kAccelerometerNoise),
                   {Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero()}, kCreep, kPeriod);
    stand(filter);
    filter.finish();
  }
  void stand(LegFilter& filter) {
    for (std::size_t foot = 0; foot < kLegs; ++foot) filter.hold(foot);
    for (std::size_t foot = 0; foot < kLegs; ++foot)
      filter.stand(foot, seen(foot) + (foot == 0 ? jump : Vector3d::Zero()));
  }
  /// Measures the gyro's bias.
  void learn_bias() {
    LegFilter filter(state);
    stand(filter);
    filter.rest(rate_bias, 1e-6);
    filter.finish();
  }
  void run(int cycles, int stance) {
    for (int k = 1; k <= cycles; ++k) {
      step();
      if (k % stance == 0) land(static_cast<std::size_t>(k / stance) % kLegs);
    }
  }

  Vector3d speed_error() const { return vector_of(state.velocity) - velocity; }
  Vector3d place_error() const { return vector_of(state.position) - position; }
  Eigen::Map<const LegFilter::Covariance> covariance() const {
    return Eigen::Map<const LegFilter::Covariance>(state.covariance.data());
  }

  std::mt19937_64 random;
  std::normal_distribution<double> draw;
  bool noisy;
  double time = 0;
  Quaterniond turn = Quaterniond::Identity();
  Vector3d position = Vector3d::Zero(), velocity = Vector3d::Zero();
  Vector3d rate_bias = Vector3d::Zero(), force_bias = Vector3d::Zero(), jump = Vector3d::Zero();
  std::array<Vector3d, kLegs> feet;
  LegFilter::State state;
};

TEST(LegFilter, FollowsAnExactMotion) {
  Walk walk(1, false);
  walk.run(2000, 100);
  EXPECT_LE(walk.place_error().norm(), 1e-9);
  EXPECT_LE(walk.speed_error().norm(), 1e-9);
}

/// Squared errors of pose and speed, by their covariances.
std::array<double, 2> squared_errors(const Walk& walk) {
  const Eigen::AngleAxisd turned(quaternion_of(walk.state.attitude) * walk.turn.conjugate());
  Eigen::Matrix<double, 6, 1> error;
  error << turned.angle() * turned.axis(), walk.place_error();
  Eigen::Matrix<double, 6, 6> P;
  constexpr int kEntries[2] = {LegFilter::kTurn, LegFilter::kPlace};
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) P.block<3, 3>(3 * i, 3 * j) = walk.covariance().block<3, 3>(kEntries[i], kEntries[j]);
  const Eigen::Matrix3d Q = walk.covariance().block<3, 3>(LegFilter::kSpeed, LegFilter::kSpeed);
  const Vector3d speed = vector_of(walk.state.velocity) - turned * walk.velocity;
  return {error.dot(P.ldlt().solve(error)), speed.dot(Q.ldlt().solve(speed))};
}

/// A way of 7 m, too, after which the bias of the gyro is learned: it turns the body, but not the way behind it.
TEST(LegFilter, IsAsCertainAsItIsRight) {
  constexpr int kRuns = 40;
  double pose = 0, speed = 0, learned = 0;
  for (int seed = 0; seed < kRuns; ++seed) {
    Walk walk(static_cast<std::uint64_t>(seed));
    walk.velocity.x() = walk.state.velocity[0] = seed % 2 == 0 ? 0 : 5;
    walk.run(1500, 100);
    const auto [of_pose, of_speed] = squared_errors(walk);
    pose += of_pose / kRuns;
    speed += of_speed / kRuns;
    walk.learn_bias();
    learned += squared_errors(walk)[0] / kRuns;
  }
  // A mean of 40 χ² of 6 and of 3 degrees has the deviations 0.55 and 0.39.
  EXPECT_NEAR(pose, 6, 4 * 0.55);
  EXPECT_NEAR(speed, 3, 4 * 0.39);
  EXPECT_NEAR(learned, 6, 4 * 0.55);
}

TEST(LegFilter, LetsAFootThatJumpsMoveItselfAlone) {
  Walk walk(1, false);
  walk.run(500, 100);
  walk.jump = {0.03, 0, 0};
  double largest = 0;
  for (int k = 0; k < 50; ++k) {
    walk.step();
    largest = std::max(largest, walk.speed_error().norm());
  }
  EXPECT_LE(largest, 0.02);  // 0.03 m in one cycle are 30 m/s
  EXPECT_LE(walk.place_error().norm(), 1e-3);
}

/// A bias of the gyro that is learned after a way of 10 m turns the body by 0.04 rad. It turns about the feet that
/// stand, 0.3 m behind it. The gain would move it by 0.2 m.
TEST(LegFilter, KeepsItsPlaceWhereItsYawIsCorrected) {
  Walk walk(3);
  walk.velocity.x() = walk.state.velocity[0] = 5;
  walk.run(2000, 50);
  const Vector3d place = vector_of(walk.state.position);
  const Quaterniond turn = quaternion_of(walk.state.attitude);
  walk.rate_bias = vector_of(walk.state.rate_bias) + Vector3d(0, 0, 0.02);
  walk.learn_bias();
  EXPECT_NEAR(quaternion_of(walk.state.attitude).angularDistance(turn), 0.04, 0.005);
  const double moved = (vector_of(walk.state.position) - place).head<2>().norm();
  EXPECT_GT(moved, 0.005);
  EXPECT_LT(moved, 0.03);
}

TEST(LegFilter, TurnsOdomBelowTheBody) {
  Walk walk(1);
  walk.run(300, 100);
  const LegFilter::State before = walk.state;
  LegFilter(walk.state).turn(1);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(1, Vector3d::UnitZ()).toRotationMatrix();
  EXPECT_LE((vector_of(walk.state.velocity) - turn * vector_of(before.velocity)).norm(), 1e-12);
  EXPECT_LE((vector_of(walk.state.feet[2]) - turn * vector_of(before.feet[2])).norm(), 1e-12);
  const auto block = [](const LegFilter::State& state, int row, int column) -> Eigen::Matrix3d {
    return Eigen::Map<const LegFilter::Covariance>(state.covariance.data()).block<3, 3>(row, column);
  };
  const Eigen::Matrix3d both = turn * block(before, LegFilter::kSpeed, LegFilter::kFeet) * turn.transpose();
  EXPECT_LE((block(walk.state, LegFilter::kSpeed, LegFilter::kFeet) - both).norm(), 1e-12);
  EXPECT_EQ(block(walk.state, LegFilter::kRateBias, LegFilter::kRateBias),
            block(before, LegFilter::kRateBias, LegFilter::kRateBias));
}

TEST(LegFilter, AllocatesNothing) {
  Walk walk(1);
  const AllocationGuard guard;
  walk.run(10, 5);
  LegFilter filter(walk.state);
  filter.turn(0.1);
  filter.rest(Vector3d::Zero(), 0.01);
  filter.stop(0.01);
  filter.finish();
  EXPECT_EQ(guard.count(), 0u);
}

}  // namespace robot_control::tests

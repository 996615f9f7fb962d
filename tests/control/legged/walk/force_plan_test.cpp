#include "control/legged/walk/force_plan.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <random>

#include "control/legged/posture/ground_slope.h"
#include "control/legged/walk/foothold.h"
#include "control/legged/walk/gait_table.h"
#include "machine/gravity.h"
#include "support/allocation_guard.h"

namespace robot_control::tests {

constexpr double kMass = 12.7;           // kg
constexpr double kHeight = 0.3;          // m, of the centre of gravity
constexpr double kForceRounding = 1e-8;  // N, of forces of 100 N from well-conditioned equations

const Eigen::Matrix3d kInertia = Eigen::Vector3d(0.07, 0.21, 0.24).asDiagonal();

ForcePlanParameters parameters() {
  return force_plan_parameters(kMass, kInertia, kReferenceLeg);
}

std::array<Eigen::Vector2d, kLegs> nominal_feet() {
  return {Eigen::Vector2d(0.19, 0.13), Eigen::Vector2d(0.19, -0.13), Eigen::Vector2d(-0.19, 0.13),
          Eigen::Vector2d(-0.19, -0.13)};
}

/// A robot that stands at its target with all feet, for the whole horizon.
ForcePlanInput standing() {
  ForcePlanInput input;
  for (std::size_t leg = 0; leg < kLegs; ++leg) input.feet[leg] << nominal_feet()[leg], -kHeight;
  input.steps = 5;
  for (auto& step : input.bears) step.fill(true);
  return input;
}

TEST(ForcePlan, StandingFeetCarryTheWeightInEqualParts) {
  ForcePlan plan(parameters());
  const ForcePlanResult result = plan.step(standing());
  ASSERT_EQ(result.outcome, QpOutcome::kSolved);
  const double share = kMass * kGravity / kLegs;
  for (const Eigen::Vector3d& force : result.forces) {
    EXPECT_LT((force - Eigen::Vector3d(0, 0, share)).norm(), kForceRounding);
  }
}

/// The state after each step, one below the other, that these forces cause by explicit integration.
Eigen::VectorXd integrated(const ForcePlanInput& input, double step, const Eigen::VectorXd& forces) {
  Eigen::VectorXd states(12 * static_cast<Eigen::Index>(input.steps));
  PlanVector place = input.place, speed = input.speed, target = input.target;
  const auto target_speed = [&](double time) {
    PlanVector turned = input.target_speed;
    turned.segment<2>(3) = Eigen::Rotation2Dd(time * turned[2]) * turned.segment<2>(3);
    return turned;
  };
  Eigen::Index next = 0;
  for (std::size_t i = 0; i < input.steps; ++i) {
    const auto number = static_cast<double>(i);
    const PlanVector moved = step * target_speed((number + 0.5) * step);
    const Eigen::Vector3d centre = (target + moved / 2 - input.target).tail<3>();
    target += moved;
    PlanVector acceleration = PlanVector::Zero();
    acceleration[5] = -kGravity;
    for (std::size_t leg = 0; leg < kLegs; ++leg) {
      if (!input.bears[i][leg]) continue;
      const Eigen::Vector3d force = forces.segment<3>(next);
      next += 3;
      acceleration.head<3>() += kInertia.inverse() * (input.feet[leg] - centre).cross(force);
      acceleration.tail<3>() += force / kMass;
    }
    place += step * speed + step * step / 2 * acceleration;
    speed += step * acceleration;
    const auto row = static_cast<Eigen::Index>(12 * i);
    states.segment<6>(row) = place - target;
    states.segment<6>(row + 6) = speed - target_speed((number + 1) * step);
  }
  return states;
}

TEST(ForcePlan, MinimisesTheCostOfTheIntegratedMotion) {
  ForcePlanInput input = standing();
  input.place << 0.01, -0.02, 0.03, 0.002, -0.003, 0.001;
  input.speed << 0.02, 0.01, -0.03, 0.51, 0.02, 0.01;
  input.target_speed << 0, 0, 0.4, 0.5, 0.1, 0;
  for (std::size_t i = 0; i < input.steps; ++i)  // three feet in turn
    for (std::size_t leg = 0; leg < kLegs; ++leg) input.bears[i][leg] = leg != i % kLegs;
  ForcePlanParameters unbounded = parameters();
  unbounded.friction = 100;
  unbounded.smallest = -1e4;
  unbounded.largest = 1e4;
  const double step = unbounded.horizon / static_cast<double>(input.steps);
  const Eigen::Index size = 3 * 3 * static_cast<Eigen::Index>(input.steps);
  const Eigen::VectorXd free = integrated(input, step, Eigen::VectorXd::Zero(size));
  Eigen::MatrixXd effect(free.size(), size);
  for (Eigen::Index i = 0; i < size; ++i)
    effect.col(i) = integrated(input, step, Eigen::VectorXd::Unit(size, i)) - free;
  Eigen::VectorXd weights(free.size());
  for (Eigen::Index i = 0; i < free.size(); i += 12)
    weights.segment<12>(i) << unbounded.place_weight, unbounded.speed_weight;
  Eigen::MatrixXd hessian = effect.transpose() * weights.asDiagonal() * effect;
  hessian.diagonal().array() += unbounded.force_weight;
  Eigen::VectorXd share = Eigen::VectorXd::Zero(size);
  for (Eigen::Index i = 2; i < size; i += 3) share[i] = kMass * kGravity / 3;
  const Eigen::VectorXd expected =
      hessian.ldlt().solve(unbounded.force_weight * share - effect.transpose() * weights.asDiagonal() * free);
  for (Eigen::Index i = 2; i < size; i += 3) ASSERT_GT(expected[i], 1) << "the pyramid would bend the solution";

  ForcePlan plan(unbounded);
  const ForcePlanResult result = plan.step(input);
  ASSERT_EQ(result.outcome, QpOutcome::kSolved);
  EXPECT_EQ(result.forces[0], Eigen::Vector3d::Zero().eval());  // this foot swings in the first step
  for (std::size_t leg = 1; leg < kLegs; ++leg)
    EXPECT_LT((result.forces[leg] - expected.segment<3>(static_cast<Eigen::Index>(3 * (leg - 1)))).norm(),
              kForceRounding);
}

// Angles and weights stay; times grow with the root of the length.
TEST(ForcePlan, IsTheSameForAHeavierAndLargerRobot) {
  constexpr double kHeavier = 3, kLarger = 4, kSlower = 2;
  ForcePlanInput input = standing();
  input.place << 0.01, -0.02, 0.03, 0.002, -0.003, 0.001;
  input.speed << 0.02, 0.01, -0.03, 0.51, 0.02, 0.01;
  input.target_speed << 0, 0, 0.4, 0.5, 0.1, 0;
  ForcePlanInput larger = input;
  larger.place.tail<3>() *= kLarger;
  larger.speed.head<3>() /= kSlower;
  larger.speed.tail<3>() *= kLarger / kSlower;
  larger.target_speed.head<3>() /= kSlower;
  larger.target_speed.tail<3>() *= kLarger / kSlower;
  for (Eigen::Vector3d& foot : larger.feet) foot *= kLarger;
  const ForcePlanResult result = ForcePlan(parameters()).step(input);
  const ForcePlanResult scaled =
      ForcePlan(
          force_plan_parameters(kHeavier * kMass, kHeavier * kLarger * kLarger * kInertia, kLarger * kReferenceLeg))
          .step(larger);
  for (std::size_t leg = 0; leg < kLegs; ++leg)
    EXPECT_LT((scaled.forces[leg] - kHeavier * result.forces[leg]).norm(), kForceRounding) << leg;
}

TEST(ForcePlan, ForcesStayWithinFrictionAndBoundsAndReachThem) {
  constexpr double kFriction = 0.4, kSmallest = 0.016 * kMass * kGravity, kLargest = 1.45 * kMass * kGravity;
  ForcePlan plan(parameters());
  double grip = 0, smallest = kLargest, largest = 0;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> number(-1, 1);
  for (int trial = 0; trial < 200; ++trial) {
    ForcePlanInput input = standing();
    for (Eigen::Index i = 0; i < 6; ++i) input.place[i] = 0.2 * number(random), input.speed[i] = 2 * number(random);
    const ForcePlanResult result = plan.step(input);
    ASSERT_EQ(result.outcome, QpOutcome::kSolved) << trial;
    for (const Eigen::Vector3d& force : result.forces) {
      grip = std::max(grip, force.head<2>().cwiseAbs().maxCoeff() / force.z());
      smallest = std::min(smallest, force.z());
      largest = std::max(largest, force.z());
    }
  }
  EXPECT_NEAR(grip, kFriction, kForceRounding);
  EXPECT_NEAR(smallest, kSmallest, kForceRounding);
  EXPECT_NEAR(largest, kLargest, kForceRounding);
}

TEST(ForcePlan, ForcesOnASlopeStayWithinTheFrictionThatItNeeds) {
  constexpr double kSlope = 0.36;  // 20°
  ForcePlan plan(parameters());
  double grip = 0;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> number(-1, 1);
  for (int trial = 0; trial < 200; ++trial) {
    ForcePlanInput input = standing();
    input.ground = ground_axes(kSlope, 0);
    for (Eigen::Index i = 0; i < 6; ++i) input.place[i] = 0.2 * number(random), input.speed[i] = 2 * number(random);
    const ForcePlanResult result = plan.step(input);
    ASSERT_EQ(result.outcome, QpOutcome::kSolved) << trial;
    for (const Eigen::Vector3d& force : result.forces) {
      const Eigen::Vector3d along = input.ground.transpose() * force;
      grip = std::max(grip, along.head<2>().cwiseAbs().maxCoeff() / along.z());
    }
  }
  EXPECT_NEAR(grip, kSlopeGrip * kSlope, kForceRounding);
}

TEST(ForcePlan, CutsTheHorizonWhereTheForcesAreTooMany) {
  ForcePlanInput input = standing();
  input.steps = kPlanSteps;
  ForcePlan plan(parameters());
  EXPECT_EQ(plan.step(input).steps, kPlanVariables / (3 * kLegs));
}

TEST(ForcePlan, WithoutAFootOnTheGroundThereAreNoForces) {
  ForcePlanInput input = standing();
  for (auto& step : input.bears) step.fill(false);
  ForcePlan plan(parameters());
  const ForcePlanResult result = plan.step(input);
  EXPECT_EQ(result.outcome, QpOutcome::kSolved);
  for (const Eigen::Vector3d& force : result.forces) EXPECT_EQ(force, Eigen::Vector3d::Zero().eval());
}

TEST(ForcePlan, ReportsAStateThatIsNotFinite) {
  ForcePlanInput input = standing();
  input.speed[0] = std::nan("");
  ForcePlan plan(parameters());
  const ForcePlanResult result = plan.step(input);
  EXPECT_EQ(result.outcome, QpOutcome::kNotFinite);
  for (const Eigen::Vector3d& force : result.forces) EXPECT_EQ(force, Eigen::Vector3d::Zero().eval());
}

TEST(ForcePlan, AllocatesNothing) {
  if (!AllocationGuard::kCounts) GTEST_SKIP() << "the sanitizer owns the allocator";
  ForcePlan plan(parameters());
  const AllocationGuard guard;
  plan.step(standing());
  EXPECT_EQ(guard.count(), 0u);
}

/// A rigid body on legs without mass, whose feet stand where they land.
class RigidWalker {
 public:
  RigidWalker(const Gait& gait, const Eigen::Vector3d& request) : gait_(gait), request_(request), plan_(parameters()) {
    position_.z() = kHeight;
    for (std::size_t leg = 0; leg < kLegs; ++leg) feet_[leg] << nominal_feet()[leg], 0;
  }

  void step() {
    if (cycle_ % 10 == 0) forces_ = planned();
    ++cycle_;
    const double before = phase_;
    phase_ += kPeriod / gait_.period;
    phase_ -= std::floor(phase_);
    for (std::size_t leg = 0; leg < kLegs; ++leg)
      if (gait_.bears(leg, phase_) && !gait_.bears(leg, before)) feet_[leg] << foothold_of(leg, 0), 0;
    Eigen::Vector3d force(0, 0, -kMass * kGravity), moment = Eigen::Vector3d::Zero();
    for (std::size_t leg = 0; leg < kLegs; ++leg) {
      if (!gait_.bears(leg, phase_)) continue;
      force += forces_[leg];
      moment += (feet_[leg] - position_).cross(forces_[leg]);
    }
    velocity_ += kPeriod / kMass * force;
    position_ += kPeriod * velocity_;
    follow_request();
    const Eigen::Matrix3d inertia = attitude_ * kInertia * attitude_.transpose();
    rate_ += kPeriod * inertia.ldlt().solve(moment - rate_.cross(inertia * rate_));
    const Eigen::Vector3d angle = kPeriod * rate_;
    attitude_ = Eigen::AngleAxisd(angle.norm(), angle.stableNormalized()) * attitude_;
    largest_tilt_ = std::max(largest_tilt_, std::acos(std::min(1.0, attitude_(2, 2))));
  }

  Eigen::Vector3d velocity() const { return turn().transpose() * velocity_; }
  double yaw_rate() const { return rate_.z(); }
  double height() const { return position_.z(); }
  double largest_tilt() const { return largest_tilt_; }
  int failures() const { return failures_; }

 private:
  static constexpr double kPeriod = 0.001;  // s
  const Eigen::Vector2d kNear{0.08, 0.08};  // m

  /// The target moves as requested, and never far from the robot.
  void follow_request() {
    target_ += kPeriod * turn().topLeftCorner<2, 2>() * request_.head<2>();
    target_ = target_.cwiseMax(position_.head<2>() - kNear).cwiseMin(position_.head<2>() + kNear);
    heading_ += kPeriod * request_.z();
    heading_ = yaw() + std::clamp(std::remainder(heading_ - yaw(), 2 * M_PI), -0.3, 0.3);
  }

  double yaw() const { return std::atan2(attitude_(1, 0), attitude_(0, 0)); }
  Eigen::Matrix3d turn() const { return Eigen::AngleAxisd(yaw(), Eigen::Vector3d::UnitZ()).toRotationMatrix(); }

  Eigen::Vector2d foothold_of(std::size_t leg, double until_landing) const {
    FootholdInput input{.nominal = nominal_feet()[leg],
                        .requested = request_.head<2>(),
                        .yaw_rate = request_.z(),
                        .until_landing = until_landing,
                        .stance_time = gait_.stance_time(),
                        .height = kHeight};
    input.measured = velocity().head<2>();
    return position_.head<2>() + turn().topLeftCorner<2, 2>() * foothold(input);
  }

  std::array<Eigen::Vector3d, kLegs> planned() {
    const Eigen::Matrix3d level = turn().transpose();
    ForcePlanInput input;
    const Eigen::Matrix3d tilted = level * attitude_;
    input.place << std::atan2(tilted(2, 1), tilted(2, 2)), std::asin(-tilted(2, 0)), 0, 0, 0, position_.z();
    input.speed << level * rate_, level * velocity_;
    const Eigen::Vector2d beyond = level.topLeftCorner<2, 2>() * (target_ - position_.head<2>());
    input.target << 0, 0, std::remainder(heading_ - yaw(), 2 * M_PI), beyond, kHeight;
    input.target_speed << 0, 0, request_.z(), request_.x(), request_.y(), 0;
    input.steps = std::min(kPlanSteps, static_cast<std::size_t>(5 / gait_.duty));
    for (std::size_t leg = 0; leg < kLegs; ++leg) {
      const double until = gait_.bears(leg, phase_) ? 0 : (1 - gait_.swung(leg, phase_)) * gait_.swing_time();
      Eigen::Vector3d foot = feet_[leg];
      if (until > 0) foot << foothold_of(leg, until), 0;
      input.feet[leg] = level * (foot - position_);
      for (std::size_t i = 0; i < input.steps; ++i) {
        const double ahead = (static_cast<double>(i) + 0.5) * parameters().horizon / static_cast<double>(input.steps);
        input.bears[i][leg] = gait_.bears(leg, phase_ + (i == 0 ? 0 : ahead / gait_.period));
      }
    }
    ForcePlanResult result = plan_.step(input);
    for (Eigen::Vector3d& force : result.forces) force = turn() * force;
    if (result.outcome != QpOutcome::kSolved) ++failures_;
    return result.forces;
  }

  Gait gait_;
  Eigen::Vector3d request_;
  ForcePlan plan_;
  std::array<Eigen::Vector3d, kLegs> feet_{}, forces_{};
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero(), velocity_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d rate_ = Eigen::Vector3d::Zero();
  Eigen::Vector2d target_ = Eigen::Vector2d::Zero();
  Eigen::Matrix3d attitude_ = Eigen::Matrix3d::Identity();
  double phase_ = 0, heading_ = 0, largest_tilt_ = 0;
  int cycle_ = 0, failures_ = 0;
};

struct PlannedWalk {
  std::uint64_t gait;
  Eigen::Vector3d request;  ///< m/s, m/s, rad/s
};

class RigidWalk : public testing::TestWithParam<PlannedWalk> {};

TEST_P(RigidWalk, FollowsTheRequestUpright) {
  const Eigen::Vector3d request = GetParam().request;
  RigidWalker robot(kGaits[GetParam().gait], request);
  for (int i = 0; i < 3000; ++i) robot.step();
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (int i = 0; i < 5000; ++i) {
    robot.step();
    mean += Eigen::Vector3d(robot.velocity().x(), robot.velocity().y(), robot.yaw_rate()) / 5000;
  }
  EXPECT_LT((mean - request).cwiseAbs().maxCoeff(), 0.02) << mean.transpose();
  EXPECT_LT(robot.largest_tilt(), 0.1);
  EXPECT_EQ(robot.failures(), 0);
  EXPECT_NEAR(robot.height(), kHeight, 0.02);
}

INSTANTIATE_TEST_SUITE_P(Walks, RigidWalk,
                         testing::Values(PlannedWalk{gait_named("trot"), {0.5, 0, 0}},
                                         PlannedWalk{gait_named("trot"), {1.5, 0, 0}},
                                         PlannedWalk{gait_named("trot"), {0, 0.3, 0}},
                                         PlannedWalk{gait_named("trot"), {0, 0, 1.5}},
                                         PlannedWalk{gait_named("trot"), {0.5, 0.2, 0.5}},
                                         PlannedWalk{gait_named("walking_trot"), {0.5, 0, 0}},
                                         PlannedWalk{gait_named("crawl"), {0.2, 0, 0}}));

}  // namespace robot_control::tests

/// The feed-forward: M a + h − Jᵀ f of the commanded motion, with the smallest forces of the feet that carry it.

#include <Eigen/QR>

#include "control/legged/ideal_legs.h"

namespace robot_control::tests {

using Vector = Eigen::Matrix<double, kLeggedDofs, 1>;

/// Velocity of the commanded motion by differences between two cycles: Rᵀ ṗ, ω in the axes of the base, q̇.
Vector velocity_of(const IdealLegs& legs) {
  const Eigen::Matrix3d now = IdealLegs::attitude(legs.pose()), last = IdealLegs::attitude(legs.pose_before);
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(last.transpose() * now));
  Vector velocity;
  velocity.head<3>() =
      now.transpose() * (IdealLegs::position(legs.pose()) - IdealLegs::position(legs.pose_before)) / legs.period;
  velocity.segment<3>(3) = turn.angle() * turn.axis() / legs.period;
  for (std::size_t i = 0; i < kLegsJoints; ++i) {
    velocity[static_cast<Eigen::Index>(6 + i)] =
        (legs.out.joints[i].position - legs.before.joints[i].position) / legs.period;
  }
  return velocity;
}

/// Returns the efforts that carry `part` of the weight with forces by `share`.
Vector efforts_of(const IdealLegs& legs, const Vector& velocity, const Vector& acceleration,
                  const std::array<double, kLegs>& share, double part) {
  LeggedMotion motion;
  for (std::size_t i = 0; i < kLegsJoints; ++i) {
    motion.angles[i] = legs.out.joints[i].position;
    motion.rates[i] = velocity[static_cast<Eigen::Index>(6 + i)];
  }
  motion.linear = velocity.head<3>();
  motion.angular = velocity.segment<3>(3);
  motion.gravity = -kGravity * IdealLegs::attitude(legs.pose()).row(2).transpose();
  LeggedEquations equations;
  LegDynamics(legs.robot).step(motion, equations);
  Vector efforts = equations.mass * acceleration + equations.bias;
  Eigen::Matrix<double, 6, 3 * kLegs> map;
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d unit = std::sqrt(share[leg]) * Eigen::Vector3d::Unit(axis);
      map.col(3 * static_cast<int>(leg) + axis) << unit, legs.foot_in_base(leg).cross(unit);
    }
  }
  const Eigen::Matrix<double, 3 * kLegs, 1> y =
      map.completeOrthogonalDecomposition().solve(part * Eigen::Matrix<double, 6, 1>(efforts.head<6>()));
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    Eigen::Vector3d foot;
    const Eigen::Matrix3d jacobian = legs.robot.legs[leg].kinematics.jacobian(legs.angles(leg), foot);
    efforts.segment<3>(static_cast<Eigen::Index>(6 + kLegJoints * leg)) -=
        jacobian.transpose() * std::sqrt(share[leg]) * y.segment<3>(3 * static_cast<int>(leg));
  }
  return efforts;
}

void expect_efforts(const IdealLegs& legs, const Vector& expected, double tolerance, const char* where) {
  const LegTuning tuning = leg_tuning(legs.robot);
  for (std::size_t i = 0; i < kLegsJoints; ++i) {
    const JointCommand& joint = legs.out.joints[i];
    ASSERT_NEAR(joint.effort, expected[static_cast<Eigen::Index>(6 + i)], tolerance) << where << ", joint " << i;
    ASSERT_EQ(joint.mode, JointMode::kImpedance);
    ASSERT_EQ(joint.stiffness, tuning.stiffness);
    ASSERT_EQ(joint.damping, tuning.damping);
  }
}

TEST(LegEfforts, CarryTheWeightInAnyPose) {
  for (const Posture& posture :
       {Posture{}, Posture{.height = -0.03, .roll = 0.1, .pitch = -0.06, .x = 0.02, .yaw = 0.1},
        Posture{.roll = -0.15, .pitch = 0.1, .y = 0.02}}) {
    IdealLegs legs = standing();
    Request request;
    request.posture = posture;
    legs.run(3.0, request);
    expect_efforts(legs, efforts_of(legs, Vector::Zero(), Vector::Zero(), {1, 1, 1, 1}, 1), 1e-3, "at rest");
  }
}

TEST(LegEfforts, CarryTheWeightWithThreeFeetWhileOneIsInTheAir) {
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    IdealLegs legs = standing();
    Request request = stance_of({ModeKind::kLift, leg});
    request.posture.height = 0.08;
    legs.run(2.5, request);
    std::array<double, kLegs> share{1, 1, 1, 1};
    share[leg] = 0;
    expect_efforts(legs, efforts_of(legs, Vector::Zero(), Vector::Zero(), share, 1), 1e-3, "three feet");
  }
}

/// Σ shares/3 of the weight, at most all of it.
TEST(LegEfforts, TakeTheWeightWithTheShares) {
  IdealLegs legs(lopsided());
  legs.request(stance_of({ModeKind::kStand}));
  for (int k = 0; k < 200 && legs.out.legged.phase != LegPhase::kRising; ++k) legs.step();
  Vector velocity = velocity_of(legs);
  for (int k = 1; k <= 45; ++k) {
    const Vector before = velocity;
    legs.step();
    velocity = velocity_of(legs);
    if (k < 5) continue;
    const double share = std::min(1.0, k * kCycle / kLoadTime);
    expect_efforts(legs,
                   efforts_of(legs, velocity, (velocity - before) / kCycle, {share, share, share, share},
                              std::min(1.0, 4 * share / 3)),
                   0.05, "loading");
  }
}

TEST(LegEfforts, AccelerateTheBodyAndItsLegs) {
  IdealLegs legs = standing();
  Vector velocity = Vector::Zero();
  double strongest = 0;
  for (int k = 0; k < 300; ++k) {
    const double t = k * kCycle, omega = 6;
    Request request;
    request.posture = {.height = 0.02 * std::sin(omega * t),
                       .roll = 0.12 * std::sin(omega * t + 1),
                       .pitch = 0.1 * std::sin(omega * t + 2),
                       .x = 0.02 * std::sin(omega * t + 3),
                       .y = 0.02 * std::sin(omega * t + 4),
                       .yaw = 0.15 * std::sin(omega * t + 5)};
    const Vector before = velocity;
    legs.step(request);
    velocity = velocity_of(legs);
    if (k < 60) continue;
    const Vector acceleration = (velocity - before) / kCycle;
    const Vector moved = efforts_of(legs, velocity, acceleration, {1, 1, 1, 1}, 1);
    const Vector still = efforts_of(legs, Vector::Zero(), Vector::Zero(), {1, 1, 1, 1}, 1);
    strongest = std::max(strongest, (moved - still).tail<kLegsJoints>().cwiseAbs().maxCoeff());
    expect_efforts(legs, moved, 0.06, "moving");
  }
  EXPECT_GT(strongest, 1.0) << "the motion shows in the efforts";
}

/// A step of the acceleration comes as 1 − (1 − Δt/5 ms)ⁿ.
TEST(LegEfforts, SmoothTheAcceleration) {
  IdealLegs legs = standing(lopsided(), 0.001);
  Request request;
  request.posture.x = 0.05;
  legs.request(request);
  double expected = 0, last = 0;
  for (int k = 0; k < 30; ++k) {
    legs.step();
    const double speed = legs.state().stand.body[0].speed;
    expected += 0.2 * ((speed - last) / 0.001 - expected);
    last = speed;
    EXPECT_NEAR(legs.state().stand.acceleration[0], expected, 1e-6) << k;
  }
  EXPECT_GT(expected, 0.5);
}

}  // namespace robot_control::tests

/// The torque of treads that slide in a turn, compared with Coulomb's law.

#include "machine/wheeled/scrub.h"

#include <gtest/gtest.h>

#include <array>

namespace robot_control::tests {

/// 20 kg on four wheels of 0.1 m, axles 0.4 m apart, 0.5 m wide; left joints mirrored.
DriveTrain skid_steer() {
  DriveTrain robot;
  robot.wheel_base = 0.5;
  robot.wheel_base_multiplier = 1.64;
  robot.mass = 20;
  for (std::size_t i = 0; i < 4; ++i) {
    robot.wheels.push_back({.joint = i,
                            .centre_base = {i % 2 == 0 ? 0.2 : -0.2, i < 2 ? 0.25 : -0.25, 0},
                            .radius = 0.1,
                            .sign = i < 2 ? -1.0 : 1.0,
                            .side = i < 2 ? Side::kLeft : Side::kRight});
  }
  return robot;
}

/// A quarter of 20 kg at friction 1 is 49 N, of which the rolling direction takes 0.16/√(0.16² + 0.2²).
constexpr double kTorque = 0.1 * 5 * 9.81 * 0.6247;

TEST(Scrub, IsCoulombFrictionOfTheTreadsOnTheSpot) {
  const Scrub scrub(skid_steer());
  for (const double angular : {0.5, 2.0}) {
    const auto efforts = scrub.efforts(0, angular);
    for (std::size_t i = 0; i < 4; ++i) {
      // The rims' own speed, 0.41·ω, takes a little: 0.05·0.41/0.256 of the slide.
      EXPECT_NEAR(efforts[i], kTorque, 0.005 * kTorque) << "mirrored left joints turn as the right ones";
      EXPECT_EQ(scrub.efforts(0, -angular)[i], -efforts[i]);
    }
  }
  EXPECT_NEAR(scrub.max_effort(0), kTorque, 1e-3 * kTorque);
}

TEST(Scrub, VanishesWithTheTurnWithoutAJump) {
  const Scrub scrub(skid_steer());
  double last = 0;
  for (double angular = 0; angular < 0.5; angular += 1e-3) {
    const double effort = scrub.efforts(0, angular)[2];
    EXPECT_GE(effort, last);
    EXPECT_LT(effort - last, 0.06 * kTorque);
    last = effort;
  }
  EXPECT_EQ(scrub.efforts(1, 0)[2], 0);
  EXPECT_LT(scrub.efforts(1, 0.02)[2], 0.15 * kTorque) << "a wide curve: tyres creep, they do not slide";
}

TEST(Scrub, IsThatOfTheTwistOfTheWheels) {
  const Scrub scrub(skid_steer());
  const double half_base = 0.41;
  const auto wanted = scrub.efforts(0.3, 0.7);
  const double left = (0.3 - half_base * 0.7) / 0.1, right = (0.3 + half_base * 0.7) / 0.1;
  const auto efforts = scrub.efforts({-left, -left, right, right});
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(efforts[i], wanted[i], 1e-12);
}

struct Strain : testing::Test {
  const Scrub scrub_{skid_steer()};
  std::array<double, kMaxWheels> efforts_{};

  /// m, by which the treads slid.
  double turn(double linear, double angular, double seconds, double dt = 1e-3) {
    double distance = 0;
    for (double time = 0; time < seconds - 0.5 * dt; time += dt)
      distance += scrub_.strain(efforts_, linear, angular, dt);
    return distance;
  }
};

// The treads slide with 0.256 m of lever: 63 % of the torque after κ·r/10 = 0.5 mm.
TEST_F(Strain, BuildsUpOverTheWayThatTreadsSlideAndStaysWhereTheyStop) {
  EXPECT_NEAR(turn(0, 0.5, 0.004, 1e-4), 0.0005, 0.00002);
  EXPECT_NEAR(efforts_[2], 0.63 * kTorque, 0.02 * kTorque);
  turn(0, 0, 1);
  EXPECT_NEAR(efforts_[2], 0.63 * kTorque, 0.02 * kTorque);
  turn(0, 0.5, 0.1);
  EXPECT_NEAR(efforts_[2], kTorque, 0.01 * kTorque);
  turn(0, -0.5, 0.1);
  EXPECT_NEAR(efforts_[2], -kTorque, 0.01 * kTorque);
}

TEST_F(Strain, DoesNotDependOnTheCycle) {
  turn(0.2, 0.5, 0.01, 1e-3);
  const double coarse = efforts_[2];
  efforts_ = {};
  turn(0.2, 0.5, 0.01, 1e-4);
  EXPECT_NEAR(efforts_[2], coarse, 0.05 * kTorque);
}

TEST_F(Strain, EndsAtTheTorqueOfTheTurn) {
  for (const double linear : {0.0, 0.3, 1.0}) {
    turn(linear, 0.7, 1);
    const auto steady = scrub_.efforts(linear, 0.7);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(efforts_[i], steady[i], 0.002 * kTorque) << linear;
  }
}

TEST_F(Strain, RollsOutOfTheContact) {
  turn(0, 1, 1);
  turn(1, 0, 0.05);  // five tenths of a radius
  EXPECT_LT(efforts_[2], 0.01 * kTorque);
}

TEST(Scrub, FollowsTheLoadOfEachAxle) {
  DriveTrain robot = skid_steer();
  robot.centre_of_gravity_base[0] = 0.1;  // three quarters on the front axle
  const Scrub scrub(robot);
  EXPECT_NEAR(scrub.max_effort(0), 1.5 * kTorque, 2e-3 * kTorque);
  EXPECT_NEAR(scrub.max_effort(1), 0.5 * kTorque, 2e-3 * kTorque);
}

TEST(Scrub, IsNoneOfOneWheelASide) {
  DriveTrain robot = skid_steer();
  robot.wheels = {robot.wheels[0], robot.wheels[2]};
  robot.wheel_base_multiplier = 1.05;  // by calibration: broad tyres
  const Scrub scrub(robot);
  EXPECT_EQ(scrub.efforts(0.1, 1)[0], 0);
  EXPECT_EQ(scrub.max_effort(1), 0);
}

}  // namespace robot_control::tests

// Tyres that creep under force.

#include "estimation/estimator_fixture.h"
#include "support/constants.h"

namespace robot_control {
namespace {

// Pulled with 1 m/s², these tyres turn 1 % faster than they go; in curves they drift outwards.
class CreepingTyres : public EstimatorFixture {
 protected:
  static constexpr double kCreep = 0.01;  // s²/m
  explicit CreepingTyres(double known = kCreep) : EstimatorFixture(two_wheeler(), {.tyre_creep = known}) {
    robot_.creep = kCreep;
    stand();
  }
  /// Largest error of the speed, m/s, from 0.1 s after the start of each ramp on.
  double shuttle() {
    double worst = 0;
    for (const double speed : {0.8, 0.2, 0.7, -0.5, 0.4}) {
      drive(speed, 0.5, 100);
      for (int i = 0; i < 1500; ++i) {
        drive(speed, 0.5, 1);
        worst = std::max(worst, std::abs(this->speed() - robot_.motion.velocity.x()));
      }
    }
    return worst;
  }
};
class CreepingTyresTakenForRigid : public CreepingTyres {
 protected:
  CreepingTyresTakenForRigid() : CreepingTyres(0) {}
};

TEST_F(CreepingTyres, SpeedAndWayAreThatOfTheGround) {
  EXPECT_LT(shuttle(), 0.0005);
  EXPECT_LT(position_error(), 2e-4);
}

TEST_F(CreepingTyresTakenForRigid, SpeedIsThatOfTheTread) {
  EXPECT_GT(shuttle(), 0.005);
  EXPECT_GT(position_error(), 0.003);
}

// It stands on a slope that it takes for its accelerometer's bias, or the other way round: no force of which nobody is
// sure makes the way longer or shorter.
TEST(EstimatorCreep, ATiltInDoubtMakesNoCreep) {
  RollingRobot robot;
  robot.accelerometer_bias = {0.5, 0, 0};
  Estimator estimator({.tyre_creep = 0.01}, two_wheeler(), kPeriod);
  StateFrame state;
  const auto drive = [&](double speed, int cycles) {
    for (int i = 0; i < cycles; ++i) {
      robot.drive(speed, 0);
      estimator.step(robot.frame(), state);
    }
  };
  drive(0, 3000);
  drive(0.5, 4000);
  // 0.005 of the way, were it believed; the tilt of 0.05 rad shortens its projection by 0.00125.
  EXPECT_NEAR(state.pose_odom.position[0], robot.x(), 0.002 * robot.x());
}

}  // namespace
}  // namespace robot_control

// Tyres creep under force.

#include "estimation/wheeled/estimator_fixture.h"
#include "support/constants.h"

namespace robot_control::tests {

// Pulled with 1 m/s², these tyres turn 1 % faster than the robot moves; in curves they drift outwards.
struct CreepingTyres : EstimatorFixture {
  static constexpr double kCreep = 0.01;  // s²/m
  explicit CreepingTyres(double known = kCreep, const DriveTrain& model = two_wheeler())
      : EstimatorFixture(model, {.tyre_creep = known}) {
    robot_.creep = kCreep;
    stand();
  }
  /// Largest error of the speed, m/s, from 0.1 s after the last change of the acceleration on. At that change the
  /// tread's speed jumps, and the tracking loop of the wheels follows.
  double shuttle(double rate = 0.5) {
    double worst = 0, last = 0;
    int steady = 0;
    for (const double speed : {0.8, 0.2, 0.7, -0.5, 0.4}) {
      for (int i = 0; i < 1600; ++i) {
        const double before = robot_.motion.velocity.x();
        drive(speed, rate, 1);
        const double gained = robot_.motion.velocity.x() - before;
        steady = std::abs(gained - std::exchange(last, gained)) < 1e-9 ? steady + 1 : 0;
        if (steady >= 100) worst = std::max(worst, std::abs(this->speed() - robot_.motion.velocity.x()));
      }
    }
    return worst;
  }
};
struct CreepingTyresTakenForRigid : CreepingTyres {
  CreepingTyresTakenForRigid() : CreepingTyres(0) {}
};

/// The IMU swings in curves: its measured force is not that of the tyres.
struct CreepingTyresUnderAFarImu : CreepingTyres {
  CreepingTyresUnderAFarImu() : CreepingTyres(kCreep, far()) {}
  static DriveTrain far() {
    DriveTrain model = two_wheeler();
    model.imu_in_base.position = {0.5, 0.2, 0.2};
    return model;
  }
};

// The drive is straight: in curves a difference of the sides' creep counts as wheel base and clock offset.
TEST_F(CreepingTyres, TheWayIsThatOfTheGround) {
  shuttle(0);
  EXPECT_LT(position_error(), 2e-4);
}

TEST_F(CreepingTyres, TheSpeedIsThatOfTheGround) {
  EXPECT_LT(shuttle(), 0.0015);
}

TEST_F(CreepingTyres, CurvesDriftOutwards) {
  drive(0.8, 0.5, 3000);
  EXPECT_NEAR(state_.base.twist_base.linear[1], -kCreep * 0.8 * 0.8 * 0.5, 3e-4);
}

TEST_F(CreepingTyresUnderAFarImu, SpeedIsThatOfTheGround) {
  EXPECT_LT(shuttle(), 0.0015);
}

TEST_F(CreepingTyresTakenForRigid, SpeedIsThatOfTheTread) {
  EXPECT_GT(shuttle(), 0.005);
  EXPECT_GT(position_error(), 0.003);
}

// Uphill the treads turn by 1 % of a tenth of gravity more than the robot moves.
TEST(EstimatorCreep, TheWayUphillIsThatOfTheGround) {
  constexpr double kCreep = 0.01;
  constexpr double kSlope = 0.1;  // rad
  const auto error = [&](double known) {
    RollingRobot robot;
    robot.creep = kCreep;
    Estimator estimator({.tyre_creep = known, .accelerometer_bias_initial = 0.005}, two_wheeler(), kPeriod);
    StateFrame state;
    const auto drive = [&](double speed, double pitch_rate, int cycles) {
      for (int i = 0; i < cycles; ++i) {
        robot.drive(speed, 0, pitch_rate);
        estimator.step(robot.frame(), state);
      }
    };
    drive(0, 0, 3000);
    drive(0.5, 0, 1000);
    for (int i = 0; i < 1000; ++i) drive(0.5, -kSlope * (i < 500 ? i : 1000 - i) / 250, 1);
    const double began = robot.x() - state.base.pose_odom.position[0];
    drive(0.5, 0, 6000);
    return robot.x() - state.base.pose_odom.position[0] - began;
  };
  const double crept = kCreep * RollingRobot::kGravity * kSlope * 3.0;
  EXPECT_NEAR(error(0), -crept, 0.1 * crept);
  EXPECT_NEAR(error(kCreep), 0, 0.1 * crept);
}

// It stands on a slope that may also be the accelerometer's bias. Such an uncertain force makes the way neither longer
// nor shorter.
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
  // As a slope it would be 0.005 of the way; the tilt of 0.05 rad shortens its projection by 0.00125.
  EXPECT_NEAR(state.base.pose_odom.position[0], robot.x(), 0.002 * robot.x());
}

}  // namespace robot_control::tests

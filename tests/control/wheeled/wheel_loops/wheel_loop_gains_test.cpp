#include "control/wheeled/wheel_loops/wheel_loop_gains.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "control/wheeled/control_problems.h"
#include "control/wheeled/test_robot.h"
#include "control/wheeled/wheel_loops/wheel_loop_stability.h"
#include "support/constants.h"

namespace robot_control::tests {

WheelLoopGains derived(double rate) {
  const DriveTrain robot = make_test_robot();
  return wheel_loop_gains({}, robot, robot.wheels[0], 1 / rate);
}

// J 0.005, J_straight 0.065 kg·m².
TEST(WheelLoopGains, AreThoseOfTheHeader) {
  EXPECT_NEAR(derived(1000).kp, 0.4 * 0.005 * 1000, 1e-12);
  EXPECT_NEAR(derived(1000).ki, 20, 1e-12);
  EXPECT_NEAR(derived(1000).model_inertia, 0.01, 1e-15);
  EXPECT_EQ(derived(1000).kd, 0);
  EXPECT_NEAR(derived(2000).kp, 31 * 0.065, 1e-12) << "the pace of the loaded wheel is enough";
  EXPECT_NEAR(derived(100).kp, 0.2, 1e-12);
  EXPECT_NEAR(derived(100).ki, 0.2 * 0.2 / (3 * 0.065), 1e-12);
}

TEST(WheelLoopGains, GivenByTheUserStay) {
  const DriveTrain robot = make_test_robot();
  DriveControllerParameters parameters;
  parameters.pid_kp = 1;
  parameters.pid_kd = 0.01;
  WheelLoopGains gains = wheel_loop_gains(parameters, robot, robot.wheels[0], 1e-3);
  EXPECT_EQ(gains.kp, 1);
  EXPECT_NEAR(gains.ki, 1 / (3 * 0.065), 1e-12) << "derived from the given kp";
  EXPECT_EQ(gains.kd, 0.01);
  parameters.pid_ki = 0;
  EXPECT_EQ(wheel_loop_gains(parameters, robot, robot.wheels[0], 1e-3).ki, 0);
}

TEST(TrackingBandwidth, ShrinksBelow500HzUnlessTheUserSaysOtherwise) {
  EXPECT_EQ(tracking_bandwidth({}, 1 / 2000.0), 20);
  EXPECT_NEAR(tracking_bandwidth({}, 1 / 500.0), 20, 1e-12);
  EXPECT_NEAR(tracking_bandwidth({}, 1 / 100.0), 4, 1e-12);
  DriveControllerParameters parameters;
  parameters.tracking_bandwidth = 30;
  EXPECT_EQ(tracking_bandwidth(parameters, 1 / 100.0), 30);
}

// The loads range from a lifted wheel to ten times the load, with all gains times four.
TEST(WheelLoopGains, AreStableWithAMarginOfFourWhateverTheWheelDrives) {
  for (const double rate : {100.0, 150.0, 250.0, 333.0, 500.0, 1000.0, 2000.0}) {
    for (const double ratio : {0.01, 0.05, 0.2, 0.5, 1.0}) {
      DriveTrain robot = make_test_robot();
      WheelModel& wheel = robot.wheels[0];
      wheel.inertia = ratio * 0.065;
      robot.mass = 2 * (0.065 - wheel.inertia) / (wheel.radius * wheel.radius);
      WheelLoopGains gains = wheel_loop_gains({}, robot, wheel, 1 / rate);
      const double bandwidth = tracking_bandwidth({}, 1 / rate);
      for (const double scale : {1.0, 4.0}) {
        WheelLoopGains scaled = gains;
        scaled.kp *= scale;
        scaled.ki *= scale;
        for (double inertia = wheel.inertia; inertia < 0.65; inertia *= 1.3) {
          EXPECT_LT(wheel_loop_spectral_radius(scaled, {inertia}, 1 / rate, bandwidth), 1)
              << rate << " Hz, ratio " << ratio << ", inertia " << inertia << ", gains times " << scale;
        }
      }
    }
  }
}

// The damping ranges from a negligible one to one that outweighs the inertia, with all gains times three.
TEST(WheelLoopGains, AreStableWithAMarginOfThreeInADampedJoint) {
  for (const double rate : {100.0, 150.0, 250.0, 500.0, 1000.0, 2000.0}) {
    for (const double ratio : {0.01, 0.1, 0.5, 0.7, 1.0}) {
      for (double pace = 1; pace < 1.1e4; pace *= 2.15) {  // d/J, 1/s
        DriveTrain robot = make_test_robot();
        WheelModel& wheel = robot.wheels[0];
        wheel.inertia = ratio * 0.065;
        robot.mass = 2 * (0.065 - wheel.inertia) / (wheel.radius * wheel.radius);
        const double damping = robot.joints[wheel.joint].damping = pace * wheel.inertia;
        WheelLoopGains gains = wheel_loop_gains({}, robot, wheel, 1 / rate);
        gains.kp *= 3;
        gains.ki *= 3;
        for (double inertia = wheel.inertia; inertia < 0.65; inertia *= 1.7) {
          EXPECT_LT(wheel_loop_spectral_radius(gains, {inertia, damping}, 1 / rate, tracking_bandwidth({}, 1 / rate)),
                    1)
              << rate << " Hz, ratio " << ratio << ", d/J " << pace << " 1/s, inertia " << inertia;
        }
      }
    }
  }
}

// A creeping wheel has almost no inertia, and its damping takes the whole torque: the loop must not report a fast
// speed.
TEST(WheelLoopGains, SeeNoSpeedThatADampedWheelDoesNotHave) {
  constexpr double kDamping = 0.2;
  DriveTrain robot = make_test_robot();
  WheelModel& wheel = robot.wheels[0];
  wheel.inertia = 3.4e-5;
  robot.joints[wheel.joint].damping = kDamping;
  WheelLoop loop(wheel_loop_gains({}, robot, wheel, kPeriod), tracking_bandwidth({}, kPeriod), 0.28, kPeriod);
  double angle = 0;
  loop.measure({}, 1, true);
  for (int k = 1; k <= 400; ++k) {
    const bool driven = k / 50 % 2 == 0;  // a brake, a drive, …
    const double effort = driven ? 0.2 : 0;
    angle += effort / kDamping * kPeriod;
    loop.measure({.position = angle, .effort = effort}, 1, driven);
    ASSERT_LT(std::abs(loop.velocity() - 0.5), 2.0) << "turning at 0 or 1 rad/s, cycle " << k;
  }
}

TEST(WheelLoopGains, AreAcceptedForRobotsOfEverySize) {
  for (unsigned seed = 0; seed < 300; ++seed) {
    std::mt19937 random(seed);
    const auto between = [&](double low, double high) {
      return std::exp(std::uniform_real_distribution<double>(std::log(low), std::log(high))(random));
    };
    DriveTrain robot = seed % 2 == 0 ? make_test_robot() : make_skid_steer();
    const double radius = between(0.015, 0.3);
    robot.mass = between(0.5, 500);
    robot.wheel_base = between(2, 8) * radius;
    robot.yaw_inertia = robot.mass * std::pow(between(0.1, 2) * robot.wheel_base, 2);
    const double share = robot.mass * radius * radius / static_cast<double>(robot.wheels.size());
    const double inertia = between(0.05, 1) * share;
    for (WheelModel& wheel : robot.wheels) {
      wheel.radius = radius;
      wheel.inertia = inertia;
    }
    const double rate = between(100, 2000);
    const auto problems = control_problems({}, robot, 1 / rate);
    EXPECT_TRUE(problems.empty()) << "seed " << seed << ": " << problems.front();
  }
}

}  // namespace robot_control::tests

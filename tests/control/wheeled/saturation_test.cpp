/// With a wheel at its limit the path is kept, the plan waits, and no command exceeds the limit.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "control/wheeled/control_bench.h"
#include "control/wheeled/kinematics.h"

namespace robot_control::tests {

constexpr double kWeak = 0.4;  // N·m; straight ahead 1 m/s² takes 0.65
constexpr PlanarTwist kCurve{.linear = 0.7, .angular = 1.0};

/// A command stays valid until the next one.
DriveControllerParameters patient() {
  DriveControllerParameters parameters;
  parameters.cmd_vel_timeout = 0;
  return parameters;
}

DriveTrain with_effort_limit(double limit) {
  DriveTrain robot = make_test_robot();
  for (JointModel& joint : robot.joints) joint.effort_limit = limit;
  return robot;
}

/// Drives from rest to kCurve; returns the largest error of heading and way relative to the arc, beyond the first 2 cm.
double off_the_arc(ControlBench& bench, double seconds) {
  bench.run(0.3);
  bench.send(kCurve.linear, kCurve.angular);
  double heading = 0;
  double largest = 0;
  for (double t = 0; t < seconds; t += bench.period) {
    bench.step();
    heading += bench.plant.twist.angular * bench.period;
    const double distance = bench.plant.distance;
    if (distance < 0.02) continue;
    largest = std::max(largest, std::abs(heading * kCurve.linear / (kCurve.angular * distance) - 1));
  }
  return largest;
}

// 2 % is promised for a curve that saturates a wheel.
TEST(TorqueSaturation, KeepsTheCurveDuringTheRamp) {
  for (const double limit : {0.6, kWeak, 0.2}) {
    ControlBench bench(with_effort_limit(limit), patient());
    EXPECT_LT(off_the_arc(bench, 6), 0.02) << limit << " N·m";
    EXPECT_NEAR(bench.plant.twist.linear, kCurve.linear, 0.01) << limit << " N·m";
    EXPECT_NEAR(bench.plant.twist.angular, kCurve.angular, 0.01) << limit << " N·m";
  }
}

TEST(TorqueSaturation, KeepsTheCurveWithAPayloadThatFeedForwardDoesNotKnow) {
  DriveTrain loaded = with_effort_limit(kWeak);
  loaded.mass *= 2;
  loaded.yaw_inertia *= 2;
  ControlBench bench(with_effort_limit(kWeak), patient(), 1e-3, loaded);
  bench.plant.counts = 4096;
  // One count moves the torque by a third of the limit, which clips it unevenly; each wheel alone would lose all of it.
  EXPECT_LT(off_the_arc(bench, 6), 0.1);
  EXPECT_NEAR(bench.plant.twist.linear, kCurve.linear, 0.01);
}

TEST(TorqueSaturation, UsesWhatTorqueThereIs) {
  ControlBench bench(with_effort_limit(kWeak), patient());
  bench.run(0.3);
  bench.send(1, 0);
  bench.run(1.2);
  // 0.4 of 0.65 N·m from where the jerk limit reached them, after 0.06 s, on.
  EXPECT_NEAR(bench.plant.twist.linear, kWeak / 0.65 * (1.2 - 0.5 * 0.06), 0.02);
  EXPECT_TRUE(bench.command.reasons & kReasonSaturated);
}

TEST(TorqueSaturation, TheAffordedAccelerationStaysInForceOnceTheTorqueIsWithinItsLimit) {
  ControlBench bench(with_effort_limit(kWeak), patient());
  bench.plant.counts = 4096;  // one count moves the torque across its limit and back
  bench.run(0.3);
  bench.send(1, 0);
  bench.run(0.2);
  for (int k = 0; k < 1000; ++k) {
    bench.step();
    ASSERT_TRUE(bench.command.reasons & kReasonSaturated) << k << " ms";
  }
}

TEST(TorqueSaturation, NeverLetsThePlanRunAway) {
  DriveTrain loaded = with_effort_limit(kWeak);
  loaded.mass *= 2;
  ControlBench bench(with_effort_limit(kWeak), patient(), 1e-3, loaded);
  bench.run(0.3);
  bench.send(1, 0);
  double largest = 0;
  for (int k = 0; k < 5000; ++k) {
    bench.step();
    largest = std::max(largest, std::abs(bench.command.twist_limited.linear[0] - bench.plant.twist.linear));
  }
  // This is the error with which kp reaches the whole limit, 0.4 N·m/2 N·m·s/rad at 0.1 m.
  EXPECT_LT(largest, kWeak / 2 * 0.1);
  EXPECT_NEAR(bench.plant.twist.linear, 1, 0.01);
}

TEST(TorqueSaturation, AStopInTheMiddleOfTheRampBeginsAtOnce) {
  ControlBench bench(with_effort_limit(kWeak), patient());
  bench.run(0.3);
  bench.send(1, 0);
  bench.run(0.8);
  const double speed = bench.plant.twist.linear;
  bench.send(0, 0);
  double fastest = 0;
  for (int k = 0; k < 1000; ++k) {
    bench.step();
    fastest = std::max(fastest, bench.plant.twist.linear);
  }
  // The acceleration of 0.62 m/s² fades at 10 m/s³: a²/2j, and two cycles of delay.
  EXPECT_LT(fastest, speed + 0.62 * 0.62 / 20 + 2 * 0.62e-3);
}

TEST(TorqueSaturation, TheTargetGoesOnWhereTheWheelsCannot) {
  ControlBench bench(with_effort_limit(kWeak), patient());
  bench.plant.slope = 60 * std::numbers::pi / 180;  // steeper than it can climb
  bench.run(0.3);
  bench.send(0.5, 0);
  bench.run(5 * (0.5 + 0.1));  // a fifth of the ramp 0.5/1 + 1/10 s
  EXPECT_NEAR(bench.command.joints[0].effort, kWeak, 1e-9);
  EXPECT_NEAR(bench.command.joints[0].velocity, 5, 1e-9) << "what the safety monitor compares the wheel with";
}

TEST(SpeedSaturation, NothingBeyondAWheelsLimitIsOrderedWhateverTheTargetsDo) {
  constexpr double kLimit = kUsableWheelSpeed * 8;  // rad/s, 0.72 m/s
  DriveTrain robot = make_test_robot();
  for (JointModel& joint : robot.joints) joint.velocity_limit = 8;
  DriveControllerParameters parameters = patient();
  parameters.max_linear_jerk = 2;  // slow to turn back: that is what leads past a limit
  parameters.max_angular_jerk = 8;
  const DriveKinematics kinematics(robot);
  int led_past = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    ControlBench bench(robot, parameters);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> requested(-1, 1);
    bench.run(0.3);
    for (int change = 0; change < 40; ++change) {
      const PlanarTwist target{requested(random), 2 * requested(random)};
      bench.send(target.linear, target.angular);
      for (int k = 0; k < 150; ++k) {
        bench.step();
        for (std::size_t i = 0; i < 2; ++i) {
          ASSERT_LE(std::abs(bench.command.joints[i].velocity), kLimit * (1 + 1e-12)) << "seed " << seed;
        }
        const bool at_limit = std::abs(bench.command.joints[0].velocity) > kLimit * (1 - 1e-12) ||
                              std::abs(bench.command.joints[1].velocity) > kLimit * (1 - 1e-12);
        if (at_limit && kinematics.wheel_speed_scale(target) == 1) {
          ++led_past;
          ASSERT_TRUE(bench.command.reasons & kReasonSaturated) << "seed " << seed;
        }
      }
    }
  }
  EXPECT_GT(led_past, 0) << "no sequence led there: the test tests nothing";
}

/// The smallest speed after a stop from 1 m/s, of a robot that is `heavier` than its feed-forward assumes. Its wheels
/// brake the described robot with 0.8 m/s² at most.
double swings_back(double heavier, double rate) {
  constexpr double kSpeed = 1, kNeeded = 0.65;  // N·m at 1 m/s²
  DriveTrain loaded = with_effort_limit(0.8 * kNeeded);
  loaded.mass *= heavier;
  ControlBench bench(with_effort_limit(0.8 * kNeeded), patient(), 1 / rate, loaded);
  bench.run(0.3);
  bench.send(kSpeed, 0);
  bench.run(10);
  bench.send(0, 0);
  double smallest = kSpeed;
  for (double t = 0; t < 20 && !(bench.command.reasons & kReasonHolding); t += bench.period) {
    bench.step();
    smallest = std::min(smallest, bench.plant.twist.linear);
  }
  EXPECT_TRUE(bench.command.reasons & kReasonHolding) << heavier << " at " << rate << " Hz";
  return smallest;
}

// 1 % of the speed is promised for a swing back.
TEST(TorqueSaturation, LeavesNothingToUnwindAfterAStop) {
  for (const double rate : {200.0, 500.0, 1000.0}) {
    for (const double heavier : {1.0, 1.5, 2.0, 3.0}) {
      EXPECT_GT(swings_back(heavier, rate), -0.01) << heavier << " at " << rate << " Hz";
    }
  }
}

// The robot is three times as heavy as assumed, and its wheels of 0.4 N·m brake with 0.2 m/s² at most. The plan reaches
// zero in time.
TEST(TorqueSaturation, NeverStretchesARampTowardsZero) {
  DriveTrain loaded = with_effort_limit(kWeak);
  loaded.mass *= 3;
  ControlBench bench(with_effort_limit(kWeak), patient(), 1e-3, loaded);
  bench.run(0.3);
  bench.send(0.8, 0);
  bench.run(10);
  bench.send(0, 0);
  bench.run(0.8 / 1.0 + 1.0 / 10 + 0.002);
  EXPECT_EQ(bench.command.twist_limited.linear[0], 0);
  EXPECT_GT(bench.plant.twist.linear, 0.3) << "while the robot cannot";
}

}  // namespace robot_control::tests

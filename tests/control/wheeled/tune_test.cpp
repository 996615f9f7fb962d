/// Limits and gains change while the robot drives: nothing jumps, and everything holds from the next cycle on.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "control/wheeled/control_bench.h"
#include "control/wheeled/derived_tuning.h"
#include "support/allocation_guard.h"

namespace robot_control::tests {

/// The bound lies between rounding and anything that a wheel could feel.
constexpr double kTuneRounding = 1e-9;

/// The rigid plant has friction that the controller does not know, so that error and integral are not zero.
struct Tune : testing::Test {
  static ControlBench driving(const DriveControllerParameters& parameters = straight_ramps()) {
    ControlBench bench(make_test_robot(), parameters);
    bench.plant.viscous_friction = 0.02;
    bench.send(1.0, 0.5);
    bench.run(0.6);  // in the middle of the ramp of 1 s
    return bench;
  }

  static void tune(ControlBench& bench, const DriveControllerParameters& parameters) {
    bench.controller.tune(drive_tuning(parameters, bench.robot, bench.period));
  }

  /// rad/s: the speed planned two cycles ago, minus the measured one.
  static double error(const CommandFrame& planned, const CommandFrame& now, std::size_t wheel) {
    return planned.joints[wheel].velocity - now.wheeled.velocity[wheel];
  }

  static void expect_same_bits(const CommandFrame& a, const CommandFrame& b) {
    EXPECT_EQ(a.reasons, b.reasons);
    EXPECT_EQ(a.twist_limited.linear[0], b.twist_limited.linear[0]);
    EXPECT_EQ(a.twist_limited.angular[2], b.twist_limited.angular[2]);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(a.joints[i].mode, b.joints[i].mode);
      EXPECT_EQ(a.joints[i].effort, b.joints[i].effort);
      EXPECT_EQ(a.wheeled.velocity[i], b.wheeled.velocity[i]);
    }
  }

  DriveControllerParameters given = straight_ramps();
};

TEST_F(Tune, ChangesNoBitByWhatHoldsAlready) {
  ControlBench tuned = driving();
  ControlBench left = driving();
  for (int k = 0; k < 1000; ++k) {
    tune(tuned, given);
    tuned.step();
    left.step();
    expect_same_bits(tuned.command, left.command);
    if (HasFailure()) FAIL() << "cycle " << k;
  }
}

TEST_F(Tune, LeavesTheControllerThatAStartWithTheseValuesMakes) {
  given.max_linear_speed = 0.7;
  given.max_angular_speed = 1.5;
  given.max_linear_acceleration = 0.8;
  given.max_angular_acceleration = 3;
  given.max_linear_deceleration = 1.3;
  given.max_linear_emergency_deceleration = 1.9;
  given.max_angular_emergency_deceleration = 5;
  given.max_linear_jerk = 7;
  given.max_angular_jerk = 30;
  given.keep_curvature = false;
  given.cmd_vel_timeout = 0.4;
  given.pid_kp = 1.5;
  given.pid_ki = 9;
  given.pid_kd = 0.001;
  given.tracking_bandwidth = 25;
  given.feed_forward = {
      .mass = 13, .yaw_inertia = 0.6, .wheel_inertia = 0.006, .wheel_damping = 0.03, .wheel_friction = 0.1};
  ControlBench tuned;
  tune(tuned, given);
  tuned.controller.enter_run();
  ControlBench started(make_test_robot(), given);
  for (ControlBench* bench : {&tuned, &started}) bench->send(1.0, 0.5);
  for (int k = 0; k < 1500; ++k) {  // ramp, timeout, emergency ramp, rest
    tuned.step();
    started.step();
    expect_same_bits(tuned.command, started.command);
    if (HasFailure()) FAIL() << "cycle " << k;
  }
  EXPECT_NE(tuned.command.reasons & kReasonTimedOut, 0u);
}

TEST_F(Tune, LetsTheTorqueGoOnUnderOtherGains) {
  ControlBench tuned = driving();
  ControlBench left = driving();
  CommandFrame before_last;
  for (ControlBench* bench : {&tuned, &left}) {
    bench->step();
    before_last = bench->command;
    bench->step();
  }
  given.pid_kp = 5;
  given.pid_ki = 40;
  given.pid_kd = 0.002;
  tune(tuned, given);
  tuned.step();
  left.step();
  const DriveTuning derived = drive_tuning(straight_ramps(), left.robot, left.period);
  for (std::size_t i = 0; i < 2; ++i) {
    const double wheel_error = error(before_last, tuned.command, i);
    // Without the hand-over the test would find a jump of this size.
    ASSERT_GT(std::abs((*given.pid_kp - derived.wheels[i].kp) * wheel_error), 1e3 * kTuneRounding);
    const double learnt_more = (*given.pid_ki - derived.wheels[i].ki) * wheel_error * tuned.period;
    EXPECT_NEAR(tuned.command.joints[i].effort, left.command.joints[i].effort + learnt_more, kTuneRounding);
  }
}

// A load that nothing plans causes a large error under small gains; its torque passes from them to the hand-over.
TEST_F(Tune, LetsTrackingGoOnUnderOtherGainsAndALargeError) {
  given.pid_kp = 0.7;
  given.pid_ki = 0.3;
  ControlBench bench(make_test_robot(), given);
  bench.plant.viscous_friction = 0.5;
  bench.send(1.0, 0);
  bench.run(0.6);
  given.pid_kp = 3;
  tune(bench, given);
  double worst = 0;
  for (int k = 0; k < 100; ++k) {
    bench.step();
    worst = std::max(worst, std::abs(bench.command.wheeled.velocity[0] - bench.plant.speed.left));
  }
  EXPECT_LT(worst, 0.3) << "rad/s of 5; taken for a planned torque, the hand-over makes 1.5 of them";
}

TEST_F(Tune, LeavesTheIntegratorAloneInAStall) {
  constexpr double kLimit = 5, kError = 8;
  const WheelLoopGains before{.kp = 2, .ki = 0}, after{.kp = 1, .ki = 0};
  WheelLoop loop(before, 20, kLimit, 1e-3);
  loop.measure({}, 1, false);  // the wheel stands
  for (int k = 0; k < 3; ++k) {
    loop.measure({}, 1, false);
    ASSERT_EQ(loop.step({.velocity = kError}, 1), k < 2 ? 0 : kLimit);  // compared with the plan two cycles ago
  }
  loop.tune(after, 20, {});
  loop.measure({}, 1, false);
  EXPECT_EQ(loop.step({.velocity = kError}, 1), kLimit);
  EXPECT_EQ(loop.integral(), 0) << "what the limit cut off does not wind up";
}

TEST_F(Tune, LeavesAHandOverTheTorqueThatTheBrakeHeld) {
  WheelLoop loop({.kp = 2, .ki = 20, .kd = 0.001}, 20, 5, 1e-3);
  for (int k = 0; k < 5; ++k) loop.measure({.position = 1e-4 * k * k}, 1, false);
  loop.tune({.kp = 1, .ki = 10, .kd = 0.01}, 20, {});
  loop.measure({.position = 1e-4 * 25}, 1, false);
  loop.reset_to_measured();
  loop.preload_integrator(1.5);
  EXPECT_NEAR(loop.step({.velocity = loop.velocity()}, 1), 1.5, kTuneRounding);
}

TEST_F(Tune, LetsTorqueAndTrackingGoOnUnderAnotherMass) {
  ControlBench tuned = driving();
  ControlBench left = driving();
  given.feed_forward.mass = 14;
  given.pid_kp = 2;  // as derived from 12 kg, so that the mass alone changes
  given.pid_ki = 20;
  tune(tuned, given);
  tuned.step();
  left.step();
  const double planned_more = 0.5 * (14 - 12) * 0.1;  // N·m, at 1 m/s²
  for (std::size_t i = 0; i < 2; ++i) {
    // One step of the decay with 0.1 s.
    EXPECT_NEAR(tuned.command.joints[i].effort, left.command.joints[i].effort + 0.01 * planned_more, kTuneRounding);
    EXPECT_NEAR(tuned.command.wheeled.velocity[i], left.command.wheeled.velocity[i], kTuneRounding);
  }
}

TEST_F(Tune, LeavesTheIntegratorThePartForTheSpeedAlone) {
  WheelLoop loop({.kp = 2, .ki = 0.1}, 20, 5, 1e-3);
  loop.measure({}, 1, false);
  loop.step({.feed_forward = 1.5}, 1);
  loop.tune({.kp = 2, .ki = 0.1}, 20, {.steady = 0.3, .inertial = -0.8});
  loop.measure({}, 1, false);
  const double planned = 1.5 - 0.3 + 0.8;
  EXPECT_NEAR(loop.step({.feed_forward = planned}, 1), 1.5 + 0.01 * 0.8, kTuneRounding);
  for (int k = 0; k < 1000; ++k) {
    loop.measure({}, 1, false);
    loop.step({.feed_forward = 0.2}, 1);  // the ramp has ended
  }
  EXPECT_NEAR(loop.step({.feed_forward = 0.2}, 1), 0.5, 1e-4);
  EXPECT_NEAR(loop.integral(), 0.3, kTuneRounding);
}

TEST_F(Tune, LeavesNothingToASlowIntegratorInMidRamp) {
  given.pid_kp = 0.7;
  given.pid_ki = 0.3;  // 15 s of kp/ki and more
  for (const double times : {1.0 / 3, 3.0}) {
    given.feed_forward.mass = 12 * times;
    ControlBench bench = driving();
    tune(bench, given);
    bench.send(1.0, 0.5);
    bench.run(0.7);  // the end of the ramp, and three times 0.1 s
    double worst = 0;
    for (int k = 0; k < 1000; ++k) {
      bench.send(1.0, 0.5);
      bench.step();
      const double speed = 0.5 * (bench.plant.speed.left + bench.plant.speed.right) * 0.1;
      worst = std::max(worst, std::abs(speed - 1));
    }
    EXPECT_LT(worst, 0.05) << times;
  }
}

TEST_F(Tune, KeepsWhatIsTrackedUnderAnotherBandwidth) {
  given.feed_forward.wheel_damping = 1.0;  // then model_inertia follows from the bandwidth (wheel_loop_gains.h)
  given.pid_kp = 1.0;
  given.pid_ki = 5.0;
  given.cmd_vel_timeout = 0;
  ControlBench bench(make_test_robot(), given);
  bench.plant.viscous_friction = 1.05;  // an unknown torque of 0.1 N·m at 2 rad/s
  bench.send(0.2, 0);
  bench.run(4.0);
  const double before = bench.command.wheeled.velocity[0];
  const DriveTuning old = drive_tuning(given, bench.robot, bench.period);
  given.tracking_bandwidth = 8;
  ASSERT_NE(drive_tuning(given, bench.robot, bench.period).wheels[0].model_inertia, old.wheels[0].model_inertia);
  tune(bench, given);
  for (int k = 0; k < 20; ++k) {
    bench.step();
    // Without the residual's share it would assume 0.1·(63 − 25) = 3.8 rad/s² too much: 4e-3 rad/s a cycle.
    ASSERT_NEAR(bench.command.wheeled.velocity[0], before, 1e-5) << k;
  }
}

TEST_F(Tune, ReturnsToALoweredSpeedAtTheDeceleration) {
  given.max_linear_deceleration = 0.8;
  given.max_linear_emergency_deceleration = 4;
  ControlBench bench(make_test_robot(), given);
  bench.send(1.0, 0);
  bench.run(1.2);
  ASSERT_EQ(bench.command.twist_limited.linear[0], 1.0);
  given.max_linear_speed = 0.6;
  tune(bench, given);
  bench.send(1.0, 0);
  for (int k = 1; k <= 600; ++k) {
    bench.step();
    ASSERT_NEAR(bench.command.twist_limited.linear[0], std::max(0.6, 1.0 - 0.8 * k * bench.period), kTuneRounding) << k;
  }
}

TEST_F(Tune, BringsNoCommandBackThatTimedOut) {
  given.cmd_vel_timeout = 0.2;
  ControlBench bench = driving(given);
  bench.run(1.0);
  ASSERT_NE(bench.command.reasons & kReasonTimedOut, 0u);
  given.cmd_vel_timeout = 0;  // never
  tune(bench, given);
  bench.run(0.1);
  EXPECT_NE(bench.command.reasons & kReasonTimedOut, 0u);
  EXPECT_EQ(bench.command.twist_limited.linear[0], 0.0);
}

TEST_F(Tune, SpoilsNoHandOverWhileBraked) {
  ControlBench bench;
  bench.plant.slope = 0.05;
  bench.run(0.4);
  ASSERT_NE(bench.command.reasons & kReasonHolding, 0u);
  given.pid_kp = 4;
  given.pid_kd = 0.01;
  given.feed_forward.mass = 20;
  tune(bench, given);
  bench.send(0.5, 0);
  bench.step();
  const double load = 0.5 * 12 * TwoWheelPlant::kGravity * std::sin(0.05) * 0.1;
  EXPECT_NEAR(bench.command.joints[0].effort, load, 0.01 * load) << "a mean, whose first sample was 0";
}

TEST_F(Tune, ChangesNothingThatTheIntegratorsKnowWhileBrakedAtSpeed) {
  ControlBench tuned = driving();
  ControlBench left = driving();
  given.feed_forward.wheel_damping = 0.5;
  given.pid_kp = 2;  // as derived without damping
  given.pid_ki = 20;
  given.tracking_bandwidth = 20;
  for (ControlBench* bench : {&tuned, &left}) {
    bench->permit.action = PermitAction::kBrake;
    bench->run(0.01);
    if (bench == &tuned) tune(tuned, given);
    bench->step();
    bench->permit.action = PermitAction::kDrive;
    bench->step();
    ASSERT_GT(std::abs(bench->plant.speed.left), 1.0);
  }
  EXPECT_NEAR(tuned.command.joints[0].effort, left.command.joints[0].effort, kTuneRounding);
}

TEST_F(Tune, AllocatesNothing) {
  ControlBench bench = driving();
  given.pid_kp = 1;
  const DriveTuning tuning = drive_tuning(given, bench.robot, bench.period);
  const AllocationGuard guard;
  bench.controller.tune(tuning);
  bench.step();
  EXPECT_EQ(guard.count(), 0u);
}

/// One axis of the limited twist, watched while the limits change at random.
struct WatchedAxis {
  double speed = 0;
  double acceleration = 0;

  /// The value is within the new limits, or on the way back to them. Then |a| does not grow, and a speed beyond its
  /// limit grows only while its acceleration fades at the new jerk.
  void check(double now, const AxisTuning& limits, double dt) {
    const double next = (now - speed) / dt;
    const double fastest = std::max({limits.acceleration, limits.deceleration, std::abs(acceleration)});
    EXPECT_LE(std::abs(next), fastest + kTuneRounding / dt);
    if (std::abs(now) > limits.speed + kTuneRounding && std::abs(now) > std::abs(speed) + kTuneRounding * dt) {
      const double faded = std::max(0.0, std::abs(acceleration) - limits.jerk * dt);
      EXPECT_LE(std::abs(next), faded + kTuneRounding / dt);
    }
    speed = now;
    acceleration = next;
  }
};

TEST_F(Tune, NeverExceedsTheOldOrTheNewLimitsAtRandom) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    std::mt19937 random(seed);
    const auto draw = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
    ControlBench bench(make_test_robot(), straight_ramps());
    WatchedAxis linear, angular;
    DriveTuning tuning = drive_tuning(straight_ramps(), bench.robot, bench.period);
    for (int k = 0; k < 3000; ++k) {
      if (k % 50 == 0) bench.send(draw(-1.5, 1.5), draw(-3, 3));
      if (draw(0, 1) < 0.02) {
        given.max_linear_speed = draw(0.1, 1.5);
        given.max_angular_speed = draw(0.2, 3);
        given.max_linear_acceleration = draw(0.2, 3);
        given.max_linear_deceleration = draw(0.2, 3);
        given.max_angular_acceleration = draw(0.5, 10);
        given.max_angular_deceleration = draw(0.5, 10);
        given.max_linear_emergency_deceleration = given.max_angular_emergency_deceleration = 10;
        given.max_linear_jerk = draw(1, 50);
        given.max_angular_jerk = draw(2, 200);
        given.keep_curvature = draw(0, 1) < 0.5;
        given.pid_kp = draw(0.5, 3);
        given.pid_ki = draw(0, 20);
        tuning = drive_tuning(given, bench.robot, bench.period);
        bench.controller.tune(tuning);
      }
      bench.step();
      linear.check(bench.command.twist_limited.linear[0], tuning.linear, bench.period);
      angular.check(bench.command.twist_limited.angular[2], tuning.angular, bench.period);
      ASSERT_EQ(bench.command.reasons & kReasonBadSensors, 0u);
      if (HasFailure()) FAIL() << "seed " << seed << ", cycle " << k;
    }
  }
}

}  // namespace robot_control::tests

#include "robots/wheeled/retuning.h"

#include <thread>

#include "loop/cycle_fixture.h"
#include "support/matchers.h"

namespace robot_control::tests {

/// Healthy: the defaults on two wheels, which the controller drives at up to (1 + 2·0.25)/0.1 = 15 rad/s; the monitor
/// stops beyond 1.25·15 = 18.75.
struct RetuningTest : ::testing::Test {
  std::string refusal(const std::string& request) {
    const DriveTuning before = handed_over();
    try {
      retuning.set(request);
    } catch (const ParameterError& error) {
      EXPECT_EQ(handed_over().count, before.count);
      return error.what();
    }
    ADD_FAILURE() << request << " was accepted";
    return "";
  }

  DriveTuning handed_over() const {
    LiveTuning tuning;
    EXPECT_TRUE(inbox.load(tuning));
    return content_of<DriveTuning>(tuning);
  }

  Parameters parameters;
  DriveTrain robot = two_wheels();
  LatestValue<LiveTuning> inbox;
  Retuning retuning{parameters, robot, inbox};
};

TEST_F(RetuningTest, HandsOverTheWholeSet) {
  const Retuned retuned = retuning.set("{max_linear_speed: 0.5, pid_kp: 1.5}");
  EXPECT_EQ(sentence(retuned), "set 1: max_linear_speed from 1 to 0.5, pid_kp from derived to 1.5");
  const DriveTuning tuning = handed_over();
  EXPECT_EQ(tuning.count, 1u);
  EXPECT_EQ(tuning.linear.speed, 0.5);
  EXPECT_EQ(tuning.wheels[0].kp, 1.5);
  EXPECT_EQ(tuning.wheels[1].kp, 1.5);
  EXPECT_EQ(retuning.in_force().controller.max_linear_speed, 0.5);
}

TEST_F(RetuningTest, LaysEachSetOverTheLast) {
  retuning.set("{max_linear_acceleration: 0.5}");
  EXPECT_EQ(handed_over().linear.deceleration, 0.5) << "left out: as the acceleration";
  retuning.set("{max_linear_speed: 0.7}");
  EXPECT_EQ(handed_over().count, 2u);
  EXPECT_EQ(handed_over().linear.acceleration, 0.5);
  EXPECT_EQ(handed_over().linear.speed, 0.7);
}

// wheel_loop_gains.h: kp = 0.4·J/dt, ki = min(10 kp, kp²/(3·J_straight))
TEST_F(RetuningTest, DerivesFromTheNewValuesWhatWasDerived) {
  retuning.set("{feed_forward: {wheel_inertia: 0.002}}");
  EXPECT_NEAR(handed_over().wheels[0].kp, 0.8, 1e-12);
  retuning.set("{pid_kp: 0.4}");
  EXPECT_NEAR(handed_over().wheels[0].ki, 0.16 / (3 * (0.002 + 0.5 * 12 * 0.01)), 1e-12);
}

TEST_F(RetuningTest, RefusesTheWholeSetWithEveryReason) {
  const std::string text = refusal("{max_linear_speed: 3, pid_kp: 20, pid_kd: .nan, command_rate: 1, typo: 2}");
  EXPECT_THAT(text, HasSubstr("set_parameters refused, nothing is changed: 5 problems\n"));
  for (const char* reason : {"safety_monitor", "unstable", "must be finite", "read only at start", "unknown key"}) {
    EXPECT_THAT(text, HasSubstr(reason));
  }
  EXPECT_EQ(retuning.in_force().controller.max_linear_speed, 1.0);
  EXPECT_EQ(sentence(retuning.set("{max_linear_speed: 0.9}")), "set 1: max_linear_speed from 1 to 0.9");
}

// A speed of the wheels ω needs a limit of max(1.1 ω, ω + 1): 18.75/1.1 = 17.05 rad/s, 1.2 m/s beside 2 rad/s.
TEST_F(RetuningTest, RefusesSpeedsAtWhichTheMonitorWouldStopTheRobot) {
  retuning.set("{max_linear_speed: 1.2}");
  const std::string text = refusal("{max_linear_speed: 1.25}");
  EXPECT_THAT(text, AllOf(HasSubstr("turns a wheel at 17.5 rad/s"), HasSubstr("beyond 18.75 rad/s"),
                          HasSubstr("max_linear_speed + 0.25 m·max_angular_speed to at most 1.705 m/s")));
  retuning.set("{max_linear_speed: 1.4, max_angular_speed: 1.2}");  // 1.7 m/s at the rim
}

TEST_F(RetuningTest, AsksNoMarginForTheSpeedsOfTheStart) {
  parameters.safety.wheel_speed.limit = 15.5;
  Retuning close(parameters, robot, inbox);
  close.set("{max_linear_speed: 0.5}");
  close.set("{max_linear_speed: 1.0}");
  EXPECT_THROW(close.set("{max_linear_speed: 1.01}"), ParameterError);
}

TEST_F(RetuningTest, LetsPassWhatTheMonitorOnlyReports) {
  parameters.safety.wheel_speed.reaction = Reaction::kWarn;
  Retuning warned(parameters, robot, inbox);
  EXPECT_NO_THROW(warned.set("{max_linear_speed: 5}"));
}

TEST_F(RetuningTest, GoesByTheMonitorsOwnParameters) {
  Parameters monitor;
  monitor.controller.max_linear_speed = 0.5;  // Ω = 1.25·10 rad/s
  retuning.expect_monitor(monitor);
  EXPECT_THAT(refusal("{max_linear_speed: 1.01}"), HasSubstr("beyond 12.5 rad/s"));
}

TEST_F(RetuningTest, CountsWhatSeveralThreadsSetAtOnce) {
  constexpr int kEach = 50;
  const auto caller = [this](const char* request) {
    for (int i = 0; i < kEach; ++i) retuning.set(request);
  };
  std::thread one(caller, "{max_linear_speed: 0.5}");
  std::thread two(caller, "{max_angular_speed: 1.0}");
  one.join();
  two.join();
  EXPECT_EQ(handed_over().count, 2u * kEach);
  EXPECT_EQ(handed_over().linear.speed, 0.5);
  EXPECT_EQ(handed_over().angular.speed, 1.0);
}

TEST(RetunedLoop, RunsWithASetFromTheNextCycleOn) {
  Loop loop;
  loop.drive();
  const auto in_force = [&] { return content_of<DriveTuning>(loop.controller->trace().tuning); };
  DriveTuning tuning = in_force();
  EXPECT_EQ(tuning.count, 0u);
  EXPECT_EQ(tuning.linear.speed, 1.0);
  tuning.count = 1;
  tuning.linear.acceleration = 0.25;
  tuning.linear.jerk = 0;
  const double before = loop.newest_command().twist_limited.linear[0];
  loop.controller->tunings().store(tuning_of(tuning));
  EXPECT_EQ(in_force().count, 0u);
  loop.step();
  EXPECT_EQ(in_force().count, 1u);
  EXPECT_EQ(in_force().linear.acceleration, 0.25);
  EXPECT_NEAR(loop.newest_command().twist_limited.linear[0], before + 0.25 * kPeriod, 1e-12);
}

}  // namespace robot_control::tests

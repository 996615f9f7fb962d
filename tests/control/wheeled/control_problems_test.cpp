#include "control/wheeled/control_problems.h"

#include "control/wheeled/test_robot.h"
#include "control/wheeled/wheel_loops/wheel_loop_gains.h"
#include "support/matchers.h"

namespace robot_control::tests {

TEST(ControlProblems, FindsNoneInTheDefaultsAtAnyRate) {
  for (const double rate : {100.0, 200.0, 333.0, 500.0, 1000.0, 2000.0}) {
    EXPECT_THAT(control_problems({}, make_test_robot(), 1 / rate), IsEmpty()) << rate;
    EXPECT_THAT(control_problems({}, make_skid_steer(), 1 / rate), IsEmpty()) << rate;
  }
}

TEST(ControlProblems, RefusesTheArticlesGainsAndNamesValueRuleAndRemedy) {
  DriveControllerParameters parameters;
  parameters.pid_kp = 20;
  parameters.pid_ki = 0.1;
  parameters.pid_kd = 0.5;
  EXPECT_THAT(
      control_problems(parameters, make_test_robot(), 1e-3),
      AllOf(SizeIs(1), Each(AllOf(HasSubstr("pid_kp 20"), HasSubstr("must be < 1"), HasSubstr("Set at most")))));
}

TEST(ControlProblems, RefusesTheGainsOf1kHzAt100HzAndItsRemedyIsAccepted) {
  DriveControllerParameters parameters;
  parameters.pid_kp = 2;
  parameters.pid_ki = 20;
  const std::vector<std::string> problems = control_problems(parameters, make_test_robot(), 1e-2);
  ASSERT_THAT(problems, SizeIs(1)) << "equal wheels are one problem";
  const auto advised = [&](const std::string& name) {
    const std::string advice = problems[0].substr(problems[0].find("Set at most"));
    return std::stod(advice.substr(advice.find(name) + name.size()));
  };
  parameters.pid_kp = advised("pid_kp ");
  parameters.pid_ki = advised("pid_ki ");
  EXPECT_THAT(control_problems(parameters, make_test_robot(), 1e-2), IsEmpty());
}

TEST(ControlProblems, RefusesALoopThatOscillatesAndItsRemedyIsAccepted) {
  DriveControllerParameters parameters;
  parameters.pid_kp = 0.25;
  parameters.pid_ki = 20;
  const std::vector<std::string> problems = control_problems(parameters, make_test_robot(), 1e-3);
  ASSERT_THAT(problems, ElementsAre(AllOf(HasSubstr("oscillates"), HasSubstr("damping ratio"), HasSubstr("pid_ki"))));
  parameters.pid_ki = std::stod(problems[0].substr(problems[0].find("at most pid_ki ") + 15));
  for (const std::string& problem : control_problems(parameters, make_test_robot(), 1e-3)) {
    EXPECT_EQ(problem.find("oscillates"), std::string::npos) << problem;
  }
}

// Every mode of these loops is damped by 0.3; the counts of an encoder keep the mode of 80 Hz oscillating.
TEST(ControlProblems, RefusesALoopThatTheCountsOfAnEncoderMakeOscillate) {
  DriveTrain robot = make_test_robot();
  for (JointModel& joint : robot.joints) joint.effort_limit = 3.5;
  DriveControllerParameters parameters;
  parameters.tracking_bandwidth = 80;
  EXPECT_THAT(control_problems(parameters, robot, 1e-3),
              ElementsAre(AllOf(HasSubstr("tracking_bandwidth 80 Hz"), HasSubstr("4096 counts"), HasSubstr("lifted"))));
  parameters.tracking_bandwidth = 50;
  EXPECT_THAT(control_problems(parameters, robot, 1e-3), IsEmpty());
}

TEST(ControlProblems, RefusesAWheelWithoutTorque) {
  DriveTrain robot = make_test_robot();
  robot.joints[1].effort_limit = 0;
  EXPECT_THAT(
      control_problems({}, robot, 1e-3),
      ElementsAre(AllOf(HasSubstr("right_wheel_joint"), HasSubstr("effort limit"), HasSubstr("wheel_effort_limit"))));
}

TEST(ControlProblems, RefuseAMassThatIsASlipOfThePen) {
  const DriveTrain robot = make_test_robot();  // 12 kg
  DriveControllerParameters parameters;
  for (const double mass : {9.0, 24.0}) {
    parameters.feed_forward.mass = mass;
    EXPECT_THAT(control_problems(parameters, robot, 1e-3), IsEmpty()) << mass;
  }
  for (const double mass : {1.2, 120.0}) {
    parameters.feed_forward.mass = mass;
    const auto problems = control_problems(parameters, robot, 1e-3);
    ASSERT_EQ(problems.size(), 1u) << mass;
    EXPECT_NE(problems[0].find("feed_forward.mass = "), std::string::npos) << problems[0];
    EXPECT_NE(problems[0].find("says 12 kg"), std::string::npos) << problems[0];
  }
  parameters.feed_forward.mass.reset();
  parameters.feed_forward.wheel_inertia = 5;
  EXPECT_FALSE(control_problems(parameters, robot, 1e-3).empty());
}

/// One value of feed_forward.
std::vector<std::string> problems_of(std::optional<double> FeedForwardParameters::*key, double value) {
  DriveControllerParameters parameters;
  parameters.feed_forward.*key = value;
  return control_problems(parameters, make_test_robot(), 1e-3);
}

// 5 N·m and 15 rad/s at most: a quarter of the torque is 1.25 N·m, 0.083 N·m·s/rad.
TEST(ControlProblems, RefuseLossesInTheJointsThatTheMotorsCouldHardlyBear) {
  using Forward = FeedForwardParameters;
  for (const double damping : {0.1, 2.0, 1000.0}) {
    EXPECT_THAT(problems_of(&Forward::wheel_damping, damping),
                testing::Contains(AllOf(HasSubstr("wheel_damping = "), HasSubstr("0 … 0.08333 N·m·s/rad"))))
        << damping;
  }
  EXPECT_THAT(problems_of(&Forward::wheel_damping, 0.02), IsEmpty());
  for (const double friction : {1.3, 9.0}) {
    EXPECT_THAT(problems_of(&Forward::wheel_friction, friction),
                testing::Contains(AllOf(HasSubstr("wheel_friction = "), HasSubstr("0 … 1.25 N·m"))))
        << friction;
  }
  EXPECT_THAT(problems_of(&Forward::wheel_friction, 0.1), IsEmpty());
}

TEST(ControlProblems, LeaveARobotItsOwnLossesHoweverLargeTheyAre) {
  DriveTrain robot = make_test_robot();
  for (JointModel& joint : robot.joints) joint.friction = 2;
  DriveControllerParameters parameters;
  parameters.feed_forward.wheel_friction = 2.05;
  EXPECT_THAT(control_problems(parameters, robot, 1e-3), IsEmpty());
}

TEST(ControlProblems, NameWhatIsSuspiciousOfARobotThatNoGainsFit) {
  DriveTrain robot = make_test_robot();
  robot.notes.push_back({RobotNote::Kind::kSuspicious, "<robot>", "check whether lengths are in millimetres"});
  DriveControllerParameters parameters;
  parameters.pid_kp = 20;
  EXPECT_THAT(control_problems(parameters, robot, 1e-3), Each(HasSubstr("check whether lengths are in millimetres")));
}

// The gains are stable with the heavier wheels of the set, and unstable with the real ones.
TEST(ControlProblems, RefuseGainsThatOnlyTheRobotOfTheSetBears) {
  DriveControllerParameters parameters;
  parameters.feed_forward.wheel_inertia = 0.03;
  parameters.pid_kp = 20;
  EXPECT_THAT(control_problems(parameters, make_test_robot(), 1e-3),
              Each(AllOf(HasSubstr("unstable"), HasSubstr("by the description"), HasSubstr("Set at most"))));
}

TEST(ControlProblems, RefuseGainsThatLeaveTheWheelsToFeedForward) {
  DriveControllerParameters parameters;
  parameters.pid_kp = 0.09 * wheel_loop_gains({}, make_test_robot(), make_test_robot().wheels.front(), 1e-3).kp;
  parameters.pid_ki = 0.01;
  parameters.tracking_bandwidth = 0.09 * tracking_bandwidth({}, 1e-3);
  EXPECT_THAT(control_problems(parameters, make_test_robot(), 1e-3),
              UnorderedElementsAre(HasSubstr("pid_kp"), HasSubstr("tracking_bandwidth")));
}

}  // namespace robot_control::tests

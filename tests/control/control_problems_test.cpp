#include "control/control_problems.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "control/test_robot.h"
#include "control/wheel_loops/wheel_loop_gains.h"

namespace robot_control {
namespace {

using testing::AllOf;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

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
      AllOf(SizeIs(1), Each(AllOf(HasSubstr("pid_kp 20"), HasSubstr("must be < 1"), HasSubstr("Use at most")))));
}

TEST(ControlProblems, RefusesTheGainsOf1kHzAt100HzAndItsRemedyIsAccepted) {
  DriveControllerParameters parameters;
  parameters.pid_kp = 2;
  parameters.pid_ki = 20;
  const std::vector<std::string> problems = control_problems(parameters, make_test_robot(), 1e-2);
  ASSERT_THAT(problems, SizeIs(1)) << "equal wheels are one problem";
  const auto advised = [&](const std::string& name) {
    const std::string advice = problems[0].substr(problems[0].find("Use at most"));
    return std::stod(advice.substr(advice.find(name) + name.size()));
  };
  parameters.pid_kp = advised("pid_kp ");
  parameters.pid_ki = advised("pid_ki ");
  EXPECT_THAT(control_problems(parameters, make_test_robot(), 1e-2), IsEmpty());
}

TEST(ControlProblems, RefusesALoopThatOscillatesAndItsRemedyIsAccepted) {
  DriveControllerParameters parameters;
  parameters.pid_kp = 0.05;
  parameters.pid_ki = 10;
  const std::vector<std::string> problems = control_problems(parameters, make_test_robot(), 1e-3);
  ASSERT_THAT(problems, ElementsAre(AllOf(HasSubstr("oscillates"), HasSubstr("damping ratio"), HasSubstr("pid_ki"))));
  parameters.pid_ki = std::stod(problems[0].substr(problems[0].find("at most pid_ki ") + 15));
  for (const std::string& problem : control_problems(parameters, make_test_robot(), 1e-3)) {
    EXPECT_EQ(problem.find("oscillates"), std::string::npos) << problem;
  }
}

// Every mode of these loops is damped by 0.3; the counts of an encoder keep the one of 80 Hz oscillating.
TEST(ControlProblems, RefusesALoopThatTheCountsOfAnEncoderMakeOscillate) {
  RobotModel robot = make_test_robot();
  for (JointModel& joint : robot.joints) joint.effort_limit = 3.5;
  DriveControllerParameters parameters;
  parameters.tracking_bandwidth = 80;
  EXPECT_THAT(control_problems(parameters, robot, 1e-3),
              ElementsAre(AllOf(HasSubstr("tracking_bandwidth 80 Hz"), HasSubstr("4096 counts"), HasSubstr("lifted"))));
  parameters.tracking_bandwidth = 50;
  EXPECT_THAT(control_problems(parameters, robot, 1e-3), IsEmpty());
}

TEST(ControlProblems, RefusesAWheelWithoutTorque) {
  RobotModel robot = make_test_robot();
  robot.joints[1].effort_limit = 0;
  EXPECT_THAT(
      control_problems({}, robot, 1e-3),
      ElementsAre(AllOf(HasSubstr("right_wheel_joint"), HasSubstr("effort limit"), HasSubstr("wheel_effort_limit"))));
}

TEST(ControlProblems, RefuseAMassThatIsASlipOfThePen) {
  const RobotModel robot = make_test_robot();  // 12 kg
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

/// One value of feed_forward, with the gains given.
std::vector<std::string> problems_of(std::optional<double> FeedForwardParameters::*key, double value,
                                     std::optional<double> kp = {}) {
  DriveControllerParameters parameters;
  parameters.feed_forward.*key = value;
  parameters.pid_kp = kp;
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
    EXPECT_THAT(problems_of(&Forward::wheel_friction, friction, 0.05),
                testing::Contains(AllOf(HasSubstr("wheel_friction = "), HasSubstr("0 … 1.25 N·m"))))
        << friction;
  }
  EXPECT_THAT(problems_of(&Forward::wheel_friction, 0.1), IsEmpty());
}

TEST(ControlProblems, LeaveARobotItsOwnLossesHoweverLargeTheyAre) {
  RobotModel robot = make_test_robot();
  for (JointModel& joint : robot.joints) joint.friction = 2;
  DriveControllerParameters parameters;
  parameters.feed_forward.wheel_friction = 2.05;
  EXPECT_THAT(control_problems(parameters, robot, 1e-3), IsEmpty());
}

TEST(ControlProblems, NameWhatIsSuspiciousOfARobotThatNoGainsFit) {
  RobotModel robot = make_test_robot();
  robot.notes.push_back({RobotNote::Kind::kSuspicious, "<robot>", "are lengths in millimetres?"});
  DriveControllerParameters parameters;
  parameters.pid_kp = 20;
  EXPECT_THAT(control_problems(parameters, robot, 1e-3), Each(HasSubstr("are lengths in millimetres?")));
}

// Stable with the wheels that the set makes heavier, and unstable with those that are there.
TEST(ControlProblems, RefuseGainsThatOnlyTheRobotOfTheSetBears) {
  DriveControllerParameters parameters;
  parameters.feed_forward.wheel_inertia = 0.03;
  parameters.pid_kp = 20;
  EXPECT_THAT(control_problems(parameters, make_test_robot(), 1e-3),
              Each(AllOf(HasSubstr("unstable"), HasSubstr("by the description"), HasSubstr("Use at most"))));
  parameters.pid_kp.reset();
  parameters.feed_forward.mass = 59;
  parameters.feed_forward.wheel_inertia = 0.149;
  parameters.feed_forward.yaw_inertia = 3.5;
  EXPECT_THAT(control_problems(parameters, make_test_robot(), 1e-3), SizeIs(1));
}

// Every value by itself is plausible, and the gains are stable; but they do not hold the robot that is there.
TEST(ControlProblems, RefuseASetThatWouldExceedTheSpeedOnTheDescribedRobot) {
  using Forward = FeedForwardParameters;
  EXPECT_THAT(problems_of(&Forward::wheel_friction, 0.2), IsEmpty());
  EXPECT_THAT(problems_of(&Forward::wheel_friction, 0.2, 0.05),
              ElementsAre(AllOf(HasSubstr("the robot as its description has it would reach"), HasSubstr("3 %"))));
  EXPECT_THAT(problems_of(&Forward::wheel_damping, 0.05, 0.05), SizeIs(1));
  EXPECT_THAT(problems_of(&Forward::mass, 40), SizeIs(1));
}

// What a robot of weak motors does by itself at its own limits is not said of the first set that is given.
TEST(ControlProblems, BlameNoSetForWhatDerivedGainsWouldDoAsWell) {
  RobotModel robot = make_test_robot();
  for (JointModel& joint : robot.joints) joint.effort_limit = 0.2;
  DriveControllerParameters parameters;
  parameters.pid_kp = 2.0;
  parameters.pid_ki = 20.0;
  EXPECT_THAT(control_problems(parameters, robot, 1e-3), IsEmpty());
}

// At 8 m/s² derived gains overshoot a straight stop as well; a turn with four times the yaw inertia is the set's doing.
TEST(ControlProblems, ExcuseNoMotionByWhatDerivedGainsDoInAnother) {
  DriveControllerParameters parameters;
  parameters.max_linear_acceleration = 8;
  EXPECT_THAT(control_problems(parameters, make_test_robot(), 1e-3), IsEmpty());
  parameters.feed_forward.yaw_inertia = 2;
  EXPECT_THAT(control_problems(parameters, make_test_robot(), 1e-3),
              ElementsAre(AllOf(HasSubstr("rad/s on its way to"), HasSubstr("commanded 0 m/s"))));
}

// A ramp to 0.1 m/s ends before the loops have found what is too much; one to 0.3 m/s does not, one to 0.03 is short.
TEST(ControlProblems, RefuseAMassThatIsTooMuchForShortRampsAlone) {
  DriveControllerParameters parameters;
  parameters.max_linear_speed = 0.32;
  parameters.max_linear_acceleration = 1.35;
  EXPECT_THAT(control_problems(parameters, make_test_robot(), 1e-3), IsEmpty());
  parameters.feed_forward.mass = 31.6;
  EXPECT_THAT(control_problems(parameters, make_test_robot(), 1e-3), ElementsAre(HasSubstr("commanded 0.096 m/s")));
}

// It drives back at 0.0305 m/s where it stops; with an exact encoder at less than the 0.03 that are allowed.
TEST(ControlProblems, RefuseASetThatTheCountsOfAnEncoderMakeTooFast) {
  DriveControllerParameters parameters;
  parameters.feed_forward.mass = 8.633;
  parameters.feed_forward.wheel_friction = 0.3;
  EXPECT_THAT(control_problems(parameters, make_test_robot(), 1e-3), ElementsAre(HasSubstr("to rest")));
  parameters.feed_forward.wheel_friction = 0.25;
  EXPECT_THAT(control_problems(parameters, make_test_robot(), 1e-3), IsEmpty());
}

// The simulated pmb2 with such a set turned 12 % too fast at 0.7 of full speed.
TEST(ControlProblems, RefuseAYawInertiaThatIsTooLittleForRampsOfMiddleLength) {
  RobotModel robot = make_test_robot();
  robot.mass = 53;
  robot.yaw_inertia = 2.76;
  robot.wheel_base = 0.4044;
  for (JointModel& joint : robot.joints) joint.effort_limit = 6;
  for (WheelModel& wheel : robot.wheels) wheel.inertia = 0.0129;
  DriveControllerParameters parameters;
  parameters.max_angular_jerk = 1294;
  EXPECT_THAT(control_problems(parameters, robot, 1e-3), IsEmpty());
  parameters.feed_forward.yaw_inertia = 1.5;
  EXPECT_THAT(control_problems(parameters, robot, 1e-3), ElementsAre(HasSubstr("1.4 rad/s (commanded 0 m/s")));
}

// A twentieth of the ground's friction turns the wheels of a skid steer faster than a push of 1 % of its weight does.
TEST(ControlProblems, RefuseGainsThatDoNotHoldASkidSteerWhereItsTreadsGripLess) {
  const RobotModel robot = make_skid_steer();
  DriveControllerParameters parameters;
  const double derived = wheel_loop_gains(parameters, robot, robot.wheels[0], 1e-3).kp;
  parameters.pid_kp = 0.5 * derived;
  EXPECT_THAT(control_problems(parameters, robot, 1e-3), IsEmpty());
  parameters.pid_kp = 0.1 * derived;
  EXPECT_THAT(control_problems(parameters, robot, 1e-3), ElementsAre(HasSubstr("(commanded 0 m/s, ")));
}

// With the ramps of its set the wrong inertia matters little; in the ramp that it meets it does.
TEST(ControlProblems, JudgeASetByTheRampsInWhichItIsTakenOver) {
  const DriveControllerParameters in_force;
  DriveControllerParameters parameters;
  parameters.max_angular_acceleration = 0.2;
  parameters.feed_forward.yaw_inertia = 7 * make_test_robot().yaw_inertia;
  EXPECT_THAT(control_problems(parameters, make_test_robot(), 1e-3), IsEmpty());
  EXPECT_THAT(control_problems(parameters, make_test_robot(), 1e-3, &in_force), ElementsAre(HasSubstr("rad/s")));
  EXPECT_THAT(control_problems(parameters, make_test_robot(), 1e-3, &parameters), IsEmpty());
}

}  // namespace
}  // namespace robot_control

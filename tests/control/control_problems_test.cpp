#include "control/control_problems.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "control/test_robot.h"

namespace robot_control {
namespace {

using testing::AllOf;
using testing::Each;
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

TEST(ControlProblems, RefusesAWheelWithoutTorque) {
  RobotModel robot = make_test_robot();
  robot.joints[1].effort_limit = 0;
  EXPECT_THAT(control_problems({}, robot, 1e-3),
              testing::ElementsAre(
                  AllOf(HasSubstr("right_wheel_joint"), HasSubstr("effort limit"), HasSubstr("wheel_effort_limit"))));
}

TEST(ControlProblems, RefuseAMassThatIsASlipOfThePen) {
  const RobotModel robot = make_test_robot();  // 12 kg
  DriveControllerParameters parameters;
  for (const double mass : {6.0, 40.0}) {
    parameters.feed_forward.mass = mass;
    EXPECT_TRUE(control_problems(parameters, robot, 1e-3).empty()) << mass;
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

}  // namespace
}  // namespace robot_control

/// Real robots (support/robots/corpus.h) against their truth: TRUTH.json, read as the YAML that it is.

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <chrono>
#include <filesystem>

#include "machine/urdf_text.h"
#include "support/message_of.h"
#include "support/robots/corpus.h"

namespace robot_control::tests {

namespace fs = std::filesystem;

constexpr double kOnePercent = 0.01;

std::vector<std::string> robots() {
  std::vector<std::string> names;
  if (corpus().empty()) return {"absent"};
  for (const auto& entry : YAML::LoadFile((corpus() / "TRUTH.json").string())) {
    names.push_back(entry.first.as<std::string>());
  }
  return names;
}

struct RobotCorpus : testing::TestWithParam<std::string> {
  void SetUp() override {
    if (corpus().empty()) GTEST_SKIP() << kNoCorpus;
    truth_ = YAML::LoadFile((corpus() / "TRUTH.json").string())[GetParam()];
    const auto start = std::chrono::steady_clock::now();
    robot_ = read_drive_train(load_description((corpus() / GetParam() / "robot.urdf").string()), {});
    seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }

  std::vector<std::string> joints_of(Side side) const {
    std::vector<std::string> names;
    for (const WheelModel& wheel : robot_.wheels) {
      if (wheel.side == side) names.push_back(robot_.joints[wheel.joint].name);
    }
    return names;
  }

  std::vector<double> signs_of(Side side) const {
    std::vector<double> signs;
    for (const WheelModel& wheel : robot_.wheels) {
      if (wheel.side == side) signs.push_back(wheel.sign);
    }
    return signs;
  }

  YAML::Node truth_;
  DriveTrain robot_;
  double seconds_ = 0;
};

TEST_P(RobotCorpus, StandsMovesAndHasItsRootInItself) {
  for (const RobotNote& note : robot_.notes) {
    for (const char* doubt :
         {"supports it on one side", "accelerate the robot by no more", "farther than the size of the robot"}) {
      EXPECT_EQ(note.text.find(doubt), std::string::npos) << note.element << ": " << note.text;
    }
  }
}

TEST_P(RobotCorpus, IsTheSameRobotOnAFreeJointOfAnEmptyWorld) {
  const RobotDescription description = load_description((corpus() / GetParam() / "robot.urdf").string());
  const DriveTrain free = read_drive_train(on_world(description, robot_.base_link, "floating"), {});
  EXPECT_EQ(free.base_link, robot_.base_link);
  EXPECT_EQ(free.centre_of_gravity_base, robot_.centre_of_gravity_base);
  EXPECT_EQ(free.wheel_base, robot_.wheel_base);
  EXPECT_EQ(free.notes.size(), robot_.notes.size() + 1);
}

TEST_P(RobotCorpus, IsReadAsItIs) {
  EXPECT_EQ(joints_of(Side::kLeft), truth_["left"].as<std::vector<std::string>>());
  EXPECT_EQ(joints_of(Side::kRight), truth_["right"].as<std::vector<std::string>>());
  EXPECT_EQ(signs_of(Side::kLeft), truth_["sign_left"].as<std::vector<double>>());
  EXPECT_EQ(signs_of(Side::kRight), truth_["sign_right"].as<std::vector<double>>());
  const auto base = truth_["separation_wheel_centres"].as<double>();
  const auto radius = truth_["radius_collision"].as<double>();
  EXPECT_NEAR(robot_.wheel_base, base, kOnePercent * base);
  for (const WheelModel& wheel : robot_.wheels) EXPECT_NEAR(wheel.radius, radius, kOnePercent * radius);
  EXPECT_NEAR(robot_.mass, truth_["mass_declared"].as<double>(), 1e-4);  // its digits
  const YAML::Node factor = truth_["icr_factor_1+(L/B)^2"];
  EXPECT_NEAR(robot_.wheel_base_multiplier, factor.IsNull() ? 1 : factor.as<double>(), 1e-3);
}

// The bound is ten-fold: it has to hold in a sanitizer build on a busy machine, too.
TEST_P(RobotCorpus, IsReadInLessThanTwoSeconds) {
  RecordProperty("seconds", std::to_string(seconds_));
  EXPECT_LT(seconds_, 2);
}

TEST_P(RobotCorpus, TwoReadingsAreEqual) {
  const DriveTrain again = read_drive_train(load_description((corpus() / GetParam() / "robot.urdf").string()), {});
  EXPECT_EQ(again.hash, robot_.hash);
  EXPECT_EQ(again.yaw_inertia, robot_.yaw_inertia);
  EXPECT_EQ(again.notes.size(), robot_.notes.size());
}

INSTANTIATE_TEST_SUITE_P(Robots, RobotCorpus, testing::ValuesIn(robots()),
                         [](const auto& robot) { return robot.param; });

std::string refusal_of_robot(const std::string& name) {
  return message_of<RobotError>(
      [&] { read_drive_train(load_description((corpus() / name / "robot.urdf").string()), {}); }, "accepted");
}

TEST(RobotCorpusRefusals, AnEmptyTemplateHasNoWheels) {
  if (corpus().empty()) GTEST_SKIP() << kNoCorpus;
  EXPECT_NE(refusal_of_robot("my_bot").find("no drive wheels found.\nFound: no joint turns"), std::string::npos);
}

TEST(RobotCorpusRefusals, WheelsOnFixedJointsAreNone) {
  if (corpus().empty()) GTEST_SKIP() << kNoCorpus;
  EXPECT_NE(refusal_of_robot("p3dx_amr").find("left_wheel_joint: it is type=\"fixed\""), std::string::npos);
}

}  // namespace robot_control::tests

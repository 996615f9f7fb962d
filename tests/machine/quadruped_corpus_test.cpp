/// Real quadrupeds (support/robots/corpus.h) against their facts: FACTS.json, read as the YAML that it is.

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>

#include "machine/wheeled/drive_train.h"
#include "support/message_of.h"
#include "support/robots/corpus.h"

namespace robot_control::tests {

constexpr double kDigits = 1e-5;  // of the masses in FACTS.json

YAML::Node facts() {
  return YAML::LoadFile((quadrupeds() / "FACTS.json").string());
}

std::vector<std::string> quadruped_names() {
  std::vector<std::string> names;
  if (quadrupeds().empty()) return {"absent"};
  for (const auto& entry : facts()) names.push_back(entry.first.as<std::string>());
  return names;
}

struct QuadrupedCorpus : testing::TestWithParam<std::string> {
  void SetUp() override {
    if (quadrupeds().empty()) GTEST_SKIP() << kNoQuadrupeds;
    facts_ = facts()[GetParam()];
    description_ = load_description((quadrupeds() / GetParam() / "robot.urdf").string());
  }

  YAML::Node facts_;
  RobotDescription description_;
};

TEST_P(QuadrupedCorpus, IsAMachineOfTwelveJointsWithTheLimitsAsWritten) {
  const MachineModel machine = read_machine(description_, {});
  EXPECT_EQ(machine.name, facts_["robot_name"].as<std::string>());
  EXPECT_NEAR(machine.mass, facts_["total_mass"].as<double>(), kDigits);
  EXPECT_EQ(machine.joints.size(), 12u);
  for (const YAML::Node& leg : facts_["legs"]) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto name = leg["joints"][i].as<std::string>();
      const auto joint = std::ranges::find(machine.joints, name, &JointModel::name);
      ASSERT_NE(joint, machine.joints.end()) << name;
      const YAML::Node limits = leg["limits"][i];
      EXPECT_EQ(joint->effort_limit, limits["effort"].as<double>()) << name;
      EXPECT_EQ(joint->velocity_limit, limits["velocity"].as<double>()) << name;
      ASSERT_EQ(joint->range.has_value(), limits["lower"].IsDefined()) << name;
      if (!joint->range) continue;
      EXPECT_EQ(joint->range->lower, limits["lower"].as<double>()) << name;
      EXPECT_EQ(joint->range->upper, limits["upper"].as<double>()) << name;
    }
  }
}

TEST_P(QuadrupedCorpus, MayTouchTheGroundWithTheLastBodyOfEachLeg) {
  const MachineModel machine = read_machine(description_, {});
  EXPECT_EQ(machine.contacts.size(), 4u);
  for (const YAML::Node& leg : facts_["legs"]) {
    const auto last = std::ranges::find(machine.joints, leg["joints"][2].as<std::string>(), &JointModel::name);
    EXPECT_EQ(std::ranges::count(machine.contacts, last->child_link), 1) << last->child_link;
  }
}

TEST_P(QuadrupedCorpus, IsRefusedByTheWheeledKindWithWhatItLookedFor) {
  const std::string message = message_of<RobotError>([&] { read_drive_train(description_, {}); });
  EXPECT_NE(message.find("no drive wheels found."), std::string::npos) << message;
}

INSTANTIATE_TEST_SUITE_P(Robots, QuadrupedCorpus, testing::ValuesIn(quadruped_names()),
                         [](const auto& robot) { return robot.param; });

}  // namespace robot_control::tests

/// Tests the words of inject_fault in both directions, the list of faults, and the messages of refusals.

#include "machine/fault_names.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "signals/names.h"

namespace robot_control::tests {

void add_joint(MachineModel& machine, const std::string& name) {
  machine.joints.emplace_back();
  machine.joints.back().name = name;
}

/// A robot with two wheels on the left, one on the right, a passive joint and a held one.
MachineModel three_wheels() {
  MachineModel machine;
  for (const char* name : {"front", "rear", "lonely", "swivel", "arm"}) add_joint(machine, name);
  machine.joints[3].role = JointRole::kPassive;
  machine.joints[4].role = JointRole::kHeld;
  machine.groups = {{"left", {0, 1}}, {"right", {2}}};
  return machine;
}

struct FaultNames : testing::Test {
  std::string set(const std::string& component, const std::string& kind) {
    return set_fault(faults_, machine_, component, kind);
  }
  FaultKind of(FaultComponent component, std::size_t index = 0) const { return fault_of(faults_, component, index); }
  std::string names() const { return names_of(faults_, machine_); }

  const MachineModel machine_ = three_wheels();
  InjectedFaults faults_{};
};

TEST_F(FaultNames, AHeldJointHasAMotorAndAnEncoderAPassiveOneNone) {
  EXPECT_EQ(set("arm_motor", "off"), "");
  EXPECT_EQ(names(), "arm_motor off");
  EXPECT_NE(set("swivel_motor", "off"), "");
}

TEST_F(FaultNames, SetTheFaultThatTheyNameAndReadBack) {
  EXPECT_EQ(set("gyro", "off"), "");
  EXPECT_EQ(set("monitor", "slow"), "");
  EXPECT_EQ(of(FaultComponent::kGyro), FaultKind::kOff);
  EXPECT_EQ(of(FaultComponent::kMonitor), FaultKind::kSlow);
  EXPECT_EQ(names(), "gyro off, monitor slow");
  EXPECT_EQ(set("gyro", "ok"), "");
  EXPECT_EQ(names(), "monitor slow");
  EXPECT_EQ(set("monitor", "ok"), "");
  EXPECT_EQ(faults_, InjectedFaults{});
  EXPECT_EQ(names(), "none");
}

TEST_F(FaultNames, MeanEachJointOfAGroup) {
  EXPECT_EQ(set("left_encoder", "stuck"), "");
  EXPECT_EQ(of(FaultComponent::kEncoder, 0), FaultKind::kStuck);
  EXPECT_EQ(of(FaultComponent::kEncoder, 1), FaultKind::kStuck);
  EXPECT_EQ(of(FaultComponent::kEncoder, 2), FaultKind::kOk);
  EXPECT_EQ(of(FaultComponent::kMotor, 0), FaultKind::kOk);
  EXPECT_EQ(names(), "left_encoder stuck");
}

TEST_F(FaultNames, MeanAJointAlone) {
  EXPECT_EQ(set("rear_motor", "off"), "");
  EXPECT_EQ(of(FaultComponent::kMotor, 0), FaultKind::kOk);
  EXPECT_EQ(of(FaultComponent::kMotor, 1), FaultKind::kOff);
  EXPECT_EQ(names(), "rear_motor off");
  EXPECT_EQ(set("front_motor", "slow"), "");
  EXPECT_EQ(names(), "rear_motor off, front_motor slow");
  EXPECT_EQ(set("left_motor", "ok"), "");
  EXPECT_EQ(faults_, InjectedFaults{});
}

TEST_F(FaultNames, ReadBackForEveryComponentAndKind) {
  for (const std::string_view component : kFaultComponentNames) {
    const bool joint = component == "encoder" || component == "motor";
    const std::string word = joint ? "right_" + std::string(component) : std::string(component);
    for (const std::string_view kind : kFaultKindNames) {
      faults_ = {};
      ASSERT_EQ(set(word, std::string(kind)), "");
      EXPECT_EQ(names(), kind == "ok" ? "none" : word + " " + std::string(kind));
    }
  }
}

TEST_F(FaultNames, AreListedOnceEachAndAllTaken) {
  const std::vector<std::string> words = fault_words(machine_);
  for (const std::string& word : words) {
    EXPECT_FALSE(components_of(machine_, word).empty()) << word;
    EXPECT_EQ(std::ranges::count(words, word), 1) << word;
  }
  for (const std::string known : {"left_encoder", "right_motor", "gyro", "rear_encoder", "lonely_motor"}) {
    EXPECT_EQ(std::ranges::count(words, known), 1) << known;
  }
  EXPECT_EQ(std::ranges::count(words, "swivel_motor"), 0);
}

TEST_F(FaultNames, MeanTheJointThatHasTheNameOfAGroup) {
  MachineModel machine = three_wheels();
  machine.joints[4].name = "left";
  for (const char* word : {"left_encoder", "front_encoder", "rear_encoder"}) {
    faults_ = {};
    EXPECT_EQ(set_fault(faults_, machine, word, "stuck"), "");
    EXPECT_EQ(names_of(faults_, machine), std::string(word) + " stuck");
    EXPECT_EQ(faults_[1].kind, FaultKind::kOk) << word << " alone";
  }
  faults_ = {};
  set_fault(faults_, machine, "front_encoder", "stuck");
  set_fault(faults_, machine, "rear_encoder", "stuck");
  EXPECT_EQ(names_of(faults_, machine), "front_encoder stuck, rear_encoder stuck");
  const std::vector<std::string> words = fault_words(machine);
  for (const std::string& word : words) EXPECT_EQ(std::ranges::count(words, word), 1) << word;
}

TEST_F(FaultNames, RefuseAnUnknownComponentWithTheList) {
  for (const std::string word : {"wheel", "encoder", "swivel_encoder", "left_gyro", ""}) {
    const std::string message = set(word, "off");
    EXPECT_NE(message.find('"' + word + '"'), std::string::npos) << message;
    for (const char* known : {"left_encoder", "right_motor", "gyro", "e_stop_button", "monitor", "NAME_motor"}) {
      EXPECT_NE(message.find(known), std::string::npos) << message;
    }
  }
  EXPECT_EQ(faults_, InjectedFaults{});
}

TEST_F(FaultNames, RefuseAnUnknownKindWithTheList) {
  const std::string message = set("gyro", "broken");
  EXPECT_NE(message.find("\"broken\""), std::string::npos) << message;
  for (const std::string_view name : kFaultKindNames) EXPECT_NE(message.find(name), std::string::npos) << message;
  EXPECT_EQ(faults_, InjectedFaults{});
}

TEST_F(FaultNames, RefuseMoreThanTheListHolds) {
  MachineModel centipede;
  JointGroup all{"all", {}};
  for (std::size_t joint = 0; joint < kMaxInjectedFaults; ++joint) {
    add_joint(centipede, "leg" + std::to_string(joint));
    all.joints.push_back(joint);
  }
  centipede.groups = {all};
  EXPECT_EQ(set_fault(faults_, centipede, "all_motor", "off"), "");
  const InjectedFaults full = faults_;
  const std::string message = set_fault(faults_, centipede, "gyro", "off");
  EXPECT_NE(message.find("at most 24"), std::string::npos) << message;
  EXPECT_NE(message.find("all_motor off"), std::string::npos) << message;
  EXPECT_EQ(set_fault(faults_, centipede, "all_encoder", "off"), message) << "all or nothing";
  EXPECT_EQ(faults_, full);
  EXPECT_EQ(set_fault(faults_, centipede, "gyro", "ok"), "") << "it is healthy anyway";
  EXPECT_EQ(set_fault(faults_, centipede, "leg7_motor", "slow"), "");
  EXPECT_EQ(set_fault(faults_, centipede, "all_motor", "ok"), "");
  EXPECT_EQ(faults_, InjectedFaults{});
}

}  // namespace robot_control::tests

/// Tests the words of inject_fault in both directions, and the message for an unknown word.

#include <gtest/gtest.h>

#include <cstddef>
#include <set>
#include <string>

#include "signals/names.h"

namespace robot_control {
namespace {

TEST(FaultNames, ReadBackWhatTheyWrite) {
  for (std::size_t i = 0; i < kFaultComponents; ++i) {
    const auto component = static_cast<FaultComponent>(i);
    EXPECT_EQ(fault_component(name_of(component)), component);
  }
  for (std::size_t i = 0; i < kFaultKinds; ++i) {
    const auto kind = static_cast<FaultKind>(i);
    EXPECT_EQ(fault_kind(name_of(kind)), kind);
  }
}

TEST(FaultNames, StandInTheOrderOfTheirEnumerations) {
  EXPECT_EQ(name_of(FaultComponent::kLeftEncoder), "left_encoder");
  EXPECT_EQ(name_of(FaultComponent::kAccelerometer), "accelerometer");
  EXPECT_EQ(name_of(FaultComponent::kMonitor), "monitor");
  EXPECT_EQ(name_of(FaultKind::kOk), "ok");
  EXPECT_EQ(name_of(FaultKind::kGarbage), "garbage");
  EXPECT_EQ(name_of(FaultKind::kIntermittent), "intermittent");
}

TEST(FaultNames, SetTheFaultTheyName) {
  InjectedFaults faults{};
  EXPECT_EQ(set_fault(faults, "gyro", "off"), "");
  EXPECT_EQ(set_fault(faults, "monitor", "slow"), "");
  EXPECT_EQ(fault_of(faults, FaultComponent::kGyro), FaultKind::kOff);
  EXPECT_EQ(fault_of(faults, FaultComponent::kMonitor), FaultKind::kSlow);
  EXPECT_EQ(names_of(faults), "gyro off, monitor slow");
  EXPECT_EQ(set_fault(faults, "gyro", "ok"), "");
  EXPECT_EQ(set_fault(faults, "monitor", "ok"), "");
  EXPECT_EQ(faults, InjectedFaults{});
  EXPECT_EQ(names_of(faults), "none");
}

TEST(FaultNames, RefuseAnUnknownComponentWithTheList) {
  InjectedFaults faults{};
  const std::string message = set_fault(faults, "wheel", "off");
  EXPECT_NE(message.find("\"wheel\""), std::string::npos) << message;
  for (const std::string_view name : kFaultComponentNames) EXPECT_NE(message.find(name), std::string::npos) << message;
  EXPECT_EQ(faults, InjectedFaults{});
}

TEST(FaultNames, RefuseAnUnknownKindWithTheList) {
  InjectedFaults faults{};
  const std::string message = set_fault(faults, "gyro", "broken");
  EXPECT_NE(message.find("\"broken\""), std::string::npos) << message;
  for (const std::string_view name : kFaultKindNames) EXPECT_NE(message.find(name), std::string::npos) << message;
  EXPECT_EQ(faults, InjectedFaults{});
}

TEST(FaultCode, GivesEveryComponentAnOctalDigit) {
  EXPECT_EQ(fault_code({}), 0u);
  InjectedFaults faults{};
  faults[static_cast<std::size_t>(FaultComponent::kGyro)] = FaultKind::kOff;
  faults[static_cast<std::size_t>(FaultComponent::kMonitor)] = FaultKind::kIntermittent;
  EXPECT_EQ(fault_code(faults), 0700000100u);
}

TEST(FaultCode, DistinguishesAnyTwoFaults) {
  std::set<std::uint64_t> codes;
  for (std::size_t component = 0; component < kFaultComponents; ++component) {
    for (std::size_t kind = 1; kind < kFaultKinds; ++kind) {
      InjectedFaults faults{};
      faults[component] = static_cast<FaultKind>(kind);
      codes.insert(fault_code(faults));
    }
  }
  EXPECT_EQ(codes.size(), kFaultComponents * (kFaultKinds - 1));
}

}  // namespace
}  // namespace robot_control

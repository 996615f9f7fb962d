#include "files/ascii.h"

#include <gtest/gtest.h>

#include "machine/wheeled/drive_train.h"
#include "ros/messages/status_messages.h"
#include "ros/reports/diagnostics.h"
#include "signals/names.h"

namespace robot_control::tests {

bool is_ascii(std::string_view text) {
  return std::ranges::all_of(text, [](char c) { return static_cast<unsigned char>(c) < 0x80; });
}

TEST(Ascii, SpellsTheSignsOfUnitsAndSentences) {
  EXPECT_EQ(ascii("2 kg·m², 3 N·m·s/rad, 0.2° off, -10 … 10 m/√m, ±3 → 4"),
            "2 kg*m^2, 3 N*m*s/rad, 0.2 deg off, -10 ... 10 m/sqrt m, +-3 -> 4");
}

TEST(Ascii, LeavesAsciiAsItIs) {
  const std::string text = "refused: \\x41 \"a\"\n\tb~";
  EXPECT_EQ(ascii(text), text);
}

TEST(Ascii, EscapesWhatItDoesNotKnowByteByByte) {
  EXPECT_EQ(ascii("/home/jörg/\xff"), "/home/j\\xC3\\xB6rg/\\xFF");
  EXPECT_EQ(ascii("\xC2"), "\\xC2") << "a sign that is cut short";
}

// Names of joints are a user's; units of causes have powers.
TEST(Ascii, IsAllThatSafetyStatusAndDiagnosticsHold) {
  DriveTrain robot;
  robot.joints.resize(1);
  robot.joints[0].name = "räder_links";
  for (const BitName& row : kStopCauseNames) {
    Permit permit;
    permit.state = SupervisorState::kStopped;
    permit.causes = permit.first_cause = permit.active = permit.warnings = row.bit;
    permit.evidence[0] = {.cause = row.bit, .joint = 0, .value = 2, .limit = 1};
    const SafetyStatus status = safety_status(permit, robot, {}, TimeMap{ClockMode::kLockstep}, 1'000'000, {});
    for (const auto* texts :
         {&status.causes, &status.sentences, &status.remedies, &status.remedies_before_reset, &status.actors,
          &status.details, &status.warnings, &status.warning_sentences, &status.missing, &status.reset_refusal}) {
      for (const std::string& text : *texts) EXPECT_TRUE(is_ascii(text)) << text;
    }
  }
  DiagnosticReport report("node", "robot");
  report.value("key", std::string("17 rad/s²"));
  report.warn("tilt of 20°");
  EXPECT_EQ(report.message().values.at(0).value, "17 rad/s^2");
  EXPECT_EQ(report.message().message, "tilt of 20 deg");
}

TEST(Ascii, IsWhatTheTablesHoldBesideTheirUnits) {
  const auto look = [](std::span<const BitName> table) {
    for (const BitName& row : table) {
      for (const std::string_view text : {row.name, row.sentence, row.remedy, row.actor}) {
        EXPECT_TRUE(is_ascii(text)) << text;
      }
    }
  };
  look(kStopCauseNames);
  look(kResetRefusalNames);
  look(kMissingNodeNames);
  look(kGateReasonNames);
  look(kCommandReasonNames);
  look(kDriverFaultNames);
  look(kStateFlagNames);
  look(kSlipReasonNames);
  look(kDegradedReasonNames);
}

}  // namespace robot_control::tests

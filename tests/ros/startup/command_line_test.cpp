#include "ros/startup/command_line.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace robot_control::tests {

using ::testing::HasSubstr;

std::optional<CommandLineAnswer> answer(std::vector<std::string> words) {
  return answer_command_line("telemetry", "Writes a log.", std::move(words));
}

TEST(CommandLine, WhatRosTakesStartsTheNode) {
  EXPECT_FALSE(answer({}));
  EXPECT_FALSE(answer({"_directory:=logs", "__name:=other", "__ns:=two", "cmd_vel:=nav/cmd_vel"}));
}

TEST(CommandLine, HelpIsTheUsageWhateverStandsBesideIt) {
  for (const std::vector<std::string>& words : {std::vector<std::string>{"--help"}, {"-h"}, {"x", "--help", "a:=b"}}) {
    const auto said = answer(words);
    ASSERT_TRUE(said);
    EXPECT_FALSE(said->refused);
    for (const char* part :
         {"rosrun robot_control telemetry [NAME:=VALUE ...]", "Writes a log.", "docs/parameters.md"}) {
      EXPECT_THAT(said->text, HasSubstr(part));
    }
  }
}

TEST(CommandLine, EverythingElseIsRefusedInOneMessage) {
  const auto said = answer({"--verbose", "_csv:=false", "surplus", ""});
  ASSERT_TRUE(said);
  EXPECT_TRUE(said->refused);
  EXPECT_EQ(said->text,
            "telemetry: refused:\n"
            "argument '--verbose' is unknown; a node takes NAME:=VALUE only\n"
            "argument 'surplus' is unknown; a node takes NAME:=VALUE only\n"
            "argument '' is unknown; a node takes NAME:=VALUE only\n"
            "see rosrun robot_control telemetry --help\n");
}

}  // namespace robot_control::tests

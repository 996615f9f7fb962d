#include "configuration/command_sources.h"

#include <fstream>

#include "configuration/parameters.h"
#include "parameters/problem_list.h"
#include "support/matchers.h"
#include "support/message_of.h"
#include "support/temporary_folder.h"

namespace robot_control::tests {

struct CommandSources : ::testing::Test {
  CommandSourceList read(const std::string& text) {
    const std::string path = folder_.path() / "sources.yaml";
    std::ofstream(path) << text;
    return read_command_sources(path);
  }

  std::string refusal(const std::string& text) {
    return message_of<ParameterError>([&] { read(text); }, "accepted");
  }

  TemporaryFolder folder_;
};

TEST_F(CommandSources, TheShippedListIsTakenHighestPriorityFirst) {
  const CommandSourceList list = read_command_sources(std::string(PROJECT_DIRECTORY) + "/config/command_sources.yaml");
  std::vector<std::string> names;
  for (const CommandSource& source : list.sources) names.push_back(source.name);
  EXPECT_THAT(names, ElementsAre("joy_vel", "key_vel", "console_vel", "cmd_vel", "path_vel"));
  EXPECT_EQ(list.sources[0].priority, 40);
  EXPECT_TRUE(list.sources[0].stamped);
  EXPECT_FALSE(list.sources[3].stamped);
  ASSERT_EQ(list.locks.size(), 1u);
}

TEST_F(CommandSources, AListOfTwistMuxIsTaken) {
  const CommandSourceList list = read(
      "topics:\n- name: navigation\n  topic: nav_vel\n  timeout: 0.5\n  priority: 10\n"
      "- name: tablet\n  topic: tab_vel\n  timeout: 0.5\n  priority: 100\n");
  ASSERT_EQ(list.sources.size(), 2u);
  EXPECT_EQ(list.sources[0].topic, "tab_vel");
  EXPECT_EQ(list.sources[1].timeout, 0.5);
}

TEST_F(CommandSources, EveryProblemIsSaidAtOnce) {
  const std::string text = refusal(
      "topics:\n- {name: a, topic: a_vel, timeout: -1, priority: 300}\n- {name: B, priority: 1, prority: 2}\n- 7\n"
      "muxes: 1\n");
  EXPECT_THAT(text, AllOf(HasSubstr("topics[0].timeout = -1"), HasSubstr("topics[0].priority = 300"),
                          HasSubstr("topics[1].name = B"), HasSubstr("topics[1].topic: missing"),
                          HasSubstr("topics[1].timeout: missing"), HasSubstr("topics[1].prority = 2: unknown key"),
                          HasSubstr("topics[2]"), HasSubstr("muxes: unknown block")));
}

TEST_F(CommandSources, TwoOfOnePriorityNameOrTopicAreRefused) {
  EXPECT_THAT(refusal("topics:\n- {name: a, topic: v, timeout: 1, priority: 1}\n"
                      "- {name: a, topic: v, timeout: 1, priority: 1}\n"),
              AllOf(HasSubstr("topics: name"), HasSubstr("topics: topic"), HasSubstr("topics: priority")));
}

TEST_F(CommandSources, WhatIsNoListIsRefused) {
  for (const char* text : {"", "7", "topics: 7", "topics: []", "locks: []", "topics: [", "topics:\n- {name: [1]}"}) {
    EXPECT_THAT(refusal(text), HasSubstr("command_sources refused")) << text;
  }
  EXPECT_THROW(read_command_sources("/nowhere/sources.yaml"), ParameterError);
}

}  // namespace robot_control::tests

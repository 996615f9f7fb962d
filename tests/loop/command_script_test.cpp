#include "loop/command_script.h"

#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <random>

#include "configuration/parameters.h"
#include "support/allocation_guard.h"
#include "support/damaged_text.h"
#include "support/matchers.h"
#include "support/message_of.h"

namespace robot_control::tests {

constexpr const char* kHealthy =
    "cycle,linear,angular,event\n"
    "0,0.5,0.2,\n"
    "10,0.25,-0.1,\n"
    "20,,,e_stop\n"
    "30,0,0,e_stop_reset\n";

std::string refusal(const std::string& text, std::uint64_t executable = CommandScript::kEveryPart) {
  return message_of<ParameterError>([&] { CommandScript::parse(text, "script.csv", executable); });
}

TEST(CommandScript, RefusesWhatIsNoRegularFile) {
  for (const std::string path : {"/dev/zero", "/tmp", "/nowhere.csv"}) {
    EXPECT_THAT(message_of<ParameterError>([&] { CommandScript{path}; }), HasSubstr(path + ": "));
  }
}

TEST(CommandScript, DeliversARowInItsCycleAndOnlyThere) {
  CommandScript script = CommandScript::parse(kHealthy, "script.csv");
  const ScriptEvents first = script.advance(0);
  EXPECT_TRUE(first.has_twist);
  EXPECT_EQ(first.twists, 1u);
  EXPECT_EQ(first.twist.linear[0], 0.5);
  EXPECT_EQ(first.twist.angular[2], 0.2);
  for (std::uint64_t cycle = 1; cycle < 10; ++cycle) EXPECT_FALSE(script.advance(cycle).has_twist) << cycle;
  EXPECT_EQ(script.advance(10).twist.angular[2], -0.1);
}

TEST(CommandScript, AnEventAloneIsNoVelocityMessage) {
  CommandScript script = CommandScript::parse(kHealthy, "script.csv");
  script.advance(19);
  const ScriptEvents events = script.advance(20);
  EXPECT_FALSE(events.has_twist);
  EXPECT_EQ(events.e_stops, 1u);
  EXPECT_EQ(events.resets, 0u);
}

TEST(CommandScript, AnEventMayComeWithAVelocity) {
  CommandScript script = CommandScript::parse(kHealthy, "script.csv");
  script.advance(29);
  const ScriptEvents events = script.advance(30);
  EXPECT_TRUE(events.has_twist);
  EXPECT_EQ(events.resets, 1u);
}

// Cycles 1 … 29 were skipped: the second velocity and the stop arrive late, and none is lost.
TEST(CommandScript, DeliversTheRowsOfSkippedCyclesTogether) {
  CommandScript script = CommandScript::parse(kHealthy, "script.csv");
  const ScriptEvents events = script.advance(29);
  EXPECT_EQ(events.twists, 2u);
  EXPECT_EQ(events.twist.linear[0], 0.25);
  EXPECT_EQ(events.e_stops, 1u);
}

TEST(CommandScript, ACycleThatComesAgainBringsNothing) {
  CommandScript script = CommandScript::parse(kHealthy, "script.csv");
  script.advance(10);
  EXPECT_FALSE(script.advance(10).has_twist);
  EXPECT_FALSE(script.advance(0).has_twist);
}

TEST(CommandScript, RestartsInANewRun) {
  CommandScript script = CommandScript::parse(kHealthy, "script.csv");
  script.advance(1000);
  script.rewind();
  EXPECT_EQ(script.advance(0).twist.linear[0], 0.5);
}

TEST(CommandScript, DoesNothingWithoutRows) {
  CommandScript script;
  const ScriptEvents events = script.advance(1000);
  EXPECT_FALSE(events.has_twist);
  EXPECT_EQ(events.e_stops + events.resets, 0u);
}

TEST(CommandScript, LetsBadNumbersThroughForTheControllerToRefuse) {
  CommandScript script = CommandScript::parse("cycle,linear,angular\n0,nan,-inf\n", "script.csv");
  const ScriptEvents events = script.advance(0);
  EXPECT_TRUE(std::isnan(events.twist.linear[0]));
  EXPECT_EQ(events.twist.angular[2], -INFINITY);
}

TEST(CommandScript, DoesWithoutTheEventColumnBlanksCommentsAndLineFeeds) {
  CommandScript script =
      CommandScript::parse(" cycle, linear, angular\r\n\r\n# ahead\r\n 5 , 1.0,\t0\r\n", "script.csv");
  EXPECT_EQ(script.size(), 1u);
  EXPECT_EQ(script.advance(5).twist.linear[0], 1.0);
}

TEST(CommandScript, ListsEveryBadLine) {
  const std::string message = refusal(
      "cycle,linear,angular,event\n"
      "-1,0.5,0,\n"
      "10,fast,0x1,\n"
      "5,0.5,0,\n"
      "20,0.5,0\n"
      "30,0.5,0,stop\n"
      "40,,0.1,e_stop\n"
      "50,,,\n");
  EXPECT_THAT(message, HasSubstr("script.csv"));
  EXPECT_THAT(message, HasSubstr("line 2, cycle = -1: must be a whole number of cycles, 0 or more"));
  EXPECT_THAT(message, HasSubstr("line 3, linear = fast: must be a number of m/s"));
  EXPECT_THAT(message, HasSubstr("line 3, angular = 0x1: must be a number of rad/s"));
  EXPECT_THAT(message, HasSubstr("line 4, cycle = 5: must not be less than the cycle before it, 10"));
  EXPECT_THAT(message, HasSubstr("line 5 = 20,0.5,0: must have 4 columns, has 3"));
  EXPECT_THAT(message, HasSubstr("line 6, event = stop: must be empty, e_stop or e_stop_reset"));
  EXPECT_THAT(message, HasSubstr("line 7, linear = (empty): must be a number of m/s"));
  EXPECT_THAT(message, HasSubstr("line 8, linear = (empty): must be a number of m/s"));
  EXPECT_THAT(message, HasSubstr("9 problems"));
}

TEST(CommandScript, RefusesAFileWithoutItsHeader) {
  EXPECT_THAT(refusal(""), HasSubstr("the header line is missing"));
  EXPECT_THAT(refusal("0,0.5,0.2\n"), HasSubstr("line 1, header = 0,0.5,0.2: must be cycle,linear,angular"));
}

TEST(CommandScript, RefusesSpeedsThatTheRobotIgnores) {
  constexpr std::uint64_t kLegs = kPartHeight | kPartMode;
  EXPECT_EQ(CommandScript::parse("cycle,linear,angular\n0,0,0\n", "script.csv", kLegs).size(), 1u);
  EXPECT_THAT(refusal("cycle,linear,angular\n0,0,0\n500,0.5,-1\n", kLegs),
              AllOf(HasSubstr("line 3, linear = 0.5: must be 0, because this robot would ignore it"),
                    HasSubstr("line 3, angular = -1: must be 0")));
}

TEST(CommandScript, ReadsAFile) {
  const std::string path = std::filesystem::temp_directory_path() / ("script_" + std::to_string(getpid()) + ".csv");
  std::ofstream(path) << kHealthy;
  EXPECT_EQ(CommandScript(path).size(), 4u);
  std::remove(path.c_str());
}

TEST(CommandScript, AdvancesWithoutAllocation) {
  CommandScript script = CommandScript::parse(kHealthy, "script.csv");
  AllocationGuard guard;
  for (std::uint64_t cycle = 0; cycle < 100; ++cycle) script.advance(cycle);
  script.rewind();
  EXPECT_EQ(guard.count(), 0u);
}

TEST(CommandScriptFuzz, ReadsOrRefusesWhateverStandsInTheFile) {
  for (unsigned seed = 0; seed < 20000; ++seed) {
    std::mt19937 random(seed);
    try {
      CommandScript script = CommandScript::parse(damaged(kHealthy, random), "script.csv");
      const ScriptEvents events = script.advance(~std::uint64_t{0});
      EXPECT_LE(events.twists + events.e_stops + events.resets, 2 * script.size()) << "seed " << seed;
    } catch (const ParameterError&) {
    } catch (const std::exception& error) {
      FAIL() << "seed " << seed << ": " << error.what();
    }
  }
}

}  // namespace robot_control::tests

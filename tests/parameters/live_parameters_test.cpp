// A request changes values while a node runs: it is accepted as a whole, or refused with every reason.
#include "configuration/live_parameters.h"

#include <chrono>
#include <random>

#include "parameters/parameter_file.h"
#include "parameters/parameter_tree.h"
#include "parameters/schema.h"
#include "support/matchers.h"

namespace robot_control::tests {

const std::string kBlock = "diff_drive_controller";

/// The healthy case has the shipped values in force. Each test spoils one thing of a request.
struct LiveParameters : ::testing::Test {
  LiveChange read(const std::string& request) const { return read_live(base, kBlock, request); }

  /// The only problem, if it is the only one.
  std::string problem(const std::string& request) const {
    const std::vector<std::string> problems = read(request).problems;
    EXPECT_EQ(problems.size(), 1u) << ::testing::PrintToString(problems);
    return problems.empty() ? "" : problems.front();
  }

  Parameters base = read_parameters(shipped_path());
};

TEST_F(LiveParameters, TakesAnySetOfLimitsAndGains) {
  const LiveChange change = read("{max_linear_speed: 0.5, keep_curvature: no, pid_kp: 1.5, feed_forward: {mass: 13}}");
  EXPECT_THAT(change.problems, IsEmpty());
  const DriveControllerParameters& controller = change.parameters.controller;
  EXPECT_EQ(controller.max_linear_speed, 0.5);
  EXPECT_FALSE(controller.keep_curvature);
  EXPECT_EQ(controller.pid_kp, 1.5);
  EXPECT_EQ(controller.feed_forward.mass, 13);
  EXPECT_EQ(controller.max_angular_speed, base.controller.max_angular_speed);
  EXPECT_EQ(controller.pid_ki, std::nullopt) << "what was left out stays left out";
}

TEST_F(LiveParameters, SaysWhatWasAndWhatIs) {
  const LiveChange change = read("{feed_forward: {mass: 13}, pid_kp: 1.5, keep_curvature: off, max_linear_speed: 2}");
  std::vector<std::string> reported;
  for (const LiveValue& value : change.values) reported.push_back(value.key + " " + value.before + " " + value.after);
  EXPECT_THAT(reported, ElementsAre("max_linear_speed 1 2", "keep_curvature true false", "pid_kp derived 1.5",
                                    "feed_forward.mass derived 13"));
}

TEST_F(LiveParameters, LaysARequestOverTheLastOne) {
  base = read("{pid_kp: 1.5, max_linear_deceleration: 0.7}").parameters;
  const LiveChange next = read("max_linear_jerk: 3");  // block style is YAML, too
  EXPECT_THAT(next.problems, IsEmpty());
  EXPECT_EQ(next.parameters.controller.pid_kp, 1.5);
  EXPECT_EQ(next.parameters.controller.max_linear_deceleration, 0.7);
  EXPECT_EQ(next.parameters.controller.max_linear_jerk, 3);
}

// The values in force are written and read back for that, and must be the same numbers.
TEST_F(LiveParameters, KeepEveryBitThatHoldsWhereARequestIsRefused) {
  base.controller.max_linear_acceleration = 0.1 + 0.2;
  base.controller.pid_kp = 1.0 / 3;
  base.controller.pid_ki = 1e-7;
  for (const Block& block : blocks()) {
    if (block.name != kBlock) continue;
    for (const Key& key : block.keys) {
      if ((key.traits & kLive) == 0) continue;
      const LiveChange change = read("{" + path_of(block, key).substr(kBlock.size() + 1) + ": x}");
      EXPECT_EQ(change.problems.size(), 1u) << key.name;
      EXPECT_EQ(parameters_text(change.parameters), parameters_text(base));
    }
  }
}

TEST_F(LiveParameters, RefusesWithTheRulesOfTheStart) {
  EXPECT_THAT(problem("{max_linear_speed: -1}"),
              "diff_drive_controller.max_linear_speed = -1: must be a number of 0.001 … 50 m/s [request]");
  EXPECT_THAT(problem("{pid_kp: .nan}"), AllOf(HasSubstr("pid_kp = .nan: must be finite"), HasSubstr("N·m·s/rad")));
  EXPECT_THAT(problem("{pid_kd: .inf}"), HasSubstr("must be finite"));
  EXPECT_THAT(problem("{pid_kp: \"1\"}"), HasSubstr("must be a number"));
  EXPECT_THAT(problem("{pid_kp: }"), HasSubstr("pid_kp = (nothing): must be a number"));
  EXPECT_THAT(problem("{pid_kp: [1, 2]}"), HasSubstr("pid_kp = [1, 2]: must be a number"));
  EXPECT_THAT(problem("{keep_curvature: 2}"), HasSubstr("true or false"));
  EXPECT_THAT(problem("{cmd_vel_timeout: 0.0015}"), HasSubstr("two periods, 0.002 s at 1000 Hz"));
  EXPECT_THAT(problem("{feed_forward: 12}"), HasSubstr("must be a map of mass"));
  EXPECT_THAT(problem("{feed_forward: {}}"), HasSubstr("names no value"));
}

TEST_F(LiveParameters, RefusesContradictionsWithWhatHolds) {
  EXPECT_EQ(problem("{max_linear_emergency_deceleration: 0.9}"),
            "diff_drive_controller.max_linear_emergency_deceleration = 0.9: must not be below "
            "diff_drive_controller.max_linear_acceleration = 1 [in force] [request]");
  base.controller.max_angular_emergency_deceleration = 8;
  EXPECT_THAT(problem("{max_angular_acceleration: 9}"),
              AllOf(HasSubstr("= 8: must not be below"), HasSubstr("max_angular_acceleration = 9 [request]")));
  EXPECT_THAT(read("{max_angular_acceleration: 9, max_angular_emergency_deceleration: 9}").problems, IsEmpty());
}

TEST_F(LiveParameters, RefusesWhatIsReadAtStartAlone) {
  EXPECT_THAT(problem("{command_rate: 100}"),
              AllOf(HasSubstr("command_rate = 100: is read only at start"), HasSubstr("restart the node")));
}

TEST_F(LiveParameters, RefusesUnknownKeysAndMeansTheNearest) {
  EXPECT_THAT(problem("{max_liner_speed: 1}"), AllOf(HasSubstr("unknown key"), HasSubstr("mean max_linear_speed?")));
  EXPECT_THAT(problem("{rate: 500}"), HasSubstr("unknown key"));
  EXPECT_THAT(problem("{feed_forward: {weight: 3}}"), HasSubstr("diff_drive_controller.feed_forward.weight = 3"));
  EXPECT_THAT(problem("{pid_kp: {p: 3}}"), HasSubstr("pid_kp = (a block): must be a number"));
  EXPECT_THAT(problem("{pid_kp: 1, pid_kp: 2}"), HasSubstr("given twice"));
  EXPECT_THAT(problem("{? [pid_kp] : 1}"), HasSubstr("a key must be a plain word"));
}

TEST_F(LiveParameters, RefusesAKeyInBothItsSpellings) {
  EXPECT_EQ(problem("{feed_forward.mass: 13, feed_forward: {mass: 15}}"),
            "diff_drive_controller.feed_forward.mass = 15: given twice, first as 13 [request]; remove one");
  EXPECT_THAT(problem("{feed_forward: {mass: 15}, feed_forward.mass: 15}"), HasSubstr("given twice, first as 15"));
  EXPECT_THAT(read("{feed_forward.mass: 13, feed_forward: {yaw_inertia: 1}}").problems, IsEmpty());
}

TEST_F(LiveParameters, RefusesWhatIsNoMap) {
  for (const char* text : {"", " ", "{}", "[]", "[max_linear_speed, 1]", "max_linear_speed", "1", "~", "---", "# none",
                           "{a: 1}\n---\n{b: 2}", "{", "}", "{pid_kp: 1", ",", "\"", "{pid_kp: *x}", "!!map"}) {
    EXPECT_THAT(problem(text), HasSubstr("must be a YAML map of keys of diff_drive_controller")) << text;
  }
}

TEST_F(LiveParameters, QuotesWhatWasSentUpToAWholeCharacter) {
  const std::string start(199, 'x');
  EXPECT_THAT(problem(start + "éx"), HasSubstr("request = " + start + "…: "));
}

TEST_F(LiveParameters, ReportsEveryReasonAtOnce) {
  const LiveChange change =
      read("{max_linear_speed: 0, pid_kp: .nan, command_rate: 1, cmd_vel_timeout: 0.001, typo: 1}");
  EXPECT_EQ(change.problems.size(), 5u) << ::testing::PrintToString(change.problems);
}

TEST_F(LiveParameters, RefusesDeepAndHugeTextsAtOnce) {
  const auto begin = std::chrono::steady_clock::now();
  const std::string deep(kMaxRequest / 2, '[');
  for (const std::string& text :
       {deep, "{pid_kp: " + deep, std::string(kMaxRequest / 2, '{'), std::string(kMaxRequest, '-'),
        std::string(kMaxRequest, '?'), std::string(kMaxRequest, '&'), std::string(kMaxRequest, '\n'),
        std::string(kMaxRequest, '\t'), std::string("\0\0\0", 3), std::string("\xff\xfe{\0}\0", 6),
        std::string(100 << 20, 'x'), "{pid_kp: " + std::string(kMaxRequest, '1') + "}"}) {
    EXPECT_FALSE(read(text).problems.empty());
  }
  // No message may hold the node's thread; 100 MB are compared with one number. The bound allows for sanitizers and
  // stalls.
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(60));
}

class LiveParametersFuzz : public LiveParameters, public testing::WithParamInterface<unsigned> {};
INSTANTIATE_TEST_SUITE_P(EveryDay, LiveParametersFuzz, testing::Values(1500u));
INSTANTIATE_TEST_SUITE_P(Nightly, LiveParametersFuzz, testing::Values(6000u));

TEST_P(LiveParametersFuzz, AreTakenOrRefusedWhateverStandsInTheRequest) {
  const std::string good =
      "{max_linear_speed: 0.5, keep_curvature: true, cmd_vel_timeout: 1.0, pid_kp: 1.5, feed_forward: {mass: 13.0}}";
  const std::string_view marks = ":#-[]{}\"'\n \t,!&*|>%@?.~\0\xff";
  int taken = 0, refused = 0;
  for (unsigned seed = 0; seed < GetParam(); ++seed) {
    std::mt19937 random(seed);
    const auto pick = [&](std::size_t bound) {
      return std::uniform_int_distribution<std::size_t>(0, bound - 1)(random);
    };
    std::string text = good;
    if (seed % 4 == 0) {  // nothing but noise
      text.clear();
      for (std::size_t i = pick(200); i > 0; --i) text += static_cast<char>(pick(256));
    }
    for (std::size_t count = 1 + pick(6); count > 0; --count) {
      const std::size_t place = pick(text.size() + 1);
      if (pick(2) == 0) {
        text.insert(place, pick(8) == 0 ? pick(600) : 1, marks[pick(marks.size())]);
      } else {
        text.erase(place, pick(8));
      }
    }
    try {
      const LiveChange change = read(text);
      change.problems.empty() ? ++taken : ++refused;
      if (change.problems.empty()) {
        EXPECT_FALSE(change.values.empty()) << "seed " << seed;
      }
    } catch (const std::exception& error) {
      FAIL() << "seed " << seed << ": " << error.what();
    }
  }
  EXPECT_GT(taken, static_cast<int>(GetParam() / 120)) << "else this says nothing about what is taken";
  EXPECT_GT(refused, static_cast<int>(GetParam() / 3));
}

}  // namespace robot_control::tests

// Conditions of the safety monitor: maps of limit, persistence and reaction.
#include "configuration/parameters.h"
#include "parameters/parameter_file.h"
#include "parameters/suggestion.h"
#include "support/matchers.h"

namespace robot_control::tests {

/// The healthy case is a copy of the shipped file. Each test spoils one thing.
struct ReadConditions : ::testing::Test {
  std::string at(const std::string& group) const {
    return "[" + file.path() + ":" + std::to_string(file.line_of("  " + group + ":")) + "]";
  }

  void set(const std::string& group, const std::string& value) { file.set(group, "  " + group + ": " + value); }

  Condition tilt(const std::vector<Overlay>& overlays = {}) const {
    return read_parameters(file.path(), overlays).safety.tilt;
  }

  ParameterFile file;
};

TEST_F(ReadConditions, ReadsAMapOnOneLineOrOnMany) {
  set("tilt", "{limit: 0.3, persistence: 0.2, reaction: ramp}");
  EXPECT_THAT(tilt().limit, Optional(0.3));
  EXPECT_EQ(tilt().persistence, 0.2);
  EXPECT_EQ(tilt().reaction, Reaction::kRamp);
  set("tilt", "\n    limit: 0.4\n    persistence: 0\n    reaction: slow");
  EXPECT_THAT(tilt().limit, Optional(0.4));
  EXPECT_EQ(tilt().persistence, 0);
  EXPECT_EQ(tilt().reaction, Reaction::kSlow);
}

TEST_F(ReadConditions, KnowsEveryReaction) {
  const std::vector<std::pair<std::string, Reaction>> words{{"off", Reaction::kOff},
                                                            {"warn", Reaction::kWarn},
                                                            {"slow", Reaction::kSlow},
                                                            {"ramp", Reaction::kRamp},
                                                            {"brake", Reaction::kBrake}};
  for (const auto& [word, reaction] : words) {
    file.set_in("tilt", "reaction", word);
    EXPECT_EQ(tilt().reaction, reaction) << word;
  }
}

// The parameter server and PyYAML follow YAML 1.1, where a plain `off` is a boolean.
TEST_F(ReadConditions, TakesTheBooleanThatYaml11MakesOfOff) {
  EXPECT_EQ(tilt({{"safety_monitor.tilt.reaction", "false", "server"}}).reaction, Reaction::kOff);
}

TEST_F(ReadConditions, LeavesTheLimitToTheRobotWhereItFollowsFromIt) {
  for (const char* group : {"wheel_speed", "wheel_acceleration", "power", "stall", "runaway", "not_stopping",
                            "battery_low", "battery_empty"}) {
    ParameterFile one;
    one.set(group, std::string("  ") + group + ": {persistence: 0.1, reaction: warn}");
    EXPECT_EQ(one.refusal(), "") << group;
  }
  EXPECT_FALSE(read_parameters(file.path()).safety.wheel_speed.limit);
  set("wheel_speed", "{limit: 20, persistence: 0.1, reaction: warn}");
  EXPECT_THAT(read_parameters(file.path()).safety.wheel_speed.limit, Optional(20.0));
}

TEST_F(ReadConditions, AsksForTheLimitThatIsNotDerived) {
  set("tilt", "{persistence: 0.1, reaction: warn}");
  EXPECT_THAT(file.refusal(),
              HasSubstr("safety_monitor.tilt.limit: missing " + at("tilt") + "; add it: a number of 0.01 … 1.5 rad"));
}

TEST_F(ReadConditions, RefusesALimitWhereThereIsNone) {
  set("imu_lost", "{limit: 3, persistence: 0.1, reaction: warn}");
  EXPECT_THAT(file.refusal(), HasSubstr("safety_monitor.imu_lost.limit = 3: unknown key " + at("imu_lost")));
  EXPECT_EQ(problems_in(file.refusal()), 1u) << file.refusal();
}

TEST_F(ReadConditions, NamesEveryWrongValueWithItsLine) {
  set("tilt", "{limit: steep, persistence: -1, reaction: halt, presistence: 3}");
  const std::string message = file.refusal();
  EXPECT_THAT(message,
              HasSubstr("safety_monitor.tilt.limit = steep: must be a number of 0.01 … 1.5 rad " + at("tilt")));
  EXPECT_THAT(message, HasSubstr("safety_monitor.tilt.persistence = -1: must be a number of 0 … 60 s " + at("tilt")));
  EXPECT_THAT(message, HasSubstr("safety_monitor.tilt.reaction = halt: must be one of off, warn, slow, ramp, brake"));
  EXPECT_THAT(message, HasSubstr("safety_monitor.tilt.presistence = 3: unknown key " + at("tilt") +
                                 "; did you mean tilt.persistence?"));
  EXPECT_EQ(problems_in(message), 4u) << message;
}

TEST_F(ReadConditions, AMissingConditionIsOneProblem) {
  file.set("tilt", "");
  EXPECT_THAT(file.refusal(), HasSubstr("safety_monitor.tilt: missing [" + file.path() +
                                        "]; add it: a map of limit, persistence, reaction"));
  EXPECT_EQ(problems_in(file.refusal()), 1u) << file.refusal();
}

TEST_F(ReadConditions, RefusesWhatIsNoMap) {
  for (const char* value : {"0.35", "[0.35]", "brake", "~", "\"\""}) {
    set("tilt", value);
    EXPECT_THAT(file.refusal(), HasSubstr(": must be a map of limit, persistence, reaction " + at("tilt"))) << value;
    EXPECT_EQ(problems_in(file.refusal()), 1u) << file.refusal();
  }
  EXPECT_THAT(file.refusal({{"safety_monitor.tilt", "0.3", "/safety_monitor/tilt"}}),
              HasSubstr("safety_monitor.tilt = 0.3: must be a map of limit, persistence, reaction "
                        "[/safety_monitor/tilt]"));
}

TEST_F(ReadConditions, RefusesAMapWhereAScalarBelongs) {
  file.set("ramp_time", "  ramp_time: {limit: 2, reaction: brake}");
  EXPECT_THAT(file.refusal(),
              HasSubstr("safety_monitor.ramp_time = (a block): must be a number of 0.01 … 60 s " + at("ramp_time")));
  EXPECT_EQ(problems_in(file.refusal()), 1u) << file.refusal();
}

TEST_F(ReadConditions, RefusesAMapWithinAValue) {
  file.set_in("tilt", "limit", "{a: 1");  // the brace that follows the value closes it
  EXPECT_NE(file.refusal(), "");
  set("tilt", "{limit: {a: 1}, persistence: 0, reaction: brake}");
  EXPECT_THAT(file.refusal(), HasSubstr("safety_monitor.tilt.limit = (a block): must be a number"));
  EXPECT_EQ(problems_in(file.refusal()), 1u) << file.refusal();
}

TEST_F(ReadConditions, SuggestsTheConditionThatWasMeant) {
  Parameters parameters;
  const Schema all = schema(parameters);
  set("tilt", "{limit: 0.35, persistence: 0.05, reaction: brake}\n  tpi_over: {limit: 1, persistence: 0}");
  EXPECT_THAT(file.refusal(), HasSubstr("safety_monitor.tpi_over = (a block): unknown key " + at("tpi_over") +
                                        "; did you mean tip_over?"));
  EXPECT_EQ(problems_in(file.refusal()), 1u) << file.refusal();
  EXPECT_EQ(suggest_key(all, "safety_monitor.tilt.limti"), "did you mean tilt.limit?");
  EXPECT_EQ(suggest_key(all, "robot.tip_over.limit"), "did you mean safety_monitor.tip_over.limit?");
}

TEST_F(ReadConditions, RefusesAKeyGivenTwice) {
  set("tilt", "{limit: 0.35, persistence: 0.05, reaction: brake, limit: 0.3}");
  EXPECT_THAT(file.refusal(), HasSubstr("safety_monitor.tilt.limit: given twice"));
  set("tilt", "{limit: 0.35, persistence: 0.05, reaction: brake}\n  tilt.limit: 0.3");
  EXPECT_THAT(file.refusal(), HasSubstr("safety_monitor.tilt.limit: given twice, first at " + file.path()));
}

TEST_F(ReadConditions, AnOverlaySetsOneValueAndLeavesTheOthers) {
  set("tilt", "{limit: 0.35, persistence: 0.07, reaction: ramp}");
  for (const Overlay& overlay : {Overlay{"safety_monitor.tilt.limit", "0.3", "/safety_monitor/tilt/limit"},
                                 Overlay{"safety_monitor.tilt", "{limit: 0.3}", "ClosedLoop"}}) {
    EXPECT_THAT(tilt({overlay}).limit, Optional(0.3)) << overlay.path;
    EXPECT_EQ(tilt({overlay}).persistence, 0.07) << overlay.path;
    EXPECT_EQ(tilt({overlay}).reaction, Reaction::kRamp) << overlay.path;
  }
}

TEST_F(ReadConditions, OverlaysMayBringAWholeCondition) {
  file.set("tilt", "");
  std::vector<Overlay> overlays{{"safety_monitor.tilt.limit", "0.3", "server"},
                                {"safety_monitor.tilt.persistence", "0", "server"}};
  EXPECT_THAT(file.refusal(overlays), HasSubstr("safety_monitor.tilt.reaction: missing"));
  overlays.push_back({"safety_monitor.tilt.reaction", "warn", "server"});
  EXPECT_EQ(tilt(overlays).reaction, Reaction::kWarn);
}

TEST_F(ReadConditions, RefusesAnUnknownConditionOfTheServer) {
  EXPECT_THAT(file.refusal({{"safety_monitor.tlit.limit", "0.3", "/safety_monitor/tlit/limit"}}),
              HasSubstr("safety_monitor.tlit.limit = 0.3: unknown key [/safety_monitor/tlit/limit]; "
                        "did you mean tilt.limit?"));
}

TEST_F(ReadConditions, RefusesABatteryThatIsEmptyBeforeItIsLow) {
  set("battery_low", "{limit: 11, persistence: 1, reaction: slow}");
  EXPECT_EQ(file.refusal(), "");
  set("battery_empty", "{limit: 11, persistence: 1, reaction: ramp}");
  EXPECT_THAT(file.refusal(), HasSubstr("safety_monitor.battery_empty.limit = 11: must be below "
                                        "safety_monitor.battery_low.limit = 11 " +
                                        at("battery_low") + " " + at("battery_empty")));
  set("battery_empty", "{limit: 10.5, persistence: 1, reaction: ramp}");
  EXPECT_EQ(file.refusal(), "");
}

TEST_F(ReadConditions, RefusesAStopThatIsFasterThanTheLoop) {
  file.set("rate", "  rate: 200");
  file.set("ramp_time", "  ramp_time: 2\n  stop_delay: 0.014");
  EXPECT_THAT(file.refusal(), HasSubstr("safety_monitor.stop_delay = 0.014: must be at least three periods, 0.015 s "
                                        "at 200 Hz: no stop is faster " +
                                        at("stop_delay")));
  file.set("stop_delay", "  stop_delay: 0.015");
  EXPECT_THAT(file.refusal(), Not(HasSubstr("stop_delay")));
}

TEST(ConditionPaths, NameConditionAndKey) {
  const std::vector<std::string> paths = parameter_paths();
  EXPECT_THAT(paths, ::testing::IsSupersetOf({"safety_monitor.tilt.limit", "safety_monitor.tilt.persistence",
                                              "safety_monitor.imu_lost.reaction"}));
  EXPECT_THAT(paths, Not(::testing::Contains("safety_monitor.imu_lost.limit")));
}

}  // namespace robot_control::tests

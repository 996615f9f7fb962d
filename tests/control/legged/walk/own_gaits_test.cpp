// Gaits of the user's own: maps gait_1 … gait_4 of the leg controller.
#include "control/legged/walk/own_gaits.h"

#include <yaml-cpp/yaml.h>

#include "control/legged/walk/gait_table.h"
#include "parameters/parameters_text.h"
#include "parameters/tree_reader.h"
#include "support/matchers.h"

namespace robot_control::tests {

/// The healthy case is one gait. Each test spoils one thing.
struct OwnGaitsTest : ::testing::Test {
  /// Reads the gaits of these lines; the last one of a path counts.
  void read(const std::vector<Overlay>& changes = {}) {
    std::vector<Overlay> all{
        {"legs.gait_2", "{name: amble, period: 0.5, duty: 0.6, phases: [0, 0.5, 0.75, 0.25], lift: 0.05}", "me"}};
    for (const Overlay& change : changes) all.push_back({"legs." + change.path, change.text, "me"});
    ProblemList found;
    read(read_tree("", all, found, nullptr), found);
  }
  void read(const ParameterTree& tree, ProblemList& found) {
    gaits = {};
    read_blocks(tree, schema, schema.blocks, "me", found);
    problems = found.lines();
  }
  Gaits all() const { return all_gaits(gaits); }

  OwnGaits gaits;
  Schema schema{.blocks = {{"legs", keys(gaits)}},
                .check = [this](const Schema&, GivenValues& given) { check(gaits, "legs", given); }};
  std::vector<std::string> problems;
};

TEST_F(OwnGaitsTest, FollowThoseOfTheTable) {
  read();
  ASSERT_THAT(problems, IsEmpty());
  ASSERT_EQ(all().size(), kGaits.size() + 1);
  const Gait own = all().back();
  EXPECT_STREQ(own.name.data(), "amble");
  EXPECT_EQ(own.period, 0.5);
  EXPECT_EQ(own.duty, 0.6);
  EXPECT_THAT(own.phase, ElementsAre(0, 0.5, 0.75, 0.25));
  EXPECT_EQ(own.lift, 0.05);
  EXPECT_THAT(gait_words(all()), ElementsAre("auto", "trot", "walking_trot", "crawl", "amble"));
}

TEST_F(OwnGaitsTest, AreInTheTextFromWhichAReplayIsComposed) {
  read();
  const Gait own = all().back();
  const std::string text = blocks_text(schema.blocks);
  ParameterTree tree;
  ProblemList found;
  read_document(YAML::Load(text), "me", {}, tree, found);
  read(tree, found);
  EXPECT_THAT(problems, IsEmpty());
  EXPECT_EQ(blocks_text(schema.blocks), text);
  EXPECT_EQ(all().back().phase, own.phase);
}

TEST_F(OwnGaitsTest, MayHaveTheEndsOfTheirRangesAndNothingBeyond) {
  read({{"gait_1", "{name: small, period: 0.1, duty: 0.5, phases: [0, 0.5, 0.5, 1], lift: 0.01}", {}},
        {"gait_3", "{name: large, period: 3, duty: 0.95, phases: [0, 0.5, 0.5, 1], lift: 0.12}", {}}});
  EXPECT_THAT(problems, IsEmpty());
  struct Case {
    const char *key, *below, *above, *rule;
  };
  for (const Case& one : {Case{"period", "0.099", "3.01", "a number of 0.1 … 3 s"},
                          {"duty", "0.499", "0.951", "a number of 0.5 … 0.95"},
                          {"lift", "0.0099", "0.121", "a number of 0.01 … 0.12 m"},
                          {"phases", "[-0.01, 0, 0.5, 0.5]", "[0, 0, 0.5, 1.01]", "four numbers, each of 0 … 1"}})
    for (const std::string value : {one.below, one.above}) {
      const std::string path = std::string("gait_2.") + one.key;
      read({{path, value, {}}});
      EXPECT_THAT(problems, ElementsAre(AllOf(StartsWith("legs." + path + " = " + value), HasSubstr(one.rule))));
    }
}

TEST_F(OwnGaitsTest, AreRefusedWithPathRuleAndRemedy) {
  const auto expect = [&](const std::vector<Overlay>& changes, const std::vector<std::string>& words) {
    read(changes);
    for (const std::string& word : words) EXPECT_THAT(problems, ElementsAre(HasSubstr(word)));
  };
  expect({{"gait_2.phases", "[0, 0.5, 0]", {}}}, {"gait_2.phases", "a list of four numbers"});
  expect({{"gait_2.dutty", "0.6", {}}}, {"gait_2.dutty = 0.6: unknown key"});
  expect({{"gait_5", "{name: fifth}", {}}}, {"gait_5", "unknown key"});
  expect({{"gait_3", "5", {}}}, {"gait_3 = 5: must be a map of name, period, duty, phases, lift"});
  expect({{"gait_3", "{name: pace, duty: 0.5}", {}}}, {"gait_3.name = pace", "add period, phases, lift"});
  expect({{"gait_3", "{lift: 0.05}", {}}}, {"gait_3.lift = 0.05", "add name, period, duty, phases"});
  for (const char* name : {"auto", "stand", "trot", "crawl"})
    expect({{"gait_2.name", name, {}}},
           {std::string("gait_2.name = ") + name, "is already the name of a gait", "another name"});
  for (const char* name : {"Amble", "an amble", "an_amble_with_17b", "\"ämble\""})
    expect({{"gait_2.name", name, {}}}, {"gait_2.name", "must be at most 16 of a … z, 0 … 9 and _"});
  expect({{"gait_4", "{name: amble, period: 0.5, duty: 0.6, phases: [0, 0.5, 0.75, 0.25], lift: 0.05}", {}}},
         {"gait_4.name = amble", "is already the name of a gait"});
  expect({{"gait_2.period", "0.12", {}}}, {"gait_2.period = 0.12", "less than 0.05 s", "set a longer period"});
  expect({{"gait_2.phases", "[0, 0, 0, 0]", {}}},
         {"gait_2.phases", "two feet", "duty 0.6 they leave 0", "set a larger duty"});
  expect({{"gait_2.phases", "[0, 0, 0.25, 0.5]", {}}}, {"they leave 1"});
}

std::string gait_of(const std::string& phases, double period, double alone) {
  return "{name: own, period: " + std::to_string(period) + ", duty: " + std::to_string(1 - alone / period) +
         ", phases: " + phases + ", lift: 0.05}";
}

TEST_F(OwnGaitsTest, AreRefusedIfTheyTipOver) {
  const std::string pace = "[0.5, 0, 0.5, 0]", bound = "[0, 0, 0.5, 0.5]", trot = "[0.5, 0, 0, 0.5]";
  struct Case {
    std::string phases;
    double period, alone;
    bool tips;
  };
  // √(h/g) = 0.1744 s: 0.122 and 0.0698 s of a side, 0.183 and 0.1046 s of front and rear.
  for (const Case& gait :
       {Case{pace, 0.36, 0.18, true}, Case{pace, 0.5, 0.121, false}, Case{pace, 0.5, 0.123, true},
        Case{pace, 0.2, 0.083, false}, Case{pace, 0.2, 0.084, true}, Case{bound, 0.36, 0.18, true},
        Case{bound, 0.7, 0.182, false}, Case{bound, 0.7, 0.184, true}, Case{bound, 0.3, 0.125, false},
        Case{bound, 0.3, 0.126, true}, Case{trot, 0.8, 0.4, false}}) {
    SCOPED_TRACE(gait.phases + " " + std::to_string(gait.period) + " " + std::to_string(gait.alone));
    const std::vector<Overlay> changes{{"gait_3", gait_of(gait.phases, gait.period, gait.alone), {}}};
    read(changes);
    if (!gait.tips) {
      EXPECT_EQ(all().size(), kGaits.size() + 2);
      EXPECT_THAT(problems, IsEmpty());
      continue;
    }
    EXPECT_THAT(problems,
                ElementsAre(AllOf(HasSubstr("gait_3.duty = "), HasSubstr("set a larger duty or a shorter period"))));
  }
  read({{"gait_3", gait_of(pace, 0.36, 0.18), {}}});
  EXPECT_THAT(problems,
              ElementsAre(HasSubstr("lets the feet of one side are in stance by themselves for 0.18 s, in 1 of the "
                                    "period, so the body tips over: at most 0.122 s, and time · part of the period at "
                                    "most 0.07 s")));
}

}  // namespace robot_control::tests

// Gaits of the user's own: maps gait_1 … gait_4 of the leg controller.
#include "control/legged/walk/gait_table.h"
#include "parameters/parameter_file.h"
#include "support/matchers.h"

namespace robot_control::tests {

/// The healthy case is the shipped file with one gait. Each test spoils one thing.
struct OwnGaitsTest : ::testing::Test {
  Parameters read(const std::vector<Overlay>& changes = {}) const {
    return read_parameters(file.path(), laid(changes));
  }
  std::string refusal(const std::vector<Overlay>& changes) const { return file.refusal(laid(changes)); }

  static std::vector<Overlay> laid(const std::vector<Overlay>& changes) {
    std::vector<Overlay> all{{"leg_controller.gait_2",
                              "{name: amble, period: 0.5, duty: 0.6, phases: [0, 0.5, 0.75, 0.25], lift: 0.05}", "me"}};
    for (const Overlay& change : changes) all.push_back({"leg_controller." + change.path, change.text, "me"});
    return all;
  }

  ParameterFile file;
};

TEST_F(OwnGaitsTest, FollowThoseOfTheTable) {
  const Gaits gaits = all_gaits(read().leg_control.gaits);
  ASSERT_EQ(gaits.size(), kGaits.size() + 1);
  EXPECT_STREQ(gaits.back().name.data(), "amble");
  EXPECT_EQ(gaits.back().period, 0.5);
  EXPECT_EQ(gaits.back().duty, 0.6);
  EXPECT_THAT(gaits.back().phase, ElementsAre(0, 0.5, 0.75, 0.25));
  EXPECT_EQ(gaits.back().lift, 0.05);
  EXPECT_THAT(gait_words(gaits), ElementsAre("auto", "trot", "walking_trot", "crawl", "amble"));
}

TEST_F(OwnGaitsTest, AreInTheTextFromWhichAReplayIsComposed) {
  const std::string text = parameters_text(read());
  file.write(text);
  const Parameters again = read_parameters(file.path());
  EXPECT_EQ(parameters_text(again), text);
  EXPECT_EQ(all_gaits(again.leg_control.gaits).back().phase, all_gaits(read().leg_control.gaits).back().phase);
}

TEST_F(OwnGaitsTest, AreRefusedWithPathRuleAndRemedy) {
  const auto expect = [&](const std::vector<Overlay>& changes, const std::vector<std::string>& words) {
    const std::string message = refusal(changes);
    EXPECT_EQ(problems_in(message), 1u) << message;
    for (const std::string& word : words) EXPECT_THAT(message, HasSubstr(word));
  };
  expect({{"gait_2.period", "0.05", {}}}, {"gait_2.period = 0.05", "a number of 0.1 … 3 s"});
  expect({{"gait_2.duty", "0.45", {}}}, {"gait_2.duty = 0.45", "0.5 … 0.95"});
  expect({{"gait_2.lift", "0", {}}}, {"gait_2.lift = 0", "0.01 … 0.12 m"});
  expect({{"gait_2.phases", "[0, 0.5, 1.01, 0]", {}}}, {"gait_2.phases", "a list of four numbers, each of 0 … 1"});
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
    if (!gait.tips) {
      EXPECT_EQ(all_gaits(read(changes).leg_control.gaits).size(), kGaits.size() + 2);
      continue;
    }
    EXPECT_EQ(problems_in(refusal(changes)), 1u);
    EXPECT_THAT(refusal(changes), HasSubstr("gait_3.duty = "));
    EXPECT_THAT(refusal(changes), HasSubstr("set a larger duty or a shorter period"));
  }
  EXPECT_THAT(refusal({{"gait_3", gait_of(pace, 0.36, 0.18), {}}}),
              HasSubstr("lets the feet of one side are in stance by themselves for 0.18 s, in 1 of the period, so the "
                        "body tips over: at "
                        "most 0.122 s, and time · part of the period at most 0.07 s"));
}

}  // namespace robot_control::tests

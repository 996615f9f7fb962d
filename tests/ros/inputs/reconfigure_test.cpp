// Checks the live parameters that dynamic_reconfigure shows and sets.
#include "ros/inputs/reconfigure.h"

#include <gtest/gtest.h>

#include <cmath>

namespace robot_control::tests {

const std::vector<LiveParameter> kParameters = {
    {.key = "max_linear_speed", .value = 1.0, .min = 0.001, .max = 50, .rule = "a number"},
    {.key = "keep_curvature", .value = true, .min = 0, .max = 0, .rule = "true or false"},
    {.key = "feed_forward.mass", .value = 12.5, .min = 0.01, .max = 10000, .rule = "a number"},
    {.key = "feed_forward.yaw_inertia", .value = 0.5, .min = 0.01, .max = 10000, .rule = "a number"},
};

template <class Entries, class Value>
void put(Entries& entries, const std::string& name, Value value) {
  entries.emplace_back();
  entries.back().name = name;
  entries.back().value = value;
}

std::string text(const std::string& name, double value) {
  dynamic_reconfigure::Config request;
  put(request.doubles, name, value);
  return request_text(request, kParameters);
}

TEST(Reconfigure, NamesAreFlatAndValuesHaveTheirTypes) {
  const dynamic_reconfigure::Config config = config_of(kParameters);
  ASSERT_EQ(config.doubles.size(), 3U);
  EXPECT_EQ(config.doubles[1].name, "feed_forward_mass");
  EXPECT_EQ(config.doubles[1].value, 12.5);
  ASSERT_EQ(config.bools.size(), 1U);
  EXPECT_EQ(config.bools[0].value, 1);
  ASSERT_EQ(config.groups.size(), 1U);
  EXPECT_EQ(config.groups[0].name, "Default");
}

TEST(Reconfigure, TheDescriptionHasARangeForEveryValue) {
  const dynamic_reconfigure::ConfigDescription description = description_of(kParameters);
  ASSERT_EQ(description.groups.size(), 1U);
  EXPECT_EQ(description.groups[0].name, "Default");
  ASSERT_EQ(description.groups[0].parameters.size(), 4U);
  EXPECT_EQ(description.groups[0].parameters[1].type, "bool");
  EXPECT_EQ(description.groups[0].parameters[2].type, "double");
  EXPECT_EQ(description.min.doubles[0].value, 0.001);
  EXPECT_EQ(description.max.doubles[0].value, 50);
  EXPECT_EQ(description.min.bools[0].value, 0);
  EXPECT_EQ(description.max.bools[0].value, 1);
  EXPECT_EQ(description.dflt.doubles[1].value, 12.5);
}

TEST(Reconfigure, ARequestIsOneMapWithTheKeysOfTheYamlFile) {
  dynamic_reconfigure::Config request;
  put(request.doubles, "feed_forward_mass", 13.0);
  put(request.doubles, "max_linear_speed", 0.5);
  put(request.doubles, "feed_forward_yaw_inertia", 0.75);
  put(request.bools, "keep_curvature", std::uint8_t{0});
  EXPECT_EQ(request_text(request, kParameters),
            "{'keep_curvature': false, 'max_linear_speed': 0.5, 'feed_forward': {'mass': 13, 'yaw_inertia': 0.75}}");
}

TEST(Reconfigure, ANestedKeyMayBeNamedAsInTheYamlFileToo) {
  EXPECT_EQ(text("feed_forward.mass", 13), "{'feed_forward': {'mass': 13}}");
  EXPECT_EQ(text("feed_forward/mass", 13), "{'feed_forward': {'mass': 13}}");
}

TEST(Reconfigure, WhatIsNoNumberGoesOnAsSuch) {
  constexpr double kEndless = std::numeric_limits<double>::infinity();
  EXPECT_EQ(text("max_linear_speed", std::nan("")), "{'max_linear_speed': .nan}");
  EXPECT_EQ(text("max_linear_speed", kEndless), "{'max_linear_speed': .inf}");
  EXPECT_EQ(text("max_linear_speed", -kEndless), "{'max_linear_speed': -.inf}");
}

TEST(Reconfigure, ARequestThatNamesNoValueIsNone) {
  EXPECT_EQ(request_text(dynamic_reconfigure::Config(), kParameters), "");
  EXPECT_EQ(request_text(config_of({}), kParameters), "");  // a client sends the states of groups
}

TEST(Reconfigure, ANameCannotBreakOutOfItsQuotes) {
  dynamic_reconfigure::Config request;
  put(request.strs, "x': 1, max_linear_speed: 2, 'y", std::string("'}"));
  EXPECT_EQ(request_text(request, kParameters), "{'x'': 1, max_linear_speed: 2, ''y': '''}'}");
}

TEST(Reconfigure, WhatIsShownIsTakenBack) {
  EXPECT_EQ(request_text(config_of(kParameters), kParameters),
            "{'keep_curvature': true, 'max_linear_speed': 1, 'feed_forward': {'mass': 12.5, 'yaw_inertia': 0.5}}");
}

}  // namespace robot_control::tests

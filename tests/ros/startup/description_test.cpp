#include "ros/startup/description.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace robot_control::tests {

using testing::HasSubstr;
using testing::Not;

/// Healthy: the YAML file names diffbot, the server is empty.
struct ChosenDescription : testing::Test {
  ChosenDescription() { parameters_.urdf = PROJECT_DIRECTORY "/urdf/diffbot.urdf"; }

  RobotDescription chosen(bool urdf_requested, const std::string& published) const {
    return chosen_description(parameters_, urdf_requested, published, "/robot_description");
  }

  Parameters parameters_;
};

TEST_F(ChosenDescription, IsTheFileWhereNothingElseIsSaid) {
  EXPECT_EQ(chosen(false, "").source, parameters_.urdf);
  EXPECT_THAT(chosen(false, "").text, HasSubstr("<robot"));
}

TEST_F(ChosenDescription, IsThePublishedOneBeforeTheYamlFilesOwn) {
  EXPECT_EQ(chosen(false, "<robot/>").text, "<robot/>");
  EXPECT_EQ(chosen(false, "<robot/>").source, "/robot_description");
}

TEST_F(ChosenDescription, IsTheFileThatWasAskedForOnTheServer) {
  EXPECT_EQ(chosen(true, "<robot/>").source, parameters_.urdf);
}

TEST_F(ChosenDescription, KnowsTheFolderOfATextThatItHasRead) {
  EXPECT_EQ(chosen(false, chosen(false, "").text).source, parameters_.urdf);
}

TEST_F(ChosenDescription, SaysThatAnotherOneIsNotRead) {
  const RobotDescription file = chosen(true, "<robot/>");
  EXPECT_THAT(unread_description(file, "<robot/>", "/robot_description", "/robot/urdf"),
              HasSubstr("rosparam delete /robot/urdf"));
  EXPECT_EQ(unread_description(file, file.text, "/robot_description", "/robot/urdf"), "");
  EXPECT_EQ(unread_description(file, "", "/robot_description", "/robot/urdf"), "");
}

TEST_F(ChosenDescription, NeedsNoFileWhereOneIsPublished) {
  parameters_.urdf = "/nowhere.urdf";
  EXPECT_EQ(chosen(false, "<robot/>").text, "<robot/>");
  EXPECT_THROW(chosen(true, "<robot/>"), RobotError);
  EXPECT_THROW(chosen(false, ""), RobotError);
}

}  // namespace robot_control::tests

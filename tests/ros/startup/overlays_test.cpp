#include "ros/startup/overlays.h"

#include <gtest/gtest.h>
#include <xmlrpcpp/XmlRpcValue.h>

namespace robot_control::tests {

TEST(Overlays, NameEveryLeafWithItsPathAndOrigin) {
  XmlRpc::XmlRpcValue tree;
  tree["rate"] = 500.5;
  tree["limits"]["core"] = 1;
  const std::vector<Overlay> overlays = overlays_of(tree, "robot", "/robot2/robot");
  ASSERT_EQ(overlays.size(), 2u);
  EXPECT_EQ(overlays[0].path, "robot.limits.core");
  EXPECT_EQ(overlays[0].text, "1");
  EXPECT_EQ(overlays[0].origin, "/robot2/robot/limits/core");
  EXPECT_EQ(overlays[1].path, "robot.rate");
  EXPECT_EQ(overlays[1].text, "500.5");
}

TEST(Overlays, LeaveOutWhatIsNotTheSchemas) {
  XmlRpc::XmlRpcValue tree;
  tree["config"] = std::string("/somewhere.yaml");
  tree["pid_kp"] = 2.0;
  const std::vector<Overlay> overlays =
      overlays_of(tree, "diff_drive_controller", "/diff_drive_controller", {"config"});
  ASSERT_EQ(overlays.size(), 1u);
  EXPECT_EQ(overlays[0].path, "diff_drive_controller.pid_kp");
}

TEST(Overlays, KeepEveryBitOfANumber) {
  XmlRpc::XmlRpcValue tree;
  tree["value"] = 0.1 + 0.2;
  EXPECT_EQ(std::stod(overlays_of(tree, "b", "/b")[0].text), 0.1 + 0.2);
}

TEST(Overlays, SpellNotANumberAsYamlDoes) {
  XmlRpc::XmlRpcValue tree;
  tree["a"] = std::numeric_limits<double>::quiet_NaN();
  tree["b"] = -std::numeric_limits<double>::infinity();
  tree["c"] = false;
  const std::vector<Overlay> overlays = overlays_of(tree, "b", "/b");
  EXPECT_EQ(overlays[0].text, ".nan");
  EXPECT_EQ(overlays[1].text, "-.inf");
  EXPECT_EQ(overlays[2].text, "false");
}

TEST(Overlays, SpellListsAsYamlDoes) {
  XmlRpc::XmlRpcValue tree;
  tree["joints"][0] = std::string("front: \"left\"");
  tree["joints"][1] = std::string("rear");
  tree["centre"][0] = 0.5;
  tree["centre"][1] = -1;
  tree["none"].setSize(0);
  const std::vector<Overlay> overlays = overlays_of(tree, "robot", "/robot");
  ASSERT_EQ(overlays.size(), 3u);
  EXPECT_EQ(overlays[0].text, "[0.5, -1]");
  EXPECT_EQ(overlays[1].path, "robot.joints");
  EXPECT_EQ(overlays[1].text, R"(["front: \"left\"", "rear"])");
  EXPECT_EQ(overlays[2].text, "[]");
}

TEST(Overlays, AreReportedUnlessALaunchFileSetsThem) {
  const std::vector<Overlay> overlays = {{"robot.clock", "\"wall\"", "/robot/clock"},
                                         {"robot.rate", "500", "/robot/rate"}};
  EXPECT_EQ(override_lines(overlays, "p.yaml", {"clock", "bus"}),
            std::vector<std::string>{"/robot/rate = 500 overrides robot.rate of p.yaml"});
  EXPECT_EQ(override_lines(overlays, "p.yaml").size(), 2u) << "a refused start names them all";
}

TEST(Overlays, AreNoneWhereNothingIsSet) {
  EXPECT_TRUE(overlays_of(XmlRpc::XmlRpcValue(), "robot", "/robot").empty());
}

// A launch file sets an empty text for an argument that was not given.
TEST(Overlays, LeaveOutAnEmptyText) {
  XmlRpc::XmlRpcValue tree;
  tree["urdf"] = std::string();
  tree["rate"] = 500;
  const std::vector<Overlay> overlays = overlays_of(tree, "robot", "/robot");
  ASSERT_EQ(overlays.size(), 1u);
  EXPECT_EQ(overlays[0].path, "robot.rate");
}

std::string refusal_of(const XmlRpc::XmlRpcValue& value) {
  try {
    return text_parameter(value, "/node/config", "the path of a YAML file");
  } catch (const ParameterError& error) {
    return error.what();
  }
}

// A list in ~config must not start the robot with the limits of the installed file.
TEST(ATextOfTheServer, OfAnotherTypeIsRefusedWithItsValueAndTheRemedy) {
  EXPECT_EQ(refusal_of(XmlRpc::XmlRpcValue()), "");
  EXPECT_EQ(refusal_of(std::string("my.yaml")), "my.yaml");
  XmlRpc::XmlRpcValue list;
  list[0] = 1;
  list[1] = std::string("a");
  EXPECT_EQ(refusal_of(list),
            "/node/config = [1, \"a\"]: must be a text, the path of a YAML file; set it, or remove it: "
            "`rosparam delete /node/config`");
  EXPECT_NE(refusal_of(5).find("/node/config = 5: must be a text"), std::string::npos);
  EXPECT_NE(refusal_of(true).find("/node/config = true: must be a text"), std::string::npos);
  XmlRpc::XmlRpcValue tree;
  tree["a"] = 1;
  EXPECT_NE(refusal_of(tree).find("/node/config is a group of parameters: must be a text"), std::string::npos);
}

// rospy takes 1 and "false" for true, roscpp ignores them: some nodes would wait for /clock, others not.
TEST(SimulatedTime, IsTrueOrFalseAndNothingElse) {
  EXPECT_FALSE(truth_parameter(XmlRpc::XmlRpcValue(), "/use_sim_time"));
  EXPECT_FALSE(truth_parameter(XmlRpc::XmlRpcValue(false), "/use_sim_time"));
  EXPECT_TRUE(truth_parameter(XmlRpc::XmlRpcValue(true), "/use_sim_time"));
  EXPECT_THROW(truth_parameter(XmlRpc::XmlRpcValue(1), "/use_sim_time"), ParameterError);
  EXPECT_THROW(truth_parameter(XmlRpc::XmlRpcValue("false"), "/use_sim_time"), ParameterError);
}

TEST(Overlays, PassAScalarInPlaceOfABlockOnToTheSchema) {
  XmlRpc::XmlRpcValue scalar(7);
  const std::vector<Overlay> overlays = overlays_of(scalar, "robot", "/robot");
  ASSERT_EQ(overlays.size(), 1u);
  EXPECT_EQ(overlays[0].path, "robot");
}

}  // namespace robot_control::tests

#include "machine/description/xacro.h"

#include "machine/description/other_process.h"
#include "machine/description/robot_description.h"
#include "support/matchers.h"
#include "support/quiet_refusal.h"
#include "support/temporary_folder.h"

namespace robot_control::tests {

constexpr const char* kRobot =
    "<robot name=\"bot\" xmlns:xacro=\"http://www.ros.org/wiki/xacro\">"
    "<xacro:include filename=\"$(find robot_control_test_parts)/wheel.xacro\"/>"
    "<xacro:wheel side=\"left\" radius=\"${0.1 / 2}\"/></robot>";
constexpr const char* kWheel =
    "<robot xmlns:xacro=\"http://www.ros.org/wiki/xacro\"><xacro:macro name=\"wheel\" params=\"side radius\">"
    "<link name=\"${side}_wheel_ä\"><visual><geometry><sphere radius=\"${radius}\"/></geometry></visual></link>"
    "</xacro:macro></robot>";
constexpr const char* kPartsManifest =
    "<package><name>robot_control_test_parts</name><version>1.0.0</version><description>d</description>"
    "<maintainer email=\"a@b.c\">m</maintainer><license>l</license></package>";

struct Xacro : testing::Test {
  Xacro() {
    folder_.write("ws/parts/package.xml", kPartsManifest);
    folder_.write("ws/parts/wheel.xacro", kWheel);
  }

  std::string refusal(const std::string& name) {
    return quiet_refusal<RobotError>([&] { expand_xacro(folder_.path() / name); });
  }

  TemporaryFolder folder_;
  ScopedVariable packages_{"ROS_PACKAGE_PATH", folder_.path() / "ws"};
};

#define SKIP_WITHOUT_XACRO()                                                                     \
  folder_.write("probe.xacro", "<robot/>");                                                      \
  if (refusal("probe.xacro").find("no module xacro") != std::string::npos) {                     \
    GTEST_SKIP() << "PyPI's xacro is not installed: scripts/setup, with a network, installs it"; \
  }

TEST_F(Xacro, LeavesTheNamesOfTheMacrosThatWereCalledBehindTheText) {
  SKIP_WITHOUT_XACRO();
  folder_.write("bot.xacro",
                "<robot name=\"r\" xmlns:xacro=\"http://www.ros.org/wiki/xacro\">"
                "<xacro:macro name=\"mecanum_wheel\" params=\"name\"><link name=\"${name}\"/></xacro:macro>"
                "<xacro:macro name=\"unused\" params=\"\"/><xacro:mecanum_wheel name=\"a\"/></robot>");
  EXPECT_THAT(expand_xacro(folder_.path() / "bot.xacro"),
              AllOf(HasSubstr("</robot>"), HasSubstr("<!-- xacro macros: mecanum_wheel -->")));
}

TEST_F(Xacro, FindsPackagesByRospkg) {
  SKIP_WITHOUT_XACRO();
  EXPECT_THAT(expand_xacro(folder_.write("bot.urdf.xacro", kRobot)),
              AllOf(HasSubstr("<link name=\"left_wheel_ä\">"), HasSubstr("radius=\"0.05\"")));
}

TEST_F(Xacro, FindsPackagesAboveTheFile) {
  SKIP_WITHOUT_XACRO();
  const ScopedVariable nowhere("ROS_PACKAGE_PATH", folder_.path() / "nowhere");
  folder_.write("robot_control_test_parts/package.xml", kPartsManifest);
  folder_.write("robot_control_test_parts/wheel.xacro", kWheel);
  EXPECT_THAT(expand_xacro(folder_.write("robots/urdf/bot.urdf.xacro", kRobot)), HasSubstr("left_wheel"));
}

TEST_F(Xacro, UnknownPackageIsRefusedByName) {
  SKIP_WITHOUT_XACRO();
  const ScopedVariable nowhere("ROS_PACKAGE_PATH", folder_.path() / "nowhere");
  folder_.write("bot.urdf.xacro", kRobot);
  EXPECT_THAT(refusal("bot.urdf.xacro"),
              AllOf(HasSubstr("bot.urdf.xacro"), HasSubstr("no package robot_control_test_parts"),
                    HasSubstr("ROS_PACKAGE_PATH")));
}

TEST_F(Xacro, RefusesInItsOwnWords) {
  SKIP_WITHOUT_XACRO();
  folder_.write("torn.xacro", "<robot");
  EXPECT_THAT(refusal("torn.xacro"), AllOf(HasSubstr("torn.xacro"), HasSubstr("unclosed token")));
  folder_.write("unknown.xacro", "<robot xmlns:xacro=\"http://www.ros.org/wiki/xacro\"><xacro:nothing/></robot>");
  EXPECT_THAT(refusal("unknown.xacro"), HasSubstr("xacro:nothing"));
}

TEST_F(Xacro, AProgramInItIsRefusedByItsName) {
  SKIP_WITHOUT_XACRO();
  folder_.write(
      "program.xacro",
      "<robot name=\"r\" xmlns:xacro=\"http://www.ros.org/wiki/xacro\"><link name=\""
      "${[c for c in ().__class__.__base__.__subclasses__() if c.__name__ == 'Popen'][0]('true')}\"/></robot>");
  EXPECT_THAT(refusal("program.xacro"), AllOf(HasSubstr("program.xacro"), HasSubstr("__ is refused in an expression"),
                                              HasSubstr("`xacro FILE` runs the file as a program")));
}

TEST_F(Xacro, AbsentFileIsRefused) {
  EXPECT_THAT(refusal("nowhere.xacro"), AllOf(HasSubstr("nowhere.xacro"), HasSubstr("file not found")));
}

TEST_F(Xacro, WhatIsNoRegularFileIsRefusedBeforeItIsRead) {
  std::filesystem::create_symlink("/dev/zero", folder_.path() / "zero.xacro");
  EXPECT_THAT(refusal("zero.xacro"), HasSubstr("is a device; only a regular file is read"));
  EXPECT_THROW(load_description("/dev/zero"), RobotError);
  EXPECT_THROW(load_description(folder_.path()), RobotError);
}

TEST_F(Xacro, WhatItIncludesIsARegularFile) {
  SKIP_WITHOUT_XACRO();
  folder_.write("including.xacro",
                "<robot xmlns:xacro=\"http://www.ros.org/wiki/xacro\"><xacro:include filename=\"/dev/zero\"/></robot>");
  EXPECT_THAT(refusal("including.xacro"), HasSubstr("/dev/zero: is a device"));
}

TEST_F(Xacro, AbsentPythonIsNamedWithTheRemedy) {
  const ScopedVariable python("ROBOT_CONTROL_XACRO_PYTHON", "/nowhere/python3");
  folder_.write("bot.xacro", "<robot/>");
  EXPECT_THAT(refusal("bot.xacro"),
              AllOf(HasSubstr("/nowhere/python3"), HasSubstr("ROBOT_CONTROL_XACRO_PYTHON"), HasSubstr("yourself")));
}

// A Python of its own, without site-packages, stands for one without xacro.
TEST_F(Xacro, AbsentXacroIsNamedWithTheRemedy) {
  const auto python = folder_.write("python3", "#!/bin/sh\nexec /usr/bin/python3 -S \"$@\"\n");
  std::filesystem::permissions(python, std::filesystem::perms::owner_all);
  const ScopedVariable chosen("ROBOT_CONTROL_XACRO_PYTHON", python);
  folder_.write("bot.xacro", "<robot/>");
  EXPECT_THAT(refusal("bot.xacro"), AllOf(HasSubstr("no module xacro"), HasSubstr("pip install xacro")));
}

TEST(OtherProcess, HandsBackOutputErrorsAndCode) {
  const ProcessResult result = run_program({"sh", "-c", "echo out; echo $WORD >&2; exit 3"}, {"WORD=err"}, 10);
  EXPECT_EQ(result.end, ProcessResult::End::kExited);
  EXPECT_EQ(result.code, 3);
  EXPECT_EQ(result.output, "out\n");
  EXPECT_EQ(result.errors, "err\n");
}

TEST(OtherProcess, SilentOneIsEnded) {
  EXPECT_EQ(run_program({"sleep", "60"}, {}, 1).end, ProcessResult::End::kEnded);
}

TEST(OtherProcess, OneThatIsNotThereIsNotStarted) {
  EXPECT_EQ(run_program({"/nowhere/program"}, {}, 1).end, ProcessResult::End::kNotStarted);
}

TEST(OtherProcess, CrashesApart) {
  const ProcessResult result = run_apart([]() -> std::string { std::abort(); });
  EXPECT_EQ(result.end, ProcessResult::End::kKilled);
  EXPECT_EQ(run_apart([] { return std::string(1'000'000, 'x'); }).output.size(), 1'000'000U);
  EXPECT_EQ(run_apart([]() -> std::string { throw 1; }).code, 1);
}

}  // namespace robot_control::tests

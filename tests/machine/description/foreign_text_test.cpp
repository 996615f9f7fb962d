/// Files that are no plain XML are refused by name, in few words.

#include <urdf_model/model.h>

#include "machine/description/mesh.h"
#include "machine/description/robot_description.h"
#include "machine/description/urdf_document.h"
#include "machine/description/xacro.h"
#include "support/matchers.h"
#include "support/message_of.h"
#include "support/temporary_folder.h"

namespace robot_control::tests {

constexpr std::size_t kShort = 2048;

const std::string kPointer =
    "version https://git-lfs.github.com/spec/v1\noid "
    "sha256:4d7a214614ab2935c943f9e0ff69d22eadbb8f32b1258daaa5e2ca24d17e2393\n"
    "size 12345\n";

template <typename Action>
std::string short_message_of(const Action& action) {
  const std::string message = message_of<RobotError>(action, "accepted");
  EXPECT_LT(message.size(), kShort);
  return message;
}

struct ForeignText : testing::Test {
  std::string reading(const std::string& name, const std::string& text) {
    const std::string path = folder_.write(name, text);
    return short_message_of([&] { parse_urdf(load_description(path)); });
  }
  TemporaryFolder folder_;
};

std::string utf16(const std::string& text, bool big, bool mark) {
  std::string wide;
  const auto add = [&](char high, char low) { wide += big ? std::string{high, low} : std::string{low, high}; };
  if (mark) add('\xfe', '\xff');
  for (const char c : text) add('\0', c);
  return wide;
}

TEST_F(ForeignText, Utf16IsNamed) {
  for (const bool big : {false, true}) {
    for (const bool mark : {false, true}) {
      EXPECT_THAT(
          reading("r.urdf",
                  utf16("<?xml version=\"1.0\" encoding=\"utf-16\"?><robot name=\"r\"><link name=\"a\"/></robot>", big,
                        mark)),
          AllOf(HasSubstr("r.urdf"), HasSubstr("UTF-16"), HasSubstr("UTF-8")))
          << big << mark;
    }
  }
  EXPECT_THAT(reading("n.urdf", std::string("<robot name=\"r\"><link name=\"a\"/>\0</robot>", 41)), HasSubstr("NUL"));
}

TEST_F(ForeignText, ACharacterReferenceIsUtf8WithAndWithoutADeclaration) {
  for (const std::string declared :
       {"", "<?xml version=\"1.0\"?>\n", "<?xml version=\"1.0\" encoding=\"ISO-8859-1\"?>\n"}) {
    const std::string path =
        folder_.write("r.urdf", declared + "<robot name=\"K&#246;rper\"><link name=\"a\"/></robot>");
    EXPECT_EQ(parse_urdf(load_description(path)).model->getName(), "Körper") << declared;
  }
}

TEST_F(ForeignText, BytesThatAreNotUtf8AreNamedWithTheirLine) {
  for (const std::string bytes : {"gr\xf6\xdf", "\x80", "\xed\xa0\x80", "\xe0\x80\x80", "\xf4\x90\x80\x80"}) {
    for (const bool comment : {false, true}) {
      const std::string name = comment ? "r" : bytes;
      EXPECT_THAT(reading("r.urdf", "<?xml version=\"1.0\" encoding=\"ISO-8859-1\"?>\n<!-- " + bytes +
                                        " -->\n<robot name=\"" + name + "\"><link name=\"a\"/></robot>"),
                  AllOf(HasSubstr("r.urdf line 2"), HasSubstr("not UTF-8"), HasSubstr("iconv")));
    }
  }
  EXPECT_EQ(reading("r.urdf", "<robot name=\"größe 機器人 \xf0\x9f\xa4\x96\"><link name=\"a\"/></robot>"), "accepted");
}

TEST_F(ForeignText, XacroInAFileOfAnotherNameIsNamed) {
  EXPECT_THAT(reading("r.urdf",
                      "<robot name=\"r\" xmlns:xacro=\"http://ros.org/wiki/xacro\">\n<xacro:property name=\"a\" "
                      "value=\"1\"/>\n<link name=\"${a}\"/></robot>"),
              AllOf(HasSubstr("r.urdf line 2"), HasSubstr("<xacro:property>"), HasSubstr(".xacro")));
}

TEST_F(ForeignText, AUtf8MarkIsNoMatter) {
  EXPECT_EQ(reading("r.urdf", "\xef\xbb\xbf<?xml version=\"1.0\"?><robot name=\"r\"><link name=\"a\"/></robot>"),
            "accepted");
}

TEST_F(ForeignText, PointersOfGitLfsAreNamed) {
  for (const std::string name : {"r.urdf", "r.urdf.xacro"}) {
    EXPECT_THAT(reading(name, kPointer),
                AllOf(HasSubstr(name), HasSubstr("git-LFS pointer"), HasSubstr("git lfs pull")))
        << name;
  }
  for (const std::string name : {"m.stl", "m.STL", "m.obj", "m.dae"}) {
    const std::string path = folder_.write(name, kPointer);
    EXPECT_THAT(short_message_of([&] { read_mesh(path); }),
                AllOf(HasSubstr(name), HasSubstr("git-LFS pointer"), HasSubstr("git lfs pull")))
        << name;
  }
}

std::string laughs(int levels) {
  std::string text = "<?xml version=\"1.0\"?><!DOCTYPE robot [<!ENTITY l0 \"ha\">";
  for (int i = 1; i < levels; ++i) {
    const std::string before = "&l" + std::to_string(i - 1) + ";";
    text += "<!ENTITY l" + std::to_string(i) + " \"";
    for (int j = 0; j < 10; ++j) text += before;
    text += "\">";
  }
  return text + "]><robot name=\"r\"><link name=\"&l" + std::to_string(levels - 1) + ";\"/></robot>";
}

TEST_F(ForeignText, EntitiesAreNamed) {
  for (const int levels : {1, 3, 10}) {
    EXPECT_THAT(reading("r.urdf", laughs(levels)), AllOf(HasSubstr("r.urdf"), HasSubstr("<!ENTITY"))) << levels;
  }
  EXPECT_EQ(reading("c.urdf", "<robot name=\"r\"><!-- <!ENTITY a \"b\"> --><link name=\"a\"/></robot>"), "accepted");
}

struct CyclicXacro : ForeignText {
  void SetUp() override {
    if (reading("probe.xacro", "<robot name=\"r\"><link name=\"a\"/></robot>").find("no module xacro") !=
        std::string::npos) {
      GTEST_SKIP() << "PyPI's xacro is not installed: scripts/setup, with a network, installs it";
    }
  }
};

const std::string kHead = "<robot name=\"r\" xmlns:xacro=\"http://www.ros.org/wiki/xacro\">";

TEST_F(CyclicXacro, IncludesInACircleAreNamed) {
  for (const int length : {1, 2, 5}) {
    std::string first;
    for (int i = 0; i < length; ++i) {
      const std::string next = "part" + std::to_string((i + 1) % length) + ".xacro";
      folder_.write("part" + std::to_string(i) + ".xacro",
                    kHead + "<xacro:include filename=\"" + next + "\"/></robot>");
    }
    const std::string path = folder_.path() / "part0.xacro";
    EXPECT_THAT(
        short_message_of([&] { expand_xacro(path); }),
        AllOf(HasSubstr("part0.xacro"), HasSubstr("part" + std::to_string(length - 1) + ".xacro"), HasSubstr("cycle")));
  }
}

TEST_F(CyclicXacro, NamesForeignFilesThatItIncludes) {
  folder_.write("wide.xacro", utf16("<robot name=\"r\"><link name=\"a\"/></robot>", false, true));
  folder_.write("pointer.xacro", kPointer);
  for (const std::string name : {"wide", "pointer"}) {
    const std::string named = name == "pointer" ? "git-LFS pointer" : "UTF-16";
    EXPECT_THAT(reading("r.xacro", kHead + "<xacro:include filename=\"" + name + ".xacro\"/></robot>"),
                AllOf(HasSubstr(name + ".xacro"), HasSubstr(named)));
  }
  EXPECT_THAT(reading("main.xacro", utf16(kHead + "</robot>", false, true)), HasSubstr("UTF-16"));
}

TEST_F(CyclicXacro, MacrosInACircleAreNamed) {
  EXPECT_THAT(reading("m.xacro", kHead + "<xacro:macro name=\"ring\"><xacro:ring/></xacro:macro><xacro:ring/></robot>"),
              AllOf(HasSubstr("m.xacro"), HasSubstr("ring"), HasSubstr("cycle")));
  EXPECT_THAT(reading("two.xacro", kHead + "<xacro:macro name=\"ping\"><xacro:pong/></xacro:macro><xacro:macro "
                                           "name=\"pong\"><xacro:ping/></xacro:macro><xacro:ping/></robot>"),
              AllOf(HasSubstr("ping"), HasSubstr("pong"), HasSubstr("cycle")));
}

TEST_F(CyclicXacro, PropertiesInACircleAreNamed) {
  EXPECT_THAT(reading("p.xacro", kHead + "<xacro:property name=\"a\" value=\"${b}\"/><xacro:property name=\"b\" "
                                         "value=\"${a}\"/><link name=\"${a}\"/></robot>"),
              AllOf(HasSubstr("p.xacro"), HasSubstr("circular")));
}

TEST_F(CyclicXacro, EntitiesThatExpandWithoutEndAreNamed) {
  EXPECT_THAT(reading("r.xacro", laughs(10)), AllOf(HasSubstr("r.xacro"), HasSubstr("<!ENTITY")));
}

TEST(LongMessages, AreCutInTheMiddleToTwoKilobytes) {
  const std::string message =
      short_message_of([] { refuse("r.urdf", std::string(5000, 'e'), std::string(100000, 'w'), "Mend it"); });
  EXPECT_THAT(message, AllOf(HasSubstr("r.urdf"), HasSubstr("Mend it."), HasSubstr("…")));
}

}  // namespace robot_control::tests

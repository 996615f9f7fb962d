#include "machine/description/mesh.h"

#include <algorithm>
#include <chrono>

#include "machine/description/robot_description.h"
#include "mesh_texts.h"
#include "support/matchers.h"
#include "support/message_of.h"
#include "support/quiet_refusal.h"
#include "support/temporary_folder.h"

namespace robot_control::tests {

using Corner = Eigen::Vector3d;

const Points kTriangle{{0, 0, 0}, {0, 2, 0}, {1, 0, 0}};

std::string nested(int depth) {
  std::string begin;
  std::string end = "</node>";
  for (int i = 0; i < depth; ++i) {
    begin += "<node>";
    end += "</node>";
  }
  return replaced(dae_with("<node id=\"n\">", begin + "<node id=\"n\">"), "instance_geometry", "</node>", end);
}

struct Mesh : testing::Test {
  Points read(const std::string& name, const std::string& bytes) { return read_mesh(folder_.write(name, bytes)); }

  std::string refusal(const std::string& name, const std::string& bytes) {
    return quiet_refusal<RobotError>([&] { read(name, bytes); });
  }

  auto says(const std::string& what) { return AllOf(HasSubstr(folder_.path().string()), HasSubstr(what)); }

  TemporaryFolder folder_;
};

TEST_F(Mesh, IsTheSameInEveryFormat) {
  const std::string polygons = replaced(dae_with("<triangles", "<polygons"), "<p>", "</triangles", "</polygons");
  for (const auto& [name, bytes] : {std::pair{"binary.stl", kBinaryStl},
                                    {"text.stl", kTextStl},
                                    {"A.STL", kBinaryStl},
                                    {"solid.stl", binary_stl("solid part exported", {{0, 0, 0, 1, 0, 0, 0, 2, 0}})},
                                    {"a.obj", kObj},
                                    {"unused.obj", kObj + "v 9 9 9\n"},
                                    {"backwards.obj", "v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 2 0\nf -1 -2 -3\n"},
                                    {"materials.obj", "mtllib /dev/stdin\n" + kObj},
                                    {"a.dae", kDae},
                                    {"A.Dae", kDae},
                                    {"unused.dae", dae_with("0 2 0<", "0 2 0 9 9 9<")},
                                    {"polygons.dae", polygons},
                                    // rviz and Gazebo turn no axis either; assimp by itself turns Z_UP by 90°.
                                    {"x.dae", dae_with("Z_UP", "X_UP")},
                                    {"y.dae", dae_with("Z_UP", "Y_UP")},
                                    {"no_axis.dae", dae_with("<up_axis>Z_UP</up_axis>", "")}}) {
    EXPECT_EQ(read(name, bytes), kTriangle) << name;
  }
}

TEST_F(Mesh, UnitOfADaeApplies) {
  const Points points = read("a.dae", dae_with("meter=\"1\"", "name=\"inch\" meter=\"0.0254\""));
  EXPECT_NEAR((points[1] - Corner(0, 2 * 0.0254, 0)).norm(), 0, 1e-8);  // single precision
}

TEST_F(Mesh, NodesOfADaePlaceTheirMeshes) {
  const Points points = read("a.dae", dae_with("<node id=\"n\">",
                                               "<node id=\"n\"><translate>0 0 5</translate><rotate>0 0 1 90</rotate>"
                                               "<scale>2 2 2</scale>"));
  for (const Corner& expected : {Corner(0, 0, 5), Corner(0, 2, 5), Corner(-4, 0, 5)}) {
    double nearest = 1;
    for (const Corner& point : points) nearest = std::min(nearest, (point - expected).norm());
    EXPECT_NEAR(nearest, 0, 1e-6);  // single precision
  }
}

TEST_F(Mesh, NodesOfADaeMayStandForOthers) {
  const Points points =
      read("a.dae", dae_with("</node>", "</node><node><translate>0 0 5</translate><instance_node url=\"#n\"/></node>"));
  EXPECT_EQ(points.size(), 6U);
}

TEST_F(Mesh, InfinityIsNoPartOfIt) {
  const float infinity = std::numeric_limits<float>::infinity();
  EXPECT_EQ(read("a.stl", binary_stl("", {{0, 0, 0, 1, 0, 0, 0, 2, 0}, {infinity, 0, 0, 1, 0, 0, 0, 2, 0}})),
            kTriangle);
}

TEST_F(Mesh, NumbersThatADoubleCannotHoldAreZeroOrInfinity) {
  const std::string tiny = replaced(kTextStl, "outer loop", "vertex 0 0 0", "vertex 1e-400 -1e-400 0");
  EXPECT_EQ(read("tiny.stl", tiny), kTriangle);
  const std::string far =
      replaced(kTextStl, "endfacet", "endsolid", "vertex 1e400 0 0\n vertex 0 0 0\n vertex 0 0 0\nendsolid");
  EXPECT_EQ(read("far.stl", far), kTriangle);
}

TEST_F(Mesh, AbsentFileIsRefused) {
  const std::string message = message_of<RobotError>([&] { read_mesh(folder_.path() / "nowhere.stl"); });
  EXPECT_THAT(message, AllOf(HasSubstr("nowhere.stl"), HasSubstr("file not found")));
}

TEST_F(Mesh, RefusesWhatIsNoMesh) {
  const std::string garbage = "\x01\x02garbage \xff\xfe <<<>> garbage";
  std::string lines = dae_with("<triangles count=\"1\"", "<lines count=\"1\"");
  lines = replaced(replaced(lines, "<p>", "0 1 2", "0 1"), "<p>", "</triangles>", "</lines>");
  for (const auto& [name, bytes, why] :
       {std::tuple{"a.stl", std::string(), "0 bytes"},
        {"a.obj", "", "0 bytes"},
        {"a.dae", "", "0 bytes"},
        {"a.blend", "BLENDER", "\".blend\""},
        {"a", "BLENDER", "unsupported mesh format"},
        {"a.stl", kBinaryStl.substr(0, 100), "incomplete"},
        {"a.stl", kTextStl.substr(0, 90), "unreadable"},
        {"a.obj", kObj.substr(0, 30), "mesh: "},
        {"a.dae", kDae.substr(0, 700), "unreadable"},
        {"a.stl", garbage, "mesh: "},
        {"a.obj", garbage, "mesh: "},
        {"a.dae", garbage, "mesh: "},
        {"a.stl", replaced(kTextStl, "solid", "   vertex 0 +2 0\n", ""), "three"},
        {"a.stl", replaced(kTextStl, "solid", "0 +2 0", "0 two 0"), "does not have three numbers"},
        {"a.stl", binary_stl("", {}), "empty"},
        {"a.stl", "solid nothing\nendsolid nothing\n", "empty"},
        {"a.dae", dae_with("<instance_geometry url=\"#g\"/>", ""), "empty"},
        {"a.dae", lines, "no face"},
        {"a.dae", dae_with("<node id=\"n\">", "<node id=\"n\"><instance_node url=\"#n\"/>"), "crashes"},
        {"a.dae", dae_with("<node id=\"n\">", "<node name='n'><node><instance_node url = '#n' /></node>"),
         "crashes"}}) {
    EXPECT_THAT(refusal(name, bytes), says(why)) << name;
  }
}

#if !defined(__SANITIZE_ADDRESS__)  // a gigabyte of nodes takes Assimp, which is not under it, half a minute
TEST_F(Mesh, NodesThatMultiplyAreRefused) {
  std::string library = "<library_nodes><node id=\"n40\"><instance_geometry url=\"#g\"/></node>";
  for (int i = 0; i < 40; ++i) {
    const std::string next = "<instance_node url=\"#n" + std::to_string(i + 1) + "\"/>";
    library.append("<node id=\"n").append(std::to_string(i)).append("\">").append(next).append(next).append("</node>");
  }
  EXPECT_THAT(refusal("a.dae", replaced(dae_with("<library_visual", library + "</library_nodes><library_visual"),
                                        "<node id=\"n\">", "</node>", "<instance_node url=\"#n0\"/></node>")),
              says("unreadable"));
}
#endif

TEST_F(Mesh, ElementsThatNestTooDeepAreRefused) {
  EXPECT_EQ(read("a.dae", nested(50)), kTriangle);
  EXPECT_THAT(refusal("a.dae", nested(100'000)), says("crashes"));
}

TEST_F(Mesh, CountsThatAreNotMetAreRefusedOrIgnored) {
  for (const char* count : {"4000000000", "-1", "x", ""}) {
    for (const char* element : {"count=\"9\"", "count=\"3\"", "count=\"1\"", "stride=\"3\"", "0 1 2"}) {
      const std::string attribute = std::string(element).substr(0, std::string(element).find('"'));
      const std::string to = element[0] == '0' ? count : attribute + "\"" + count + "\"";
      EXPECT_THAT(refusal("a.dae", dae_with(element, to)), AnyOf("accepted", says("mesh: "))) << to;
    }
  }
  EXPECT_THAT(refusal("a.obj", kObj + "f 1 2 99999999999\n"), says("unreadable"));
}

TEST_F(Mesh, CornersAreReadAgainWhenTheFileIsAnother) {
  const auto file = folder_.write("a.stl", kBinaryStl);
  EXPECT_EQ(mesh_corners(file).points, kTriangle);
  const auto before = std::filesystem::last_write_time(file);
  folder_.write("a.stl", binary_stl("", {{0, 0, 0, 1, 0, 0, 0, 3, 0}}));
  std::filesystem::last_write_time(file, before + std::chrono::seconds(1));
  EXPECT_EQ(mesh_corners(file).points[1], Corner(0, 3, 0));
}

}  // namespace robot_control::tests

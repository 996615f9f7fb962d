#include "machine/description/resource.h"

#include <sys/stat.h>

#include "support/matchers.h"
#include "support/message_of.h"
#include "support/temporary_folder.h"

namespace robot_control::tests {

constexpr const char* kManifest = "<package><name>bot_description</name></package>";

/// ws/src/stack/folder is the package bot_description; robots/bot.urdf refers to it.
struct Resource : testing::Test {
  Resource() {
    folder_.write("ws/src/stack/folder/package.xml", kManifest);
    mesh_ = folder_.write("ws/src/stack/folder/meshes/base.stl", "solid");
    urdf_ = {"", folder_.write("robots/bot.urdf", "<robot/>")};
  }

  std::filesystem::path resolved(const std::string& uri) { return resolve_resource(uri, urdf_).lexically_normal(); }

  std::string refusal(const std::string& uri) {
    return message_of<RobotError>([&] { resolve_resource(uri, urdf_); });
  }

  TemporaryFolder folder_;
  std::filesystem::path mesh_;
  RobotDescription urdf_;
  ScopedVariable packages_{"ROS_PACKAGE_PATH",
                           (folder_.path() / "nowhere:").string() + (folder_.path() / "ws").string()};
  ScopedVariable prefixes_{"CMAKE_PREFIX_PATH", (folder_.path() / "install").string()};
};

TEST_F(Resource, PackageIsFoundByItsNameBelowTheSearchPath) {
  EXPECT_EQ(resolved("package://bot_description/meshes/base.stl"), mesh_);
}

TEST_F(Resource, EntryOfTheSearchPathMayBeThePackageItself) {
  const ScopedVariable itself("ROS_PACKAGE_PATH", folder_.path() / "ws/src/stack/folder/");
  EXPECT_EQ(resolved("package://bot_description/meshes/base.stl"), mesh_);
}

TEST_F(Resource, FirstEntryOfTheSearchPathCounts) {
  folder_.write("over/bot_description/package.xml", kManifest);
  const auto over = folder_.write("over/bot_description/meshes/base.stl", "solid");
  const ScopedVariable both("ROS_PACKAGE_PATH", (folder_.path() / "over:").string() + (folder_.path() / "ws").string());
  EXPECT_EQ(resolved("package://bot_description/meshes/base.stl"), over);
}

// A FIFO would block the search.
TEST_F(Resource, AManifestThatIsNoRegularFileNamesNoPackage) {
  std::filesystem::create_directories(folder_.path() / "ws/src/odd");
  ASSERT_EQ(mkfifo((folder_.path() / "ws/src/odd/package.xml").c_str(), 0600), 0);
  folder_.write("ws/src/odd/meshes/base.stl", "solid");
  EXPECT_EQ(resolved("package://bot_description/meshes/base.stl"), mesh_);
}

TEST_F(Resource, PackageWithoutNameIsCalledLikeItsFolder) {
  folder_.write("ws/src/plain/manifest.xml", "<package/>");
  const auto file = folder_.write("ws/src/plain/a.stl", "solid");
  EXPECT_EQ(resolved("package://plain/a.stl"), file);
}

TEST_F(Resource, PackagesInPackagesAndHiddenFoldersAreNotLookedAt) {
  folder_.write("ws/src/stack/folder/inner/package.xml", "<package><name>inner</name></package>");
  folder_.write("ws/src/stack/folder/inner/a.stl", "solid");
  folder_.write("ws/.hidden/secret/package.xml", "<package><name>secret</name></package>");
  folder_.write("ws/.hidden/secret/a.stl", "solid");
  folder_.write("ws/ignored/CATKIN_IGNORE", "");
  folder_.write("ws/ignored/old/package.xml", "<package><name>old</name></package>");
  for (const char* uri : {"package://inner/a.stl", "package://secret/a.stl", "package://old/a.stl"}) {
    EXPECT_THAT(refusal(uri), HasSubstr("package not found")) << uri;
  }
}

TEST_F(Resource, FolderThatHoldsItselfIsSearchedOnce) {
  std::filesystem::create_directory_symlink(folder_.path() / "ws", folder_.path() / "ws/again");
  EXPECT_EQ(std::filesystem::canonical(resolved("package://bot_description/meshes/base.stl")),
            std::filesystem::canonical(mesh_));
}

TEST_F(Resource, InstalledPackageIsFoundByItsPrefix) {
  const auto file = folder_.write("install/share/installed/a.stl", "solid");
  EXPECT_EQ(resolved("package://installed/a.stl"), file);
}

TEST_F(Resource, PackageMayLieAboveTheUrdfOrHoldIt) {
  const ScopedVariable nowhere("ROS_PACKAGE_PATH", "");
  EXPECT_THAT(refusal("package://bot_description/meshes/base.stl"), HasSubstr("which is not set"));
  urdf_.source = folder_.write("ws/src/stack/folder/urdf/deep/bot.urdf", "<robot/>");
  EXPECT_EQ(resolved("package://bot_description/meshes/base.stl"), mesh_);
  const auto beside = folder_.write("robots/parts/a.stl", "solid");
  urdf_.source = folder_.path() / "robots/bot.urdf";
  EXPECT_EQ(resolved("package://parts/a.stl"), beside);
}

TEST_F(Resource, PathsOfFilesAreTakenAsTheyStand) {
  const auto spaced = folder_.write("a b.stl", "solid");
  EXPECT_EQ(resolved(mesh_), mesh_);
  EXPECT_EQ(resolved("file://" + mesh_.string()), mesh_);
  EXPECT_EQ(resolved("file://localhost" + mesh_.string()), mesh_);
  EXPECT_EQ(resolved("file://" + (folder_.path() / "a%20b.stl").string()), spaced);
}

TEST_F(Resource, RelativePathStartsAtTheUrdf) {
  EXPECT_EQ(resolved("../ws/src/stack/folder/meshes/base.stl"), mesh_);
}

TEST_F(Resource, RelativePathWithoutAFileIsRefused) {
  urdf_.source = "/robot_description";
  EXPECT_THAT(refusal("meshes/base.stl"), AllOf(HasSubstr("/robot_description"), HasSubstr("relative")));
}

TEST_F(Resource, StepsUpPassThroughFoldersThatAreNotThere) {
  EXPECT_EQ(resolved("package://bot_description/nowhere/../meshes/base.stl"), mesh_);
}

TEST_F(Resource, UnknownPackageIsNamedWithWhereItWasLookedFor) {
  EXPECT_THAT(refusal("package://other/base.stl"),
              AllOf(HasSubstr("bot.urdf"), HasSubstr("<mesh filename=\"package://other/base.stl\">"),
                    HasSubstr("\"other\""), HasSubstr((folder_.path() / "ws").string()),
                    HasSubstr("add the folder that holds it to ROS_PACKAGE_PATH")));
}

TEST_F(Resource, MissingFileIsNamed) {
  EXPECT_THAT(refusal("package://bot_description/meshes/Base.stl"),
              AllOf(HasSubstr("bot.urdf"), HasSubstr("folder/meshes/Base.stl"), HasSubstr("upper and lower case")));
}

TEST_F(Resource, WhatNamesNoFileIsRefused) {
  for (const char* uri : {"", "  ", "package://", "package://bot_description", "http://example.org/a.stl"}) {
    EXPECT_THAT(refusal(uri), AllOf(HasSubstr("bot.urdf"), HasSubstr("<mesh filename="))) << uri;
  }
}

}  // namespace robot_control::tests

#include "files/output_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <system_error>

#include "rt/process_limits.h"
#include "support/file_content.h"
#include "support/processes/child_process.h"
#include "support/temporary_folder.h"

namespace robot_control::tests {

struct AnOutputFile : ::testing::Test {
  std::string file(const std::string& name = "file") const { return folder_.path() / name; }
  static struct stat status(const std::string& path) {
    struct stat result {};
    EXPECT_EQ(lstat(path.c_str(), &result), 0);
    return result;
  }
  long files_in_folder() const { return std::distance(std::filesystem::directory_iterator(folder_.path()), {}); }

  TemporaryFolder folder_;
};

TEST_F(AnOutputFile, IsMadeAndReplaced) {
  write_output_file(file(), "one");
  const ino_t before = status(file()).st_ino;
  write_output_file(file(), "two");
  EXPECT_EQ(content(file()), "two");
  EXPECT_NE(status(file()).st_ino, before) << "a reader of the old one keeps it whole";
  EXPECT_EQ(files_in_folder(), 1);
}

TEST_F(AnOutputFile, KeepsItsMode) {
  write_output_file(file(), "one");
  ASSERT_EQ(chmod(file().c_str(), 0640), 0);
  write_output_file(file(), "two");
  EXPECT_EQ(status(file()).st_mode & 07777U, 0640u);
}

TEST_F(AnOutputFile, KeepsItsOwner) {
  if (geteuid() != 0) GTEST_SKIP() << "only root may give a file away";
  write_output_file(file(), "one");
  ASSERT_EQ(chown(file().c_str(), 12345, 23456), 0);
  write_output_file(file(), "two");
  EXPECT_EQ(status(file()).st_uid, 12345u);
  EXPECT_EQ(status(file()).st_gid, 23456u);
}

TEST_F(AnOutputFile, IsOverwrittenInPlaceByAUserWhoMayWriteThatOfAnotherOwner) {
  if (geteuid() != 0) GTEST_SKIP() << "only root may become another user";
  write_output_file(file(), "one and more");
  ASSERT_EQ(chmod(file().c_str(), 0666), 0);
  ASSERT_EQ(chmod(folder_.path().c_str(), 0777), 0);
  const int code = ChildProcess([this] {
                     if (setgid(23456) != 0 || setuid(12345) != 0) return 1;
                     write_output_file(file(), "two");
                     return 0;
                   }).wait();
  EXPECT_EQ(code, 0);
  EXPECT_EQ(content(file()), "two");
  EXPECT_EQ(status(file()).st_uid, 0u);
  EXPECT_EQ(files_in_folder(), 1);
}

TEST_F(AnOutputFile, IsReplacedBehindALinkAndTheLinkStays) {
  write_output_file(file("target"), "one");
  std::filesystem::create_symlink("target", file("link"));
  std::filesystem::create_symlink("not yet", file("dangling"));
  write_output_file(file("link"), "two");
  write_output_file(file("dangling"), "three");
  EXPECT_TRUE(S_ISLNK(status(file("link")).st_mode));
  EXPECT_TRUE(S_ISLNK(status(file("dangling")).st_mode));
  EXPECT_EQ(content(file("target")), "two");
  EXPECT_EQ(content(file("not yet")), "three");
}

TEST_F(AnOutputFile, IsWrittenToAndStaysIfItIsADevice) {
  if (mknod(file("null").c_str(), S_IFCHR | 0666, makedev(1, 3)) != 0) GTEST_SKIP() << "devices are not granted";
  const int opened = open(file("null").c_str(), O_WRONLY | O_CLOEXEC);
  if (opened < 0) GTEST_SKIP() << "this file system has no devices";
  close(opened);
  write_output_file(file("null"), "text");
  EXPECT_TRUE(S_ISCHR(status(file("null")).st_mode));
  EXPECT_THROW(write_output_file("/dev/full", "text"), std::system_error);
  EXPECT_TRUE(S_ISCHR(status("/dev/full").st_mode));
}

TEST_F(AnOutputFile, IsWrittenToAndStaysIfItIsAFifo) {
  ASSERT_EQ(mkfifo(file("fifo").c_str(), 0600), 0);
  const int reader = open(file("fifo").c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  write_output_file(file("fifo"), "text");
  char text[8] = {};
  EXPECT_EQ(read(reader, text, sizeof text), 4);
  close(reader);
  EXPECT_STREQ(text, "text");
  EXPECT_TRUE(S_ISFIFO(status(file("fifo")).st_mode));
}

TEST_F(AnOutputFile, FailsBeyondTheLimitOnFileSizesAndLeavesTheOldOne) {
  write_output_file(file(), "old");
  ChildProcess child([this] {
    const rlimit limit{1000, 1000};
    setrlimit(RLIMIT_FSIZE, &limit);
    ignore_file_size_signal();
    try {
      write_output_file(file(), std::string(5000, 'x'));
    } catch (const std::system_error& error) {
      return error.code().value() == EFBIG ? 0 : 2;
    }
    return 1;
  });
  EXPECT_EQ(child.wait(), 0) << "signal " << child.ending_signal();
  EXPECT_EQ(content(file()), "old");
  EXPECT_EQ(files_in_folder(), 1);
}

}  // namespace robot_control::tests

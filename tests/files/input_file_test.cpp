#include "files/input_file.h"

#include <sys/stat.h>

#include "support/matchers.h"
#include "support/temporary_folder.h"

namespace robot_control::tests {

struct AnInputFile : ::testing::Test {
  TemporaryFolder folder_;
};

TEST_F(AnInputFile, IsReadToItsLastByte) {
  const std::string text = std::string("a\0b", 3) + std::string(200'000, 'x');
  const InputFile file = read_input_file(folder_.write("file", text), text.size());
  EXPECT_EQ(file.problem, "");
  EXPECT_EQ(file.text, text);
}

TEST_F(AnInputFile, LargerThanTheLimitIsRefused) {
  EXPECT_THAT(read_input_file(folder_.write("file", "123456"), 5).problem,
              HasSubstr("has 6 bytes, at most 5 are read"));
}

TEST_F(AnInputFile, IsBoundedWithoutASizeToo) {
  EXPECT_EQ(read_input_file("/proc/self/stat", 1000).problem, "");
  EXPECT_THAT(read_input_file("/proc/self/stat", 3).problem, HasSubstr("more than 3 bytes"));
}

TEST_F(AnInputFile, IsRefusedWithoutAWaitIfItIsNoRegularFile) {
  const std::string fifo = folder_.path() / "fifo";
  ASSERT_EQ(mkfifo(fifo.c_str(), 0600), 0);
  EXPECT_THAT(read_input_file(fifo, 10).problem, HasSubstr("is a FIFO"));
  EXPECT_THAT(read_input_file("/dev/zero", 10).problem, HasSubstr("is a device"));
  EXPECT_THAT(read_input_file("/dev/tty", 10).problem, HasSubstr("is a device"));
  EXPECT_THAT(read_input_file(folder_.path(), 10).problem, HasSubstr("is a folder"));
}

TEST_F(AnInputFile, CountsAsWhatItIsBehindALink) {
  std::filesystem::create_symlink("/dev/zero", folder_.path() / "link");
  EXPECT_THAT(read_input_file(folder_.path() / "link", 10).problem, HasSubstr("is a device"));
  EXPECT_THAT(input_file_problem(folder_.path() / "link", 10), HasSubstr("is a device"));
}

TEST_F(AnInputFile, IsRefusedInTheSystemsWordsIfItIsNotThere) {
  EXPECT_EQ(read_input_file(folder_.path() / "absent", 10).problem, "file not found");
  EXPECT_EQ(read_input_file(std::string(5000, 'a'), 10).problem, "cannot be read: File name too long");
  EXPECT_THAT(read_input_file(std::string("a\0b", 3), 10).problem, HasSubstr("NUL"));
}

}  // namespace robot_control::tests

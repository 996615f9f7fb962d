/// Paths of a user: what they become, and how messages show them.

#include "files/given_path.h"

#include <gtest/gtest.h>
#include <pwd.h>
#include <unistd.h>

#include <cstdlib>

namespace robot_control::tests {

/// Sets a variable of the environment, or removes it, until the end of the block.
class Variable {
 public:
  Variable(const char* name, const char* value) : name_(name) {
    if (const char* now = std::getenv(name)) before_ = now;
    set(value);
  }
  ~Variable() { set(before_ ? before_->c_str() : nullptr); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  void set(const char* value) { value == nullptr ? unsetenv(name_) : setenv(name_, value, 1); }
  const char* name_;
  std::optional<std::string> before_;
};

TEST(GivenPath, CountsFromTheCallersFolderElseTheCurrentOne) {
  {
    const Variable caller(kCallerFolder, "/called/here");
    EXPECT_EQ(resolved_path("rel/file"), "/called/here/rel/file");
    EXPECT_EQ(resolved_path("../file"), "/called/file");
    EXPECT_EQ(resolved_path("folder/"), "/called/here/folder/");
    EXPECT_EQ(resolved_path("/abs"), "/abs");
    EXPECT_EQ(resolved_path(""), "");
    EXPECT_EQ(resolved_path("rel", "/of/a/file"), "/of/a/file/rel");
  }
  const Variable no_caller(kCallerFolder, nullptr);
  EXPECT_EQ(resolved_path("rel"), std::filesystem::current_path() / "rel");
}

TEST(GivenPath, ATildeIsTheHomeAlsoWithoutTheVariable) {
  {
    const Variable home("HOME", "/home/me");
    EXPECT_EQ(resolved_path("~/x"), "/home/me/x");
  }
  const Variable no_home("HOME", nullptr);
  EXPECT_EQ(resolved_path("~/x"), (std::filesystem::path(getpwuid(getuid())->pw_dir) / "x").lexically_normal());
}

TEST(GivenPath, AnErrorSaysWhatWasGivenWhatItBecameAndWhy) {
  const Variable caller(kCallerFolder, "/called/here");
  EXPECT_EQ(file_error(resolved_path("mine.urdf"), "is a FIFO"), "mine.urdf: is a FIFO (/called/here/mine.urdf)");
  EXPECT_EQ(shown_path(resolved_path("out/") + "robot2/run.bag"),
            "out/robot2/run.bag (/called/here/out/robot2/run.bag)");
  EXPECT_EQ(shown_path(resolved_path("/abs/mine.urdf")), "/abs/mine.urdf");
  EXPECT_EQ(shown_path("plain"), "plain");
}

}  // namespace robot_control::tests

/// Linked into a test program that holds changes (switch.h): appends to the file $MUTATION_NOTES which changes are
/// known, and which places each test executes.

#include <gtest/gtest.h>

#include <fstream>

#include "mutation/switch.h"

namespace mutation {
namespace {

class Notes : public testing::EmptyTestEventListener {
 public:
  explicit Notes(const char* file) : file_(file, std::ios::app) {
    write("known all 0", known);
    std::copy_n(reached, kMaxChanges, before_);
  }

 private:
  void OnTestStart(const testing::TestInfo& /*test*/) override {
    std::copy_n(before_, kMaxChanges, reached);
    began_ = std::clock();
  }
  void OnTestEnd(const testing::TestInfo& test) override {
    const double seconds = static_cast<double>(std::clock() - began_) / CLOCKS_PER_SEC;
    const std::string name = std::string(test.test_suite_name()) + "." + test.name();
    write("test " + name + " " + std::to_string(seconds), reached);
  }
  void write(const std::string& head, const bool (&places)[kMaxChanges]) {
    file_ << head;
    for (int i = 0; i < kMaxChanges; ++i) {
      if (places[i]) file_ << ' ' << i;
    }
    file_ << std::endl;
  }

  std::ofstream file_;
  std::clock_t began_ = 0;
  bool before_[kMaxChanges] = {};  ///< executed by the initialisation of constants
};

// The environment is set up after all constants, before the first test.
class Setup : public testing::Environment {
  void SetUp() override {
    if (const char* file = std::getenv("MUTATION_NOTES")) {
      testing::UnitTest::GetInstance()->listeners().Append(new Notes(file));
    }
  }
};
const auto* const setup = testing::AddGlobalTestEnvironment(new Setup);

}  // namespace
}  // namespace mutation

// Random damage to a valid file: it is read or refused, and nothing else happens. A failing seed is printed.

#include <random>

#include "configuration/parameters.h"
#include "parameters/parameter_file.h"
#include "support/damaged_text.h"

namespace robot_control::tests {

/// First seed, and last seed + 1.
struct ReadParametersFuzz : testing::TestWithParam<std::pair<unsigned, unsigned>> {
  /// `read(seed, random)` may throw a ParameterError, and nothing else.
  template <class Read>
  static void expect_read_or_refused(Read read) {
    for (unsigned seed = GetParam().first; seed < GetParam().second; ++seed) {
      std::mt19937 random(seed);
      try {
        read(seed, random);
      } catch (const ParameterError&) {
      } catch (const std::exception& error) {
        FAIL() << "seed " << seed << ": " << error.what();
      }
    }
  }
};
INSTANTIATE_TEST_SUITE_P(EveryDay, ReadParametersFuzz, testing::Values(std::pair(0u, 100u)));
INSTANTIATE_TEST_SUITE_P(Nightly, ReadParametersFuzz, testing::Values(std::pair(100u, 1500u)));

TEST_P(ReadParametersFuzz, ReadsOrRefusesWhateverStandsInTheFile) {
  ParameterFile file;
  expect_read_or_refused([&](unsigned, std::mt19937& random) {
    file.write(damaged(shipped_text(), random));
    read_parameters(file.path());
  });
}

// The conditions are maps: the damage is there alone, where braces open and close.
TEST_P(ReadParametersFuzz, ReadsOrRefusesWhateverStandsInACondition) {
  const std::string text = shipped_text();
  const std::size_t begin = text.find("\n  wheel_speed:");
  const std::size_t end = text.find("\ntelemetry:");
  ASSERT_LT(begin, end);
  ParameterFile file;
  expect_read_or_refused([&](unsigned, std::mt19937& random) {
    file.write(text.substr(0, begin) + damaged(text.substr(begin, end - begin), random) + text.substr(end));
    read_parameters(file.path());
  });
}

TEST_P(ReadParametersFuzz, ReadsOrRefusesWhateverAnOverlaySays) {
  const std::vector<std::string> paths = parameter_paths();
  expect_read_or_refused([&](unsigned seed, std::mt19937& random) {
    const std::string value = seed % 2 == 0 ? "1000.0" : "{limit: 0.3, persistence: 0.1, reaction: warn}";
    read_parameters(shipped_path(), {{paths[seed % paths.size()], damaged(value, random), "server"}});
  });
}

}  // namespace robot_control::tests

// Random damage to a valid file: it is read or refused, never anything else. A failing seed is printed.
#include <gtest/gtest.h>

#include <random>

#include "parameters/parameter_file.h"
#include "parameters/parameters.h"

namespace robot_control {
namespace {

std::string damaged(std::string text, std::mt19937& random) {
  const auto pick = [&](std::size_t bound) {
    return std::uniform_int_distribution<std::size_t>(0, bound == 0 ? 0 : bound - 1)(random);
  };
  const std::string_view marks = ":#-[]{}\"'\n \t,!&*|>%@?.~\0\xff";
  for (std::size_t count = 1 + pick(8); count > 0; --count) {
    const std::size_t place = pick(text.size());
    switch (pick(5)) {
      case 0:
        text.erase(place, pick(40));
        break;
      case 1:
        text.insert(place, 1, marks[pick(marks.size())]);
        break;
      case 2:
        text.insert(place, text.substr(pick(text.size()), pick(80)));
        break;
      case 3:
        if (!text.empty()) text[place] = static_cast<char>(pick(256));
        break;
      default:
        text.insert(place, std::string(pick(600), marks[pick(marks.size())]));
    }
  }
  return text;
}

TEST(ReadParametersFuzz, ReadsOrRefusesWhateverStandsInTheFile) {
  ParameterFile file;
  for (unsigned seed = 0; seed < 1500; ++seed) {
    std::mt19937 random(seed);
    file.write(damaged(shipped_text(), random));
    try {
      read_parameters(file.path());
    } catch (const ParameterError&) {
    } catch (const std::exception& error) {
      FAIL() << "seed " << seed << ": " << error.what();
    }
  }
}

// The conditions are maps: damage there alone, where braces open and close.
TEST(ReadParametersFuzz, ReadsOrRefusesWhateverStandsInACondition) {
  const std::string text = shipped_text();
  const std::size_t begin = text.find("\n  wheel_speed:");
  const std::size_t end = text.find("\ntelemetry:");
  ASSERT_LT(begin, end);
  ParameterFile file;
  for (unsigned seed = 0; seed < 1500; ++seed) {
    std::mt19937 random(seed);
    file.write(text.substr(0, begin) + damaged(text.substr(begin, end - begin), random) + text.substr(end));
    try {
      read_parameters(file.path());
    } catch (const ParameterError&) {
    } catch (const std::exception& error) {
      FAIL() << "seed " << seed << ": " << error.what();
    }
  }
}

TEST(ReadParametersFuzz, ReadsOrRefusesWhateverAnOverlaySays) {
  const std::vector<std::string> paths = parameter_paths();
  for (unsigned seed = 0; seed < 1500; ++seed) {
    std::mt19937 random(seed);
    const std::string& path = paths[seed % paths.size()];
    try {
      const std::string value = seed % 2 == 0 ? "1000.0" : "{limit: 0.3, persistence: 0.1, reaction: warn}";
      read_parameters(shipped_path(), {{path, damaged(value, random), "server"}});
    } catch (const ParameterError&) {
    } catch (const std::exception& error) {
      FAIL() << "seed " << seed << ", " << path << ": " << error.what();
    }
  }
}

}  // namespace
}  // namespace robot_control

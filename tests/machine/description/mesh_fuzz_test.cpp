/// Broken files are refused or read, and nothing else happens. The failing seed is printed.

#include <gtest/gtest.h>

#include <random>

#include "machine/description/mesh.h"
#include "machine/description/mesh_faces.h"
#include "mesh_texts.h"

namespace robot_control::tests {

constexpr unsigned kSeeds = 2000;

/// Makes one to four changes: a bit, a cut, a piece repeated or moved, another number.
std::string broken(std::string text, std::mt19937& random) {
  const auto below = [&](std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random); };
  for (std::size_t change = 1 + below(4); change > 0 && !text.empty(); --change) {
    const std::size_t at = below(text.size());
    const std::size_t length = 1 + below(40);
    switch (below(6)) {
      case 0:
        text[at] = static_cast<char>(text[at] ^ (1 << below(8)));
        break;
      case 1:
        text.resize(at);
        break;
      case 2:
        text.erase(at, length);
        break;
      case 3:
        text.insert(below(text.size()), std::string(text.substr(at, length)));
        break;
      case 4:
        for (std::size_t i = 0; i < 3; ++i) text.insert(at, text.substr(at, length));
        break;
      default: {
        const std::size_t digit = text.find_first_of("0123456789", at);
        const char* const numbers[] = {"-1", "99999", "4294967295", "1e39", "nan", "0", ""};
        if (digit != std::string::npos) text.replace(digit, 1, numbers[below(std::size(numbers))]);
      }
    }
  }
  return text;
}

template <typename Parse>
void expect_only_faces_or_a_problem(const std::string& healthy, unsigned first, unsigned end, Parse parse) {
  for (unsigned seed = first; seed < end; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const MeshFaces faces = parse(broken(healthy, random));
    Points finite = faces.points;
    std::erase_if(finite, [](const Eigen::Vector3d& point) { return !point.allFinite(); });
    EXPECT_LE(hull_corners(finite).size(), kMaxHullCorners);
  }
}

TEST(MeshFuzz, BinaryStl) {
  expect_only_faces_or_a_problem(kBinaryStl, 0, kSeeds, parse_stl);
}

TEST(MeshFuzz, TextStl) {
  expect_only_faces_or_a_problem(kTextStl, 0, kSeeds, parse_stl);
}

/// First seed, and last seed + 1. Each runs as a process, which under a sanitizer takes a tenth of a second.
struct AssimpFuzz : testing::TestWithParam<std::pair<unsigned, unsigned>> {
  static void expect_only_faces_or_a_problem_of(const std::string& healthy, const char* format) {
    expect_only_faces_or_a_problem(healthy, GetParam().first, GetParam().second,
                                   [&](const std::string& text) { return parse_with_assimp(text, format); });
  }
};
INSTANTIATE_TEST_SUITE_P(EveryDay, AssimpFuzz, testing::Values(std::pair(0u, 40u)));
INSTANTIATE_TEST_SUITE_P(Nightly, AssimpFuzz, testing::Values(std::pair(40u, 200u)));

TEST_P(AssimpFuzz, Obj) {
  expect_only_faces_or_a_problem_of(kObj, "obj");
}

TEST_P(AssimpFuzz, Dae) {
  expect_only_faces_or_a_problem_of(kDae, "dae");
}

}  // namespace robot_control::tests

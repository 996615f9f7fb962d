#include "navigation/mapping/saved_map.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>

#include "navigation/mapping/graph_text.h"
#include "support/damaged_text.h"

namespace robot_control::navigation::tests {

using testing::HasSubstr;

/// Two nodes with a way and a closed loop between them, in a round room of 3 m.
PoseGraph healthy() {
  Scan scan{-M_PI, 2 * M_PI / 90, 0.05, 8.0, std::vector<float>(90, 3.1F)};
  scan.ranges[3] = INFINITY, scan.ranges[4] = NAN, scan.ranges[5] = 0;
  const Eigen::Matrix3d spread = Eigen::Vector3d(0.01, 0.02, 0.003).asDiagonal();
  PoseGraph graph;
  graph.nodes = {{{}, scan, {0.05, 0, 0}}, {{0.7, 0.1, 0.2}, scan, {0.05, 0, 0}}};
  graph.edges = {{0, 1, {{0.7, 0.1, 0.2}, spread}, false}, {0, 1, {{0.71, 0.1, 0.2}, spread}, true}};
  return graph;
}

/// Returns the sentence of the refusal of a healthy text in which `line` was replaced.
std::string refusal(const std::string& line, const std::string& instead) {
  std::string text = text_of(healthy());
  text.replace(text.find(line), line.size(), instead);
  try {
    graph_of(text);
  } catch (const MapError& error) {
    return error.what();
  }
  return "it was read";
}

TEST(GraphText, AWrittenGraphIsReadAgain) {
  const std::string text = text_of(healthy());
  EXPECT_EQ(text_of(graph_of(text)), text);
  EXPECT_THAT(text, HasSubstr("EDGE_SE2 0 1 0.7 0.1 0.2 100 0 0 50 0 333."));
  const PoseGraph graph = graph_of(text);
  EXPECT_FALSE(graph.edges[0].closes);
  EXPECT_TRUE(graph.edges[1].closes);
}

TEST(GraphText, EachWrongLineIsRefusedWithItsRule) {
  EXPECT_EQ(refusal("", ""), "it was read");
  EXPECT_THAT(refusal("VERTEX_SE2 1", "VERTEX_SE2 2"), HasSubstr("line 3: VERTEX_SE2 must have the next number"));
  EXPECT_THAT(refusal("VERTEX_SE2 1 0.7", "VERTEX_SE2 1 1e7"), HasSubstr("a pose within 1e+06 m"));
  EXPECT_THAT(refusal("VERTEX_SE2 1 0.7", "VERTEX_SE2 1 nan"), HasSubstr("a pose within 1e+06 m"));
  EXPECT_THAT(refusal("VERTEX_SE2 1", "SE2 1"), HasSubstr("line 3: VERTEX_SE2, SCAN or EDGE_SE2 must be"));
  EXPECT_THAT(refusal("SCAN 0.05", "SCAN 0,05"), HasSubstr("line 2: SCAN must follow its node"));
  EXPECT_THAT(refusal("0.05 8 3.1", "8 0.05 3.1"), HasSubstr("line 2: scan has range_min 8 m and range_max 0.05 m"));
  EXPECT_THAT(refusal("EDGE_SE2 0 1", "EDGE_SE2 1 1"), HasSubstr("line 5: EDGE_SE2 must lead from a node to a later"));
  EXPECT_THAT(refusal("EDGE_SE2 0 1", "EDGE_SE2 0 9"), HasSubstr("line 5: EDGE_SE2 must lead from a node to a later"));
  EXPECT_THAT(refusal("100 0 0 50", "100 0 0 -50"), HasSubstr("line 5: the information of EDGE_SE2 must be positive"));
  EXPECT_THAT(refusal(text_of(healthy()), ""), HasSubstr("each node must have a scan and an edge to it"));
  std::string text = text_of(healthy());
  text.erase(text.find("EDGE"));
  EXPECT_THROW(graph_of(text), MapError);
}

/// Whatever stands in the text, it is refused, or a map goes on with it.
TEST(GraphText, DamagedTextIsReadOrRefused) {
  int read = 0;
  for (unsigned seed = 0; seed < 300; ++seed) {
    std::mt19937 random(seed);
    std::string text = text_of(healthy());
    const std::size_t digit = text.find_first_of("0123456789", random() % text.size());
    if (digit < text.size()) text[digit] = static_cast<char>('0' + random() % 10);
    try {
      Mapper mapper(graph_of(seed % 2 == 0 ? text : damaged(text, random)));
      mapper.update(healthy().nodes[0].scan, {}, {});
      ++read;
    } catch (const MapError&) {
    } catch (const std::exception& error) {
      FAIL() << "seed " << seed << ": " << error.what();
    }
  }
  EXPECT_GT(read, 10);
}

struct SavedMapTest : testing::Test {
  void SetUp() override {
    std::filesystem::create_directories(folder_);
    save_map(path(""), Mapper(healthy()));
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string path(const std::string& extension) const { return (folder_ / ("house" + extension)).string(); }
  std::string text_at(const std::string& extension) const {
    std::ifstream file(path(extension), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  void write(const std::string& extension, const std::string& text) const {
    std::ofstream(path(extension), std::ios::binary) << text;
  }
  std::string refusal() const {
    try {
      load_map(path(".yaml"));
    } catch (const MapError& error) {
      return error.what();
    }
    return "it was read";
  }

  const std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("saved_map_test" + std::to_string(getpid()));
};

TEST_F(SavedMapTest, TheGraphGoesOn) {
  const Mapper mapper = load_map(path(".yaml"));
  EXPECT_EQ(text_of(mapper.graph()), text_of(healthy()));
  EXPECT_EQ(mapper.grid().cells, Mapper(healthy()).grid().cells);
}

TEST_F(SavedMapTest, AGraphThatIsCutOffAnywhereIsRefusedInOneSentence) {
  const std::string whole = text_at(".g2o");
  for (std::size_t length = 0; length < whole.size(); length += 1 + whole.size() / 200) {
    write(".g2o", whole.substr(0, length));
    ASSERT_THAT(refusal(), HasSubstr("house.g2o: its last line must be the sum")) << length;
  }
  EXPECT_THAT(refusal(), HasSubstr("or delete this one to continue with the picture"));
}

TEST_F(SavedMapTest, AGraphBesideAnotherPictureIsRefused) {
  write_map(path(""), {2, 1, 0.05, 0, 0, {kFreeCell, kOccupiedCell}});
  EXPECT_THAT(refusal(), HasSubstr("house.g2o: its last line must be the sum of the file and of its picture"));
  std::filesystem::remove(path(".g2o"));
  EXPECT_EQ(refusal(), "it was read");
}

TEST_F(SavedMapTest, AMapThatBeganWithAPictureLeavesNoOldGraph) {
  std::filesystem::remove(path(".g2o"));
  const Mapper mapper = load_map(path(".yaml"));
  save_map(path("2"), Mapper(healthy()));
  save_map(path("2"), mapper);
  EXPECT_FALSE(std::filesystem::exists(path("2.g2o")));
}

/// A file that cannot be written, and a graph that cannot be read again.
TEST_F(SavedMapTest, AMapThatCannotBeSavedLeavesTheOldOneAsItWas) {
  PoseGraph other = healthy();
  other.nodes[1].pose.x = 2;
  const std::string before = text_at(".pgm");
  std::filesystem::create_directory(path(".g2o.new"));
  std::ofstream(path(".g2o.new/file")) << "in the way";
  EXPECT_THROW(save_map(path(""), Mapper(other)), MapError);
  EXPECT_EQ(refusal(), "it was read");
  std::filesystem::remove_all(path(".g2o.new"));
  other.edges[0].measured.covariance.setConstant(NAN);
  EXPECT_THROW(save_map(path(""), Mapper(other)), MapError);
  EXPECT_EQ(refusal(), "it was read");
  EXPECT_EQ(text_at(".pgm"), before);
}

TEST_F(SavedMapTest, NothingIsWrittenWithoutAMap) {
  EXPECT_THROW(save_map(path(""), Mapper()), MapError);
  EXPECT_EQ(refusal(), "it was read");
}

}  // namespace robot_control::navigation::tests

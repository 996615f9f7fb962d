#include "navigation/map_file.h"

#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "support/matchers.h"

namespace robot_control::navigation::tests {

/// A map of 3 × 2 cells, as map_server's map_saver writes it.
struct MapFileTest : testing::Test {
  void SetUp() override {
    std::filesystem::create_directories(folder_);
    write("house.pgm", "P5\n# CREATOR: map_saver.cpp 0.050 m/pix\n3 2\n255\n" + std::string("\xfe\xcd\0\xfe\xfe\0", 6));
    write("house.yaml", kHead);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  Grid read(const std::string& name = "house.yaml") { return read_map((folder_ / name).string()); }

  /// Returns the sentence of the refusal, after one line of the healthy head was replaced.
  std::string refusal(const std::string& line, const std::string& instead) {
    std::string head = kHead;
    if (!line.empty()) head.replace(head.find(line), line.size(), instead);
    write("house.yaml", head);
    try {
      read();
    } catch (const MapError& error) {
      return error.what();
    }
    return "it was read";
  }

  const std::string kHead =
      "image: house.pgm\nresolution: 0.050000\norigin: [-7.0, -5.5, 0.000000]\nnegate: 0\n"
      "occupied_thresh: 0.65\nfree_thresh: 0.196\n\n";
  const std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("map_file_test" + std::to_string(getpid()));
};

TEST_F(MapFileTest, TheLowestRowOfThePictureIsTheFirstOfTheGrid) {
  const Grid grid = read();
  EXPECT_EQ(grid.columns, 3);
  EXPECT_EQ(grid.rows, 2);
  EXPECT_EQ(grid.origin_x, -7);
  EXPECT_EQ(grid.origin_y, -5.5);
  EXPECT_THAT(grid.cells, ElementsAre(0, 0, 100, 0, -1, 100));
  EXPECT_EQ(grid.cell_at(-6.94, -5.44), (Cell{1, 1}));
}

TEST_F(MapFileTest, AWrittenMapIsReadAgain) {
  write_map((folder_ / "copy.yaml").string(), read());
  const Grid copy = read("copy.yaml");
  EXPECT_EQ(copy.cells, read().cells);
  EXPECT_EQ(copy.origin_x, -7);
  EXPECT_EQ(copy.resolution, 0.05);
}

TEST_F(MapFileTest, AnyNameOfAFileIsReadAgain) {
  for (const std::string name : {"house #1.yaml", "my: house.yaml", "[x].yaml", "- a.yaml", "\"b\".yaml", " c.yaml"}) {
    write_map((folder_ / name).string(), read());
    EXPECT_EQ(read(name).cells, read().cells) << name;
  }
}

TEST_F(MapFileTest, APathWithoutANameOfAFileIsRefused) {
  EXPECT_THROW(write_map("", read()), MapError);
  EXPECT_THROW(write_map(folder_.string() + "/", read()), MapError);
}

/// The forms in which public packages keep the maps of map_server. Each is the head as it stands there.
TEST_F(MapFileTest, TheFilesOfPublicMapPackagesAreRead) {
  struct Public {
    const char* what;
    std::string yaml, picture;
  };
  const std::string pixels("\xfe\xcd\0\xfe\xfe\0", 6);
  const std::vector<Public> packages = {
      {"map_server's manual",
       "image: house.pgm\nresolution: 0.1\norigin: [0.0, 0.0, 0.0]\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"
       "negate: 0\n",
       "P5\n3 2\n255\n"},
      {"map_saver of Noetic",
       "image: " + (folder_ / "house.pgm").string() +
           "\nresolution: 0.050000\norigin: [-10.000000, -10.000000, 0.000000]\nnegate: 0\noccupied_thresh: 0.65\n"
           "free_thresh: 0.196\n\n",
       "P5\n# CREATOR: Map_generator.cpp 0.050 m/pix\n3 2\n255\n"},
      {"a folder beside the file, edited by GIMP",
       "image: ./house.pgm\nresolution: 0.05\norigin: [-6.8999999999999915, -5.8999999999999915, 0.0]\nnegate: 0\n"
       "occupied_thresh: 0.65\nfree_thresh: 0.196",
       "P5\n# Created by GIMP version 2.10.18 PNM plug-in\n3 2\n255\n"},
      {"map_saver of Nav2",
       "image: house.pgm\nmode: trinary\nresolution: 0.05\norigin: [-2.95, -2.58, 0]\nnegate: 0\n"
       "occupied_thresh: 0.65\nfree_thresh: 0.25\n",
       "P5\n3 2\n255\n"},
      {"lines that end as Windows ends them",
       "image: house.pgm\r\nresolution: 0.05\r\norigin: [0, 0, 0]\r\nnegate: 0\r\noccupied_thresh: 0.65\r\n"
       "free_thresh: 0.196\r\n",
       "P5\r\n3 2\r\n255\n"},
  };
  for (const auto& [what, yaml, picture] : packages) {
    write("house.yaml", yaml);
    write("house.pgm", picture + pixels);
    const bool unknown_is_free = yaml.find("free_thresh: 0.25") != std::string::npos;  // 205 is 19.6 % black
    EXPECT_THAT(read().cells, ElementsAre(0, 0, 100, 0, unknown_is_free ? 0 : -1, 100)) << what;
  }
}

/// The bytes are those of map_saver's savePGM, and the lines those of its YAML file: map_server reads them.
TEST_F(MapFileTest, AWrittenMapIsAFileOfMapServer) {
  write_map((folder_ / "copy").string(), read());
  const auto text_of = [&](const std::string& name) {
    std::ifstream file(folder_ / name, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  EXPECT_EQ(text_of("copy.pgm"), "P5\n3 2\n255\n" + std::string("\xfe\xcd\0\xfe\xfe\0", 6));
  EXPECT_EQ(text_of("copy.yaml"),
            "image: copy.pgm\nresolution: 0.05\norigin: [-7, -5.5, 0]\nnegate: 0\noccupied_thresh: 0.65\n"
            "free_thresh: 0.196\n");
}

TEST_F(MapFileTest, NegateSwapsFreeAndOccupied) {
  EXPECT_EQ(refusal("negate: 0", "negate: 1"), "it was read");
  EXPECT_THAT(read().cells, ElementsAre(100, 100, 0, 100, 100, 0));
}

TEST_F(MapFileTest, AScaledMapHasThePartOfBlackBetweenTheThresholds) {
  write("house.pgm", "P5\n3 2\n200\n" + std::string("\xc8\x64\0\x96\x50\x0a", 6));
  EXPECT_EQ(refusal("free_thresh: 0.196", "free_thresh: 0.2\nmode: scale"), "it was read");
  EXPECT_THAT(read().cells, ElementsAre(11, 89, 100, 0, 67, 100));  // (black - 0.2)/0.45 of black 0.25, 0.6 and 0.5
}

TEST_F(MapFileTest, EachWrongHeadIsRefusedWithItsValue) {
  using testing::HasSubstr;
  EXPECT_THAT(refusal("0.050000", "-0.05"), HasSubstr("resolution is -0.05 m: it must be from 0.001 to 10"));
  EXPECT_THAT(refusal("0.050000", ".nan"), HasSubstr("resolution is nan m"));
  EXPECT_THAT(refusal("0.000000]", "0.3]"), HasSubstr("origin is turned by 0.3 rad"));
  EXPECT_THAT(refusal("-7.0", "1e7"), HasSubstr("origin is (1e+07, -5.5) m: it must be within 1e+06 m"));
  EXPECT_THAT(refusal(", 0.000000]", "]"), HasSubstr("origin has 2 numbers"));
  EXPECT_THAT(refusal("free_thresh: 0.196", "free_thresh: 0.7"), HasSubstr("free_thresh < occupied_thresh"));
  EXPECT_THAT(refusal("negate: 0", "negate: 2"), HasSubstr("negate is 2"));
  EXPECT_THAT(refusal("negate: 0", "mode: raw\nnegate: 0"), HasSubstr("mode is 'raw': only trinary and scale are"));
  EXPECT_THAT(refusal("negate: 0", "negated: 0"), HasSubstr("the key 'negated' is not one of map_server"));
  EXPECT_THAT(refusal("negate: 0\n", ""), HasSubstr("the key negate is missing"));
  EXPECT_THAT(refusal("house.pgm", "none.pgm"), HasSubstr("none.pgm"));
  EXPECT_THAT(refusal("image: house.pgm", "image: [1"), HasSubstr("is not YAML"));
}

TEST_F(MapFileTest, EachWrongPictureIsRefused) {
  using testing::HasSubstr;
  const auto refused = [&](const std::string& picture) {
    write("house.pgm", picture);
    return refusal("", "");
  };
  EXPECT_THAT(refused("P5 3 2 255\n12345"), HasSubstr("is truncated: it has 5 of 6 pixels"));
  EXPECT_THAT(refused("P5 10000 10000 255\n123"), HasSubstr("10000 x 10000 cells: 1 to 25000000 are allowed"));
  EXPECT_THAT(refused("P5 -3 2 255\n123456"), HasSubstr("-3 x 2 cells"));
  EXPECT_THAT(refused("P5 3 2 65535\n123456789012"), HasSubstr("has 65535 grey values"));
  EXPECT_THAT(refused("P5 3 # 2"), HasSubstr("the header of the PGM is incomplete"));
  EXPECT_THAT(refused("\x89PNG"), HasSubstr("is not a binary PGM (P5)"));
  EXPECT_THAT(refused(""), HasSubstr("is not a binary PGM (P5)"));
}

}  // namespace robot_control::navigation::tests

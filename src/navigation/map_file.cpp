#include "navigation/map_file.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <optional>
#include <system_error>

#include "files/given_path.h"
#include "files/input_file.h"
#include "files/message_text.h"

namespace robot_control::navigation {
namespace {

constexpr std::size_t kMaxHead = 65536;  // bytes of a picture before its pixels, comments included
constexpr int kFreeUpTo = 25;            // %, of map_server's map_saver
constexpr auto kKeys = std::to_array<std::string_view>(
    {"image", "resolution", "origin", "negate", "occupied_thresh", "free_thresh", "mode"});

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw MapError(fit_for_message(shown_path(path) + ": " + why));
}

std::string read(const std::string& path, std::size_t max_bytes) {
  InputFile file = read_input_file(path, max_bytes);
  if (!file.problem.empty()) refuse(path, file.problem);
  return std::move(file.text);
}

std::string text_of(double value) {
  std::array<char, 32> buffer;
  return {buffer.data(), std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr};
}

struct Head {
  std::string image;
  double resolution = 0, origin_x = 0, origin_y = 0, yaw = 0, occupied = 0, free = 0;
  bool negate = false, scale = false;
};

template <class T>
T value_of(const std::string& path, const YAML::Node& node, const std::string& key, const char* what) {
  if (!node.IsDefined()) refuse(path, "the key " + key + " is missing; check that the file is a map of map_server");
  try {
    return node.as<T>();
  } catch (const YAML::Exception&) {
    refuse(path, key + " is not " + what);
  }
}

YAML::Node load(const std::string& path) {
  try {
    YAML::Node root = YAML::Load(read(path, kMaxParameterFile));
    if (!root.IsMap()) refuse(path, "is not a map of map_server: it has no keys");
    return root;
  } catch (const YAML::Exception& error) {
    refuse(path, std::string("is not YAML: ") + error.what());
  }
}

Head read_head(const std::string& path) {
  const YAML::Node root = load(path);
  for (const auto& entry : root) {
    const auto key = value_of<std::string>(path, entry.first, "a key", "text");
    if (std::ranges::find(kKeys, key) == kKeys.end()) refuse(path, "the key '" + key + "' is not one of map_server");
  }
  const auto number = [&](const char* key) { return value_of<double>(path, root[key], key, "a number"); };
  Head head;
  head.image = value_of<std::string>(path, root["image"], "image", "the path of a PGM file");
  head.resolution = number("resolution");
  const auto origin = value_of<std::vector<double>>(path, root["origin"], "origin", "three numbers");
  if (origin.size() != 3) refuse(path, "origin has " + std::to_string(origin.size()) + " numbers instead of x, y, yaw");
  head.origin_x = origin[0], head.origin_y = origin[1], head.yaw = origin[2];
  head.occupied = number("occupied_thresh"), head.free = number("free_thresh");
  if (!(0 <= head.free && head.free < head.occupied && head.occupied <= 1)) {
    refuse(path, "free_thresh is " + text_of(head.free) + " and occupied_thresh " + text_of(head.occupied) +
                     ": 0 ≤ free_thresh < occupied_thresh ≤ 1 must hold");
  }
  const double negate = number("negate");
  if (negate != 0 && negate != 1) refuse(path, "negate is " + text_of(negate) + ": it must be 0 or 1");
  head.negate = negate == 1;
  const std::string mode = root["mode"] ? value_of<std::string>(path, root["mode"], "mode", "text") : "trinary";
  if (mode != "trinary" && mode != "scale") refuse(path, "mode is '" + mode + "': only trinary and scale are read");
  head.scale = mode == "scale";
  return head;
}

/// Reads the next number of a PGM's head, after white space and comments.
std::optional<long> next_number(std::string_view& text) {
  while (!text.empty() && (std::isspace(static_cast<unsigned char>(text[0])) != 0 || text[0] == '#')) {
    text.remove_prefix(text[0] == '#' ? std::min(text.find('\n'), text.size()) : 1);
  }
  long number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{}) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return number;
}

Grid read_picture(const std::string& path, std::string_view text, const Head& head, const std::string& yaml) {
  if (!text.starts_with("P5")) refuse(path, "is not a binary PGM (P5); convert it: convert map.png map.pgm");
  text.remove_prefix(2);
  const auto columns = next_number(text), rows = next_number(text), white = next_number(text);
  if (!columns || !rows || !white || text.empty()) refuse(path, "the header of the PGM is incomplete");
  if (*white < 1 || *white > 255) refuse(path, "has " + std::to_string(*white) + " grey values: at most 255 are read");
  const std::string problem = grid_problem(static_cast<double>(*columns), static_cast<double>(*rows), head.resolution,
                                           head.origin_x, head.origin_y, head.yaw);
  if (!problem.empty()) refuse(yaml, problem);
  text.remove_prefix(1);
  const std::size_t cells = static_cast<std::size_t>(*columns) * static_cast<std::size_t>(*rows);
  if (text.size() < cells) {
    refuse(path, "is truncated: it has " + std::to_string(text.size()) + " of " + std::to_string(cells) + " pixels");
  }
  Grid grid{static_cast<int>(*columns), static_cast<int>(*rows), head.resolution, head.origin_x, head.origin_y, {}};
  grid.cells.resize(cells);
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const char pixel = text[grid.index({column, grid.rows - 1 - row})];
      const double share = static_cast<unsigned char>(pixel) / static_cast<double>(*white);
      const double black = head.negate ? share : 1 - share;
      const long scaled = std::lround(100 * (black - head.free) / (head.occupied - head.free));
      grid.cells[grid.index({column, row})] = black > head.occupied ? kOccupiedCell
                                              : black < head.free   ? kFreeCell
                                              : head.scale          ? static_cast<std::int8_t>(scaled)
                                                                    : kUnknownCell;
    }
  }
  return grid;
}

}  // namespace

std::string grid_problem(double columns, double rows, double resolution, double origin_x, double origin_y,
                         double origin_yaw) {
  if (!(resolution >= 0.001 && resolution <= 10)) {
    return "resolution is " + text_of(resolution) + " m: it must be from 0.001 to 10";
  }
  if (!(columns >= 1 && rows >= 1 && columns * rows <= static_cast<double>(kMaxCells))) {
    return "the map has " + text_of(columns) + " x " + text_of(rows) + " cells: 1 to " + std::to_string(kMaxCells) +
           " are allowed; crop it, or set a coarser resolution";
  }
  if (!(std::abs(origin_x) <= kFarthest && std::abs(origin_y) <= kFarthest)) {
    return "origin is (" + text_of(origin_x) + ", " + text_of(origin_y) + ") m: it must be within 1e+06 m";
  }
  if (!(std::abs(origin_yaw) <= 1e-6)) {
    return "origin is turned by " + text_of(std::round(origin_yaw * 1000) / 1000) +
           " rad: only 0 is allowed; turn the picture instead";
  }
  return "";
}

Grid read_map(const std::string& given) {
  const std::string path = resolved_path(given);
  const Head head = read_head(path);
  const std::string image = resolved_path(head.image, std::filesystem::path(path).parent_path());
  return read_picture(image, read(image, kMaxCells + kMaxHead), head, path);
}

Grid as_saved(const Grid& grid) {
  Grid saved = grid;
  for (std::int8_t& cell : saved.cells)
    cell = cell >= kOccupiedFrom ? kOccupiedCell : cell >= 0 && cell <= kFreeUpTo ? kFreeCell : kUnknownCell;
  return saved;
}

std::vector<OutputFile> map_files(const std::string& given, const Grid& grid) {
  std::filesystem::path path = resolved_path(given);
  if (path.extension() == ".yaml") path.replace_extension();
  const std::string stem = path.filename().string();
  if (stem.empty()) refuse(given, "is not a file; give the path of the YAML file");
  if (const std::string why = grid_problem(grid.columns, grid.rows, grid.resolution, grid.origin_x, grid.origin_y, 0);
      !why.empty())
    refuse(given, why);
  std::string pixels(grid.cells.size(), '\xcd');  // 205, map_server's unknown
  const Grid saved = as_saved(grid);
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const int cell = saved.cells[grid.index({column, row})];
      char& pixel = pixels[grid.index({column, grid.rows - 1 - row})];
      if (cell == kFreeCell) pixel = '\xfe';
      if (cell == kOccupiedCell) pixel = '\0';
    }
  }
  return {{path.string() + ".pgm",
           "P5\n" + std::to_string(grid.columns) + " " + std::to_string(grid.rows) + "\n255\n" + pixels},
          {path.string() + ".yaml", "image: " + YAML::Dump(YAML::Node(stem + ".pgm")) +
                                        "\nresolution: " + text_of(grid.resolution) + "\norigin: [" +
                                        text_of(grid.origin_x) + ", " + text_of(grid.origin_y) +
                                        ", 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"}};
}

void write_map(const std::string& path, const Grid& grid) {
  try {
    write_output_files(map_files(path, grid));
  } catch (const std::system_error& error) {
    throw MapError(error.what());
  }
}

}  // namespace robot_control::navigation

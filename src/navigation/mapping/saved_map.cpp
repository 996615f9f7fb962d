#include "navigation/mapping/saved_map.h"

#include <bit>
#include <filesystem>
#include <system_error>

#include "files/given_path.h"
#include "files/input_file.h"
#include "files/message_text.h"
#include "files/output_file.h"
#include "navigation/mapping/graph_text.h"
#include "signals/checksum.h"

namespace robot_control::navigation {
namespace {

constexpr std::size_t kMaxGraph = std::size_t{256} << 20U;  // bytes: 40 km
constexpr const char* kSum = "# ";

std::filesystem::path path_of(const std::string& given, const char* extension) {
  std::filesystem::path path = resolved_path(given);
  if (path.extension() == ".yaml") path.replace_extension();
  return path += extension;
}

std::string sum_of(std::string_view lines, const Grid& grid) {
  Checksum sum;
  sum.mix(lines);
  sum.mix(std::string_view(reinterpret_cast<const char*>(grid.cells.data()), grid.cells.size()));
  for (const double value : {grid.resolution, grid.origin_x, grid.origin_y})
    sum.mix(std::bit_cast<std::uint64_t>(value));
  return kSum + hex(sum.sum()) + "\n";
}

PoseGraph read_graph(const std::string& path, const Grid& grid) try {
  const InputFile file = read_input_file(path, kMaxGraph);
  if (!file.problem.empty()) throw MapError(file.problem);
  const std::size_t end = std::min(file.text.rfind(kSum), file.text.size());
  const std::string_view lines = std::string_view(file.text).substr(0, end);
  if (file.text.substr(end) != sum_of(lines, grid))
    throw MapError("its last line must be the sum of the file and of its picture: one of them was changed or cut off");
  return graph_of(lines);
} catch (const MapError& error) {
  throw MapError(fit_for_message(path + ": " + error.what() +
                                 "; restore both files, or delete this one to continue with the picture"));
}

}  // namespace

void save_map(const std::string& path, const Mapper& mapper) {
  if (mapper.graph().nodes.empty()) throw MapError("there is no map yet: no scan with enough walls was received");
  const Grid grid = as_saved(mapper.grid());
  std::vector<OutputFile> files = map_files(path, grid);
  const std::filesystem::path beside = path_of(path, ".g2o");
  const bool from_picture = mapper.graph().nodes[0].scan.ranges.empty();
  try {
    if (from_picture) {
      std::filesystem::remove(beside);
    } else {
      const std::string lines = text_of(mapper.graph());
      graph_of(lines);
      files.push_back({beside.string(), lines + sum_of(lines, grid)});
      if (files.back().text.size() > kMaxGraph) throw MapError("the graph has more than 256 MB: map a smaller area");
    }
    write_output_files(files);
  } catch (const std::system_error& error) {
    throw MapError(error.what());
  }
}

Mapper load_map(const std::string& path) {
  const Grid grid = read_map(path);
  const std::string beside = path_of(path, ".g2o").string();
  return std::filesystem::exists(beside) ? Mapper(read_graph(beside, grid)) : Mapper(grid);
}

}  // namespace robot_control::navigation

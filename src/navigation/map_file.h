#pragma once
/// Reads and writes maps in the format of ROS's map_server: a YAML file that names a PGM picture.
///
///   image: house.pgm            counts from the folder of the YAML file
///   resolution: 0.05            m per pixel
///   origin: [-7, -5, 0]         m, m, rad of the lower left pixel
///   negate: 0                   1: black is free
///   occupied_thresh: 0.65       a pixel whose share of black is above it is occupied,
///   free_thresh: 0.196          below it free, else unknown
///   mode: trinary               may be absent; scale: what is between is free … occupied, 0 … 100 %
///
/// The picture is binary PGM (P5) of 8 bits. Other pictures, truncated ones and those of more than kMaxCells cells are
/// refused. So are a resolution beyond 0.001 … 10 m, an origin beyond 10⁶ m or turned, and another mode. Thresholds
/// must be within 0 … 1 and in this order. Every key but `mode` has to be there, and no other one.

#include <stdexcept>
#include <string>
#include <vector>

#include "files/output_file.h"
#include "navigation/grid.h"

namespace robot_control::navigation {

/// The text is one sentence with file, value, rule and remedy.
class MapError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// `path` is that of the YAML file. Throws MapError.
Grid read_map(const std::string& path);

/// Returns why such a grid is refused: "resolution is -1 m: …"; "" if it is not. It holds for files and for messages.
std::string grid_problem(double columns, double rows, double resolution, double origin_x, double origin_y,
                         double origin_yaw);

/// Returns the grid as read_map reads it: free up to 25 %, occupied from 65 % on, else unknown.
Grid as_saved(const Grid& grid);

/// Returns NAME.pgm and NAME.yaml for the path NAME or NAME.yaml. Throws MapError for a grid that read_map refuses.
std::vector<OutputFile> map_files(const std::string& path, const Grid& grid);

/// Writes these files. Throws MapError.
void write_map(const std::string& path, const Grid& grid);

}  // namespace robot_control::navigation

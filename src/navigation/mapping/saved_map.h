#pragma once
/// Saves the map of a Mapper, and begins one with a saved map.
///
/// NAME.yaml and NAME.pgm are those of map_server (map_file.h). NAME.g2o beside them is the graph (graph_text.h), with
/// a sum of it and of the picture as its last line, "# sum". The graph goes on only with the picture with which it was
/// saved. A map that began with a picture has no graph.

#include <string>

#include "navigation/mapping/mapper.h"

namespace robot_control::navigation {

/// `path` is NAME or NAME.yaml. All files are checked and written beside the old ones before the first one is replaced.
/// Throws MapError, also for what load_map would refuse; the old files then stay.
void save_map(const std::string& path, const Mapper& mapper);

/// `path` is NAME.yaml. The robot is at the origin. Throws MapError; one for a graph names its line.
Mapper load_map(const std::string& path);

}  // namespace robot_control::navigation

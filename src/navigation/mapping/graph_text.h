#pragma once
/// A PoseGraph as text of g2o (R. Kümmerle et al., g2o: a general framework for graph optimization, ICRA 2011) with
/// SCAN lines, which g2o ignores. Units are m and rad.
///
///   VERTEX_SE2 i x y yaw                                              node i = 0, 1, …
///   SCAN x y yaw angle_min angle_increment range_min range_max r …    of this node, with the pose of the laser in it
///   EDGE_SE2 from to x y yaw I11 I12 I13 I22 I23 I33                  from < to, with the information; the first edge
///                                                                     of a node is the way to it, others close loops

#include <string>
#include <string_view>

#include "navigation/map_file.h"
#include "navigation/mapping/pose_graph.h"

namespace robot_control::navigation {

/// Every node has a scan.
std::string text_of(const PoseGraph& graph);

/// Throws MapError with the line and the rule that it breaks.
PoseGraph graph_of(std::string_view text);

}  // namespace robot_control::navigation

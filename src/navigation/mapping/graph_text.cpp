#include "navigation/mapping/graph_text.h"

#include <Eigen/Eigenvalues>
#include <array>
#include <cfloat>
#include <charconv>
#include <system_error>

#include "navigation/scan_watch.h"

namespace robot_control::navigation {
namespace {

constexpr double kMinInformation = 1e-9, kMaxInformation = 1e12;  // of a matrix that can be inverted

template <class T>
void append(std::string& text, T number) {
  std::array<char, 32> buffer;
  text += ' ';
  text.append(buffer.data(), std::to_chars(buffer.data(), buffer.data() + buffer.size(), number).ptr);
}

void append(std::string& text, const PlanarPose& pose) {
  for (const double value : {pose.x, pose.y, pose.yaw}) append(text, value);
}

/// Returns the numbers of a line after its first word; none if one of them is not a number.
std::vector<double> numbers_of(std::string_view line) {
  std::vector<double> numbers;
  const char *at = line.data() + std::min(line.find(' '), line.size()), *end = line.data() + line.size();
  while (at < end) {
    const auto [next, error] = std::from_chars(at + 1, end, numbers.emplace_back());
    if (error != std::errc{} || (next < end && *next != ' ')) return {};
    at = next;
  }
  return numbers;
}

PlanarPose pose_at(const std::vector<double>& numbers, std::size_t first) {
  return {numbers[first], numbers[first + 1], numbers[first + 2]};
}

bool within(const PlanarPose& pose) {
  return std::abs(pose.x) <= kFarthest && std::abs(pose.y) <= kFarthest && std::abs(pose.yaw) <= kFarthest;
}

/// The graph grows by lines; one that is refused returns the rule that it breaks.
class GraphOfLines {
 public:
  std::string add(std::string_view line) {
    const std::vector<double> numbers = numbers_of(line);
    if (line.starts_with("VERTEX_SE2 ")) return add_node(numbers);
    if (line.starts_with("SCAN ")) return add_scan(numbers);
    if (line.starts_with("EDGE_SE2 ")) return add_edge(numbers);
    return "VERTEX_SE2, SCAN or EDGE_SE2 must be its first word";
  }

  /// Returns what is missing.
  std::string missing() const {
    const std::size_t nodes = graph.nodes.size();
    return nodes > 0 && scans_ == nodes && reached_ == nodes - 1 ? "" : "each node must have a scan and an edge to it";
  }

  PoseGraph graph;

 private:
  std::string add_node(const std::vector<double>& numbers) {
    const std::size_t nodes = graph.nodes.size();
    if (numbers.size() != 4 || numbers[0] != static_cast<double>(nodes) || scans_ != nodes || !graph.edges.empty() ||
        !within(pose_at(numbers, 1)))
      return "VERTEX_SE2 must have the next number and a pose within 1e+06 m";
    graph.nodes.push_back({pose_at(numbers, 1), {}, {}});
    return "";
  }

  std::string add_scan(const std::vector<double>& numbers) {
    if (numbers.size() < 7 || scans_ + 1 != graph.nodes.size() || !within(pose_at(numbers, 0)))
      return "SCAN must follow its node, and have the pose of the laser, angles, limits and ranges";
    Scan scan{numbers[3], numbers[4], numbers[5], numbers[6], {}};
    for (std::size_t i = 7; i < numbers.size(); ++i) {
      const bool fits = !std::isfinite(numbers[i]) || std::abs(numbers[i]) <= static_cast<double>(FLT_MAX);
      scan.ranges.push_back(fits ? static_cast<float>(numbers[i]) : 0);
    }
    if (std::string problem = scan_problem(scan); !problem.empty()) return problem;
    graph.nodes[scans_].laser = pose_at(numbers, 0);
    graph.nodes[scans_++].scan = std::move(scan);
    return "";
  }

  std::string add_edge(const std::vector<double>& numbers) {
    const auto nodes = static_cast<double>(graph.nodes.size());
    if (numbers.size() != 11 || !(0 <= numbers[0] && numbers[0] < numbers[1] && numbers[1] < nodes) ||
        numbers[0] != std::floor(numbers[0]) || numbers[1] != std::floor(numbers[1]) || !within(pose_at(numbers, 2)))
      return "EDGE_SE2 must lead from a node to a later one, and have a pose within 1e+06 m and six numbers";
    Eigen::Matrix3d information;
    information << numbers[5], numbers[6], numbers[7], numbers[6], numbers[8], numbers[9], numbers[7], numbers[9],
        numbers[10];
    const Eigen::Vector3d parts = information.selfadjointView<Eigen::Lower>().eigenvalues();
    if (!(parts.minCoeff() >= kMinInformation && parts.maxCoeff() <= kMaxInformation))
      return "the information of EDGE_SE2 must be positive: from 1e-09 to 1e+12 in each direction";
    const auto from = static_cast<std::size_t>(numbers[0]), to = static_cast<std::size_t>(numbers[1]);
    ways_.resize(graph.nodes.size());
    graph.edges.push_back({from, to, {pose_at(numbers, 2), information.inverse()}, ways_[to]});
    if (!ways_[to]) ++reached_;
    ways_[to] = true;
    return "";
  }

  std::size_t scans_ = 0, reached_ = 0;
  std::vector<bool> ways_;  // for each node, whether an edge leads to it
};

}  // namespace

std::string text_of(const PoseGraph& graph) {
  std::string text;
  for (std::size_t i = 0; i < graph.nodes.size(); ++i) {
    const auto& [pose, scan, laser] = graph.nodes[i];
    append(text += "VERTEX_SE2", i);
    append(text, pose);
    append(text += "\nSCAN", laser);
    for (const double value : {scan.angle_min, scan.angle_increment, scan.range_min, scan.range_max})
      append(text, value);
    for (const float range : scan.ranges) append(text, range);
    text += '\n';
  }
  for (const Edge& edge : graph.edges) {
    append(text += "EDGE_SE2", edge.from);
    append(text, edge.to);
    append(text, edge.measured.mean);
    const Eigen::Matrix3d information = edge.measured.covariance.inverse();
    for (int row = 0; row < 3; ++row) {
      for (int column = row; column < 3; ++column) append(text, information(row, column));
    }
    text += '\n';
  }
  return text;
}

PoseGraph graph_of(std::string_view text) {
  GraphOfLines lines;
  for (int number = 1; !text.empty(); ++number) {
    const std::size_t length = std::min(text.find('\n'), text.size());
    if (const std::string rule = lines.add(text.substr(0, length)); !rule.empty())
      throw MapError("line " + std::to_string(number) + ": " + rule);
    text.remove_prefix(std::min(length + 1, text.size()));
  }
  if (const std::string rule = lines.missing(); !rule.empty()) throw MapError(rule);
  return std::move(lines.graph);
}

}  // namespace robot_control::navigation

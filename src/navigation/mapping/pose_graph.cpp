#include "navigation/mapping/pose_graph.h"

#include <ceres/autodiff_cost_function.h>
#include <ceres/loss_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <Eigen/Cholesky>
#include <array>
#include <queue>

namespace robot_control::navigation {
namespace {

/// The error of an edge, in units of its deviation.
struct EdgeError {
  PlanarPose measured;
  Eigen::Matrix3d root;  // of the information

  template <class T>
  bool operator()(const T* from, const T* to, T* error) const {
    const T c = ceres::cos(from[2]), s = ceres::sin(from[2]), x = to[0] - from[0], y = to[1] - from[1];
    const T turn = to[2] - from[2] - measured.yaw;
    const Eigen::Matrix<T, 3, 1> off(c * x + s * y - measured.x, c * y - s * x - measured.y,
                                     ceres::atan2(ceres::sin(turn), ceres::cos(turn)));
    Eigen::Map<Eigen::Matrix<T, 3, 1>>(error, 3) = root.cast<T>() * off;
    return true;
  }
};

struct Frontier {
  double length;
  std::size_t node;
  UncertainPose relative;
  bool operator<(const Frontier& other) const { return length > other.length; }
};

}  // namespace

std::vector<Reached> PoseGraph::reach(std::size_t start, double length) const {
  std::vector<std::vector<const Edge*>> edges_of(nodes.size());
  for (const Edge& edge : edges) edges_of[edge.from].push_back(&edge), edges_of[edge.to].push_back(&edge);
  std::vector<bool> done(nodes.size());
  std::vector<Reached> result;
  std::priority_queue<Frontier> open;
  open.push({0, start, {}});
  while (!open.empty()) {
    const Frontier next = open.top();
    open.pop();
    if (done[next.node]) continue;
    done[next.node] = true;
    const PlanarPose now = composed(inverse(nodes[start].pose), nodes[next.node].pose);
    result.push_back({next.node, next.length, {now, next.relative.covariance}});
    for (const Edge* edge : edges_of[next.node]) {
      const double end = next.length + std::hypot(edge->measured.mean.x, edge->measured.mean.y);
      const bool forward = edge->from == next.node;
      const std::size_t node = forward ? edge->to : edge->from;
      if (end > length || done[node]) continue;
      open.push({end, node, composed(next.relative, forward ? edge->measured : inverse(edge->measured))});
    }
  }
  return result;
}

void PoseGraph::optimise() {
  std::vector<std::array<double, 3>> poses;
  for (const GraphNode& node : nodes) poses.push_back({node.pose.x, node.pose.y, node.pose.yaw});
  ceres::Problem problem;
  for (const Edge& edge : edges) {
    const Eigen::Matrix3d root = Eigen::LLT<Eigen::Matrix3d>(edge.measured.covariance.inverse()).matrixU();
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<EdgeError, 3, 3, 3>(new EdgeError{edge.measured.mean, root}),
        edge.closes ? new ceres::CauchyLoss(2) : nullptr, poses[edge.from].data(), poses[edge.to].data());
  }
  if (!problem.HasParameterBlock(poses[0].data())) return;
  problem.SetParameterBlockConstant(poses[0].data());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.logging_type = ceres::SILENT;
  options.max_num_iterations = 50;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (!summary.IsSolutionUsable()) return;
  for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i].pose = {poses[i][0], poses[i][1], poses[i][2]};
}

}  // namespace robot_control::navigation

#include "navigation/mapping/pose_graph.h"

#include <gtest/gtest.h>

namespace robot_control::navigation::tests {

/// A square of four ways of 10 m, each of which was measured as turned by 0.05 rad too much.
struct PoseGraphTest : testing::Test {
  PoseGraphTest() {
    graph_.nodes.resize(5);
    for (std::size_t i = 0; i < 4; ++i) {
      graph_.edges.push_back({i, i + 1, {{10, 0, M_PI / 2 + 0.05}, spread(0.1, 0.05)}});
      graph_.nodes[i + 1].pose = composed(graph_.nodes[i].pose, graph_.edges[i].measured.mean);
    }
  }
  static Eigen::Matrix3d spread(double distance, double turn) {
    return Eigen::Vector3d(distance * distance, distance * distance, turn * turn).asDiagonal();
  }
  double error() const { return std::hypot(graph_.nodes[2].pose.x - 10, graph_.nodes[2].pose.y - 10); }

  PoseGraph graph_;
};

TEST_F(PoseGraphTest, AClosedLoopSharesItsErrorAmongTheWays) {
  const double before = error();
  graph_.edges.push_back({0, 4, {{0, 0, 0}, spread(0.01, 0.003)}, true});
  graph_.optimise();
  EXPECT_LT(error(), before / 3);
  EXPECT_NEAR(std::hypot(graph_.nodes[4].pose.x, graph_.nodes[4].pose.y), 0, 0.05);
  EXPECT_EQ(graph_.nodes[0].pose.x, 0);
}

TEST_F(PoseGraphTest, AWrongLoopAgainstARightOneBendsTheMapLittle) {
  graph_.edges.push_back({0, 4, {{0, 0, 0}, spread(0.01, 0.003)}, true});
  graph_.optimise();
  const std::vector<GraphNode> right = graph_.nodes;
  graph_.edges.push_back({0, 2, {{4, 0, 0}, spread(0.01, 0.003)}, true});
  graph_.optimise();
  for (std::size_t i = 0; i < right.size(); ++i) {
    EXPECT_NEAR(graph_.nodes[i].pose.x, right[i].pose.x, 0.5) << i;
    EXPECT_NEAR(graph_.nodes[i].pose.y, right[i].pose.y, 0.5) << i;
  }
}

TEST_F(PoseGraphTest, ReachFollowsTheEdgesAndItsCovarianceGrows) {
  const std::vector<Reached> near = graph_.reach(1, 15);
  ASSERT_EQ(near.size(), 3U);
  EXPECT_EQ(near[0].node, 1U);
  EXPECT_EQ(near[0].length, 0);
  EXPECT_EQ(near[1].length, 10);
  const std::vector<Reached> all = graph_.reach(0, HUGE_VAL);
  EXPECT_GT(all[4].relative.covariance.trace(), all[1].relative.covariance.trace());
}

}  // namespace robot_control::navigation::tests

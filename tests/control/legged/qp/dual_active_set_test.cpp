#include "control/legged/qp/dual_active_set.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <random>

#include "support/allocation_guard.h"

namespace robot_control::tests {

using Qp = DualActiveSet<4, 8>;
using Random = std::mt19937;

constexpr double kPrecision = 1e-8;  // the promise, of numbers of magnitude one, and relative of larger ones

Qp::Problem problem_of(int variables, int rows) {
  Qp::Problem problem;
  problem.hessian = Qp::Square::Identity(variables, variables);
  problem.gradient = Qp::Vector::Zero(variables);
  problem.rows.setZero(rows, variables);
  problem.bounds.setZero(rows);
  return problem;
}

/// The x among all sets of at most n independent rows that fulfils the conditions of Karush, Kuhn and Tucker best.
std::optional<Eigen::VectorXd> by_enumeration(const Qp::Problem& problem) {
  std::optional<Eigen::VectorXd> best;
  double least = 1e-9;
  const Eigen::MatrixXd hessian = problem.hessian.selfadjointView<Eigen::Lower>();
  const int n = static_cast<int>(problem.gradient.size()), m = static_cast<int>(problem.bounds.size());
  for (unsigned set = 0; set < 1u << m; ++set) {
    const int count = __builtin_popcount(set);
    if (count > n) continue;
    Eigen::MatrixXd system = Eigen::MatrixXd::Zero(n + count, n + count);
    Eigen::VectorXd right(n + count);
    system.topLeftCorner(n, n) = hessian;
    right.head(n) = -problem.gradient;
    for (int row = 0, i = n; row < m; ++row) {
      if ((set >> row & 1u) == 0) continue;
      system.row(i).head(n) = problem.rows.row(row);
      system.col(i).head(n) = -problem.rows.row(row).transpose();
      right[i++] = problem.bounds[row];
    }
    const Eigen::FullPivLU<Eigen::MatrixXd> decomposition(system);
    if (!decomposition.isInvertible()) continue;
    const Eigen::VectorXd x = decomposition.solve(right);
    const double violation = m > 0 ? (problem.bounds - problem.rows * x.head(n)).maxCoeff() : 0;
    const double wrong =
        std::max({0.0, violation, count > 0 ? -x.tail(count).minCoeff() : 0}) / std::max(1.0, x.norm());
    if (wrong >= least) continue;
    least = wrong;
    best = x.head(n);
  }
  return best;
}

double uniform(Random& random, double lowest, double highest) {
  return std::uniform_real_distribution<double>(lowest, highest)(random);
}

double integer(Random& random, int largest) {
  return std::uniform_int_distribution<int>(-largest, largest)(random);
}

/// Random rows; `kind` chooses how degenerate they are.
Qp::Problem random_problem(Random& random, int kind) {
  const int n = 1 + static_cast<int>(random() % 4), m = static_cast<int>(random() % 9);
  Qp::Problem problem = problem_of(n, m);
  const auto number = [&] { return kind == 0 ? uniform(random, -3, 3) : integer(random, 2); };
  Eigen::MatrixXd factor(n, n);
  for (int i = 0; i < n; ++i) {
    problem.gradient[i] = number();
    for (int j = 0; j < n; ++j) factor(i, j) = number();
  }
  problem.hessian = factor * factor.transpose() + Eigen::MatrixXd::Identity(n, n);
  Eigen::VectorXd vertex(n);
  for (int i = 0; i < n; ++i) vertex[i] = number();
  for (int row = 0; row < m; ++row) {
    for (int i = 0; i < n; ++i) problem.rows(row, i) = number();
    problem.bounds[row] = number();
    if (kind == 2) problem.bounds[row] = problem.rows.row(row).dot(vertex);  // all rows meet in one vertex
    if (kind == 3 && row > 0) {  // a multiple of another row: parallel, or opposite
      const double scale = integer(random, 2);
      problem.rows.row(row) = scale * problem.rows.row(row - 1);
      problem.bounds[row] = scale * problem.bounds[row - 1];
    }
  }
  return problem;
}

TEST(DualActiveSet, SolvesRandomProblemsAsTheEnumerationOfAllActiveSetsDoes) {
  constexpr int kProblems = 100'000;
  int solved = 0, infeasible = 0;
  for (int seed = 0; seed < kProblems; ++seed) {
    Random random(static_cast<unsigned>(seed));
    const Qp::Problem problem = random_problem(random, seed % 4);
    Qp qp;
    const QpOutcome outcome = qp.solve(problem);
    const std::optional<Eigen::VectorXd> expected = by_enumeration(problem);
    ASSERT_EQ(outcome, expected ? QpOutcome::kSolved : QpOutcome::kInfeasible) << "seed " << seed;
    if (!expected) {
      ++infeasible;
      continue;
    }
    ++solved;
    ASSERT_LT((qp.solution() - *expected).norm(), kPrecision * std::max(1.0, expected->norm())) << "seed " << seed;
    Eigen::VectorXd slope = problem.hessian * qp.solution() + problem.gradient;
    double size = 1;
    for (Eigen::Index i = 0; i < qp.active_count(); ++i) {
      ASSERT_GE(qp.multiplier(i), -kPrecision) << "seed " << seed;
      slope -= qp.multiplier(i) * problem.rows.row(qp.active_row(i)).transpose();
      size = std::max(size, qp.multiplier(i));
    }
    ASSERT_LT(slope.norm(), kPrecision * size) << "seed " << seed;
  }
  EXPECT_GT(solved, kProblems / 2);
  EXPECT_GT(infeasible, kProblems / 100);
}

TEST(DualActiveSet, ReportsAHessianThatIsNotPositiveDefinite) {
  Qp::Problem problem = problem_of(2, 0);
  problem.hessian(1, 1) = 0;
  Qp qp;
  EXPECT_EQ(qp.solve(problem), QpOutcome::kNotConvex);
  problem.hessian(1, 1) = -1;
  EXPECT_EQ(qp.solve(problem), QpOutcome::kNotConvex);
}

TEST(DualActiveSet, ReportsNumbersThatAreNotFinite) {
  const double nan = std::nan("");
  for (int part = 0; part < 4; ++part) {
    Qp::Problem problem = problem_of(2, 1);
    (part == 0   ? problem.hessian(0, 0)
     : part == 1 ? problem.gradient[1]
     : part == 2 ? problem.rows(0, 0)
                 : problem.bounds[0]) = nan;
    Qp qp;
    EXPECT_EQ(qp.solve(problem), QpOutcome::kNotFinite) << part;
  }
}

TEST(DualActiveSet, ReportsASolutionThatIsNotFinite) {
  Qp::Problem problem = problem_of(1, 0);
  problem.hessian(0, 0) = 1e-300;
  problem.gradient[0] = 1e300;
  Qp qp;
  EXPECT_EQ(qp.solve(problem), QpOutcome::kNotFinite);
}

TEST(DualActiveSet, ARowOfZerosIsFulfilledOrInfeasibleByItsBound) {
  Qp::Problem problem = problem_of(2, 1);
  Qp qp;
  problem.bounds[0] = -1;
  EXPECT_EQ(qp.solve(problem), QpOutcome::kSolved);
  problem.bounds[0] = 1;
  EXPECT_EQ(qp.solve(problem), QpOutcome::kInfeasible);
}

TEST(DualActiveSet, ReadsTheLowerTriangleAlone) {
  Qp::Problem problem = problem_of(2, 0);
  problem.hessian << 2, 100, 1, 2;
  problem.gradient << -3, 0;
  Qp qp;
  ASSERT_EQ(qp.solve(problem), QpOutcome::kSolved);
  EXPECT_NEAR(qp.solution()[0], 2, kPrecision);  // of [2 1; 1 2] x = [3; 0]
  EXPECT_NEAR(qp.solution()[1], -1, kPrecision);
}

/// The largest problem of a walking robot: 60 variables, a friction pyramid of six rows for each three of them.
TEST(DualActiveSet, SolvesTheLargestProblemWithoutAllocation) {
  using Large = DualActiveSet<60, 120>;
  static Large qp;
  static Large::Problem problem;
  Random random(1);
  Eigen::MatrixXd factor(60, 60);
  for (Eigen::Index i = 0; i < factor.size(); ++i) factor(i) = uniform(random, -1, 1);
  problem.hessian = factor * factor.transpose() + Eigen::MatrixXd::Identity(60, 60);
  problem.gradient.resize(60);
  problem.rows.setZero(120, 60);
  problem.bounds.setZero(120);
  constexpr double kFriction = 0.4, kLargest = 50, kSmallest = 2;
  for (Eigen::Index foot = 0; foot < 20; ++foot) {
    Eigen::Matrix<double, 6, 3> pyramid;
    pyramid << -1, 0, kFriction, 1, 0, kFriction, 0, -1, kFriction, 0, 1, kFriction, 0, 0, 1, 0, 0, -1;
    problem.rows.block<6, 3>(6 * foot, 3 * foot) = pyramid;
    problem.bounds[6 * foot + 4] = kSmallest;
    problem.bounds[6 * foot + 5] = -kLargest;
    for (Eigen::Index i = 0; i < 3; ++i) problem.gradient[3 * foot + i] = uniform(random, -400, 400);
  }
  if (!AllocationGuard::kCounts) GTEST_SKIP() << "the sanitizer owns the allocator";
  QpOutcome outcome{};
  {
    const AllocationGuard guard;
    outcome = qp.solve(problem);
    EXPECT_EQ(guard.count(), 0u);
  }
  ASSERT_EQ(outcome, QpOutcome::kSolved);
  EXPECT_GT(qp.active_count(), 10);
  EXPECT_TRUE(((problem.rows * qp.solution() - problem.bounds).array() > -kPrecision).all());
  Eigen::VectorXd slope = problem.hessian * qp.solution() + problem.gradient;
  for (Eigen::Index i = 0; i < qp.active_count(); ++i)
    slope -= qp.multiplier(i) * problem.rows.row(qp.active_row(i)).transpose();
  EXPECT_LT(slope.norm(), kPrecision * problem.gradient.norm());
}

}  // namespace robot_control::tests

#pragma once
/// A dense convex quadratic program, solved by the dual active-set method.
///
///   min over x of  ½ xᵀ H x + gᵀ x    subject to    A x ≥ b
///
/// H is symmetric and positive definite; its lower triangle is read. At the solution H x + g = Aᵀ u, where u ≥ 0 are
/// the multipliers of the active rows, those with (A x)ᵢ = bᵢ.
///
/// The method starts at the minimum without rows and adds the row that is violated most, until none is (D. Goldfarb,
/// A. Idnani, Mathematical Programming 27 (1983) 1, section 3). With H = L Lᵀ and N the active rows as columns, it
/// keeps J = L⁻ᵀ Q and the triangle R of the factors L⁻¹ N = Q [R; 0], and updates them by Givens rotations.
///
/// Tolerances are relative. A row counts as violated if (A x)ᵢ is less than bᵢ by kTolerance (|Aᵢ| s + |bᵢ|), s the
/// largest |x| on the way. A row is dependent on the active ones if less than kDependent of its length in the metric
/// H⁻¹ stands free of them.
///
/// Real-time safe: `solve` uses memory of the object alone. Its cost is bounded by the number of steps.

#include <Eigen/Cholesky>
#include <array>
#include <cmath>
#include <limits>

namespace robot_control {

enum class QpOutcome {
  kSolved,
  kInfeasible,  ///< No x fulfils all rows.
  kNotConvex,   ///< H is not positive definite.
  kNotFinite,   ///< A number of the problem, or of the solution, is not finite.
  kStepLimit,   ///< kMaxSteps changes of the active rows did not suffice.
};

/// kVariables and kRows are the largest numbers of variables and rows.
template <int kVariables, int kRows>
class DualActiveSet {
 public:
  static constexpr double kTolerance = 1e-11;
  static constexpr double kDependent = 1e-9;
  static constexpr int kMaxSteps = 4 * (kVariables + kRows);

  using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kVariables, 1>;
  using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kVariables, kVariables>;

  struct Problem {
    Square hessian;                                                                                  ///< H, n × n
    Vector gradient;                                                                                 ///< g, n
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, kRows, kVariables> rows;  ///< A, m × n
    Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kRows, 1> bounds;                      ///< b, m
  };

  /// The solution and multipliers are valid after kSolved alone.
  QpOutcome solve(const Problem& problem) noexcept {
    const Eigen::Index n = problem.gradient.size();
    active_count_ = 0;
    steps_ = 0;
    size_ = 0;
    if (!problem.gradient.allFinite() || !problem.rows.allFinite() || !problem.bounds.allFinite())
      return QpOutcome::kNotFinite;
    if (!factorise(problem)) return QpOutcome::kNotConvex;
    triangle_.setZero(n, n);
    multipliers_.setZero(n);
    active_.fill(false);
    while (true) {
      if (!solution_.allFinite()) return QpOutcome::kNotFinite;  // whatever stood in H
      const Eigen::Index row = most_violated(problem);
      if (row < 0) return QpOutcome::kSolved;
      const QpOutcome outcome = activate(problem, row);
      if (outcome != QpOutcome::kSolved) return outcome;
    }
  }

  const Vector& solution() const noexcept { return solution_; }
  /// Changes of the set of active rows in the last call of `solve`.
  int steps() const noexcept { return steps_; }
  /// Active rows of the solution.
  Eigen::Index active_count() const noexcept { return active_count_; }
  Eigen::Index active_row(Eigen::Index i) const noexcept { return order_[static_cast<std::size_t>(i)]; }
  /// Multiplier of active_row(i).
  double multiplier(Eigen::Index i) const noexcept { return multipliers_[i]; }

 private:
  /// Sets J = L⁻ᵀ and the minimum without rows. Returns false if H is not positive definite.
  bool factorise(const Problem& problem) noexcept {
    const Eigen::Index n = problem.gradient.size();
    factor_ = problem.hessian;
    const Eigen::LLT<Eigen::Ref<Square>, Eigen::Lower> decomposition(factor_);
    if (decomposition.info() != Eigen::Success) return false;
    const auto lower = factor_.template triangularView<Eigen::Lower>();
    basis_.setIdentity(n, n);
    lower.adjoint().solveInPlace(basis_);
    solution_ = -problem.gradient;
    lower.solveInPlace(solution_);
    lower.adjoint().solveInPlace(solution_);
    return true;
  }

  double violation(const Problem& problem, Eigen::Index row) const noexcept {
    return problem.bounds[row] - problem.rows.row(row).dot(solution_);
  }

  /// Returns the inactive row that is violated most in relation to its length, or −1.
  Eigen::Index most_violated(const Problem& problem) noexcept {
    Eigen::Index worst = -1;
    double largest = 0;
    size_ = std::fmax(size_, solution_.norm());
    for (Eigen::Index row = 0; row < problem.bounds.size(); ++row) {
      if (active_[static_cast<std::size_t>(row)]) continue;
      const double length = problem.rows.row(row).norm();
      const double excess = violation(problem, row);
      if (excess <= kTolerance * (length * size_ + std::abs(problem.bounds[row]))) continue;
      if (worst >= 0 && excess <= largest * length) continue;
      worst = row;
      largest = length > 0 ? excess / length : std::numeric_limits<double>::infinity();
    }
    return worst;
  }

  /// Adds a violated row, and removes those that it makes superfluous.
  QpOutcome activate(const Problem& problem, Eigen::Index row) noexcept {
    const Eigen::Index n = solution_.size();
    double multiplier = 0;  // of the row
    while (true) {
      if (++steps_ > kMaxSteps) return QpOutcome::kStepLimit;
      projected_.noalias() = basis_.transpose() * problem.rows.row(row).transpose();
      const Eigen::Index count = active_count_;
      change_ = projected_.head(count);  // of the active multipliers, per unit of the row's
      triangle_.topLeftCorner(count, count).template triangularView<Eigen::Upper>().solveInPlace(change_);
      Eigen::Index blocking = -1;
      double longest = std::numeric_limits<double>::infinity();
      for (Eigen::Index i = 0; i < count; ++i) {
        if (change_[i] <= 0 || multipliers_[i] >= longest * change_[i]) continue;
        blocking = i;
        longest = std::fmax(0, multipliers_[i]) / change_[i];
      }
      const double free = projected_.tail(n - count).squaredNorm();
      const bool dependent = free <= kDependent * kDependent * projected_.squaredNorm();
      if (dependent && blocking < 0) return QpOutcome::kInfeasible;
      const double full = dependent ? std::numeric_limits<double>::infinity() : violation(problem, row) / free;
      const double step = std::fmin(longest, full);
      if (!dependent) solution_.noalias() += step * (basis_.rightCols(n - count) * projected_.tail(n - count));
      multipliers_.head(count) -= step * change_;
      multiplier += step;
      if (full <= longest) {
        append(row, multiplier);
        return QpOutcome::kSolved;
      }
      remove(blocking);
    }
  }

  struct Rotation {
    double cosine, sine;
  };

  /// Returns the rotation that turns (a, b) into (√(a² + b²), 0).
  static Rotation rotation(double a, double b) noexcept {
    const double length = std::hypot(a, b);
    return {a / length, b / length};
  }

  void turn_basis(Eigen::Index first, const Rotation& by) noexcept {
    for (Eigen::Index i = 0; i < basis_.rows(); ++i) {
      const double a = basis_(i, first), b = basis_(i, first + 1);
      basis_(i, first) = by.cosine * a + by.sine * b;
      basis_(i, first + 1) = by.cosine * b - by.sine * a;
    }
  }

  /// Makes `row` the last active one. `projected_` is Jᵀ of it.
  void append(Eigen::Index row, double multiplier) noexcept {
    for (Eigen::Index i = solution_.size() - 1; i > active_count_; --i) {
      if (projected_[i] == 0) continue;
      const Rotation by = rotation(projected_[i - 1], projected_[i]);
      projected_[i - 1] = by.cosine * projected_[i - 1] + by.sine * projected_[i];
      turn_basis(i - 1, by);
    }
    triangle_.col(active_count_).head(active_count_ + 1) = projected_.head(active_count_ + 1);
    multipliers_[active_count_] = multiplier;
    order_[static_cast<std::size_t>(active_count_)] = row;
    active_[static_cast<std::size_t>(row)] = true;
    ++active_count_;
  }

  /// Takes the active row of index `which` out.
  void remove(Eigen::Index which) noexcept {
    active_[static_cast<std::size_t>(active_row(which))] = false;
    --active_count_;
    for (Eigen::Index i = which; i < active_count_; ++i) {
      order_[static_cast<std::size_t>(i)] = active_row(i + 1);
      multipliers_[i] = multipliers_[i + 1];
      triangle_.col(i).head(i + 2) = triangle_.col(i + 1).head(i + 2);
    }
    for (Eigen::Index i = which; i < active_count_; ++i) {  // each column has one entry below the diagonal now
      if (triangle_(i + 1, i) == 0) continue;
      const Rotation by = rotation(triangle_(i, i), triangle_(i + 1, i));
      for (Eigen::Index column = i; column < active_count_; ++column) {
        const double a = triangle_(i, column), b = triangle_(i + 1, column);
        triangle_(i, column) = by.cosine * a + by.sine * b;
        triangle_(i + 1, column) = by.cosine * b - by.sine * a;
      }
      turn_basis(i, by);
    }
  }

  Square factor_, basis_, triangle_;  ///< L, J, R
  Vector solution_, multipliers_, projected_, change_;
  std::array<Eigen::Index, static_cast<std::size_t>(kVariables)>
      order_{};  ///< active rows, in the order of R's columns
  std::array<bool, static_cast<std::size_t>(kRows)> active_{};
  Eigen::Index active_count_ = 0;
  double size_ = 0;  ///< largest |x| so far
  int steps_ = 0;
};

}  // namespace robot_control

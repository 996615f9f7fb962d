#pragma once
/// Plans the forces of the feet over the next steps in time, for a robot that counts as one rigid body (J. Di Carlo et
/// al., IROS 2018).
///
/// All vectors are in level axes that have the body's heading at the time of the plan. With y = [ roll pitch yaw,
/// centre of gravity ], feet rₐ from the centre of gravity, and small roll and pitch,
///
///   ÿ = Σ Bₐ fₐ + [0, g],    Bₐ = [ I⁻¹ rₐ× ; 1/m ]
///
/// The feet stand while the target moves: rₐ(t) = rₐ(0) − ∫ v dt. Its velocity v turns with its yaw rate. Each force is
/// constant within a step of h seconds. After step i the double integrator gives, with k = i − j,
///
///   yᵢ = y₀ + i h ẏ₀ + Σⱼ (k + ½) h² ÿⱼ,    ẏᵢ = ẏ₀ + Σⱼ h ÿⱼ
///
/// The plan minimises  Σᵢ |yᵢ − targetᵢ|² + |ẏᵢ − target_speed|² + Σ |f − w|², each with its weights. w is an equal
/// share of the weight, so that a robot at its target keeps it. Feet that swing have no variables. So the problem's
/// matrix consists of blocks Bₐᵀ diag(c) B_b, where c depends on two steps alone.
///
///   friction      |fx| ≤ μ fz, |fy| ≤ μ fz
///   unilateral    smallest ≤ fz ≤ largest
///
/// where f is in the axes of the ground. Its slope α needs tan α of the friction: μ is at least kSlopeGrip tan α.
///
/// The horizon is cut where the forces would be more than kPlanVariables. Real-time safe.

#include <Eigen/Core>
#include <array>

#include "control/legged/qp/dual_active_set.h"
#include "machine/legs/leg_model.h"

namespace robot_control {

inline constexpr int kPlanVariables = 60;
inline constexpr std::size_t kPlanSteps = 10;

/// Three angles in rad, and three lengths in m.
using PlanVector = Eigen::Matrix<double, 6, 1>;

struct ForcePlanParameters {
  double mass = 0;                                    ///< kg
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< kg·m², of the whole robot about its centre of gravity
  double horizon = 0;                                 ///< s
  PlanVector place_weight = PlanVector::Zero();       ///< 1/rad², 1/m²
  PlanVector speed_weight = PlanVector::Zero();       ///< s²/rad², s²/m²
  double force_weight = 0;                            ///< 1/N²
  double friction = 0;                                ///< μ
  double smallest = 0, largest = 0;                   ///< N, of a foot's force across the ground
};

/// Returns the parameters of a robot of this mass, inertia and leg length. Its weights are dimensionless in the units
/// of mass, length and gravity.
ForcePlanParameters force_plan_parameters(double mass, const Eigen::Matrix3d& inertia, double leg_length) noexcept;

struct ForcePlanInput {
  PlanVector place = PlanVector::Zero();         ///< y₀
  PlanVector speed = PlanVector::Zero();         ///< ẏ₀
  PlanVector target = PlanVector::Zero();        ///< of y now
  PlanVector target_speed = PlanVector::Zero();  ///< `target` moves with it; its length turns with its yaw rate
  /// m from the centre of gravity: where each foot bears, or will bear next.
  std::array<Eigen::Vector3d, kLegs> feet{};
  Eigen::Matrix3d ground = Eigen::Matrix3d::Identity();     ///< axes of the ground → level axes
  std::size_t steps = kPlanSteps;                           ///< 1 … kPlanSteps within the horizon
  std::array<std::array<bool, kLegs>, kPlanSteps> bears{};  ///< by step and leg
};

struct ForcePlanResult {
  QpOutcome outcome = QpOutcome::kSolved;
  /// N, of the first step; zero unless the outcome is kSolved.
  std::array<Eigen::Vector3d, kLegs> forces{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(),
                                            Eigen::Vector3d::Zero()};
  std::size_t steps = 0;  ///< of the horizon that the plan covers
};

class ForcePlan {
 public:
  explicit ForcePlan(const ForcePlanParameters& parameters) noexcept;

  ForcePlanResult step(const ForcePlanInput& input) noexcept;

 private:
  using Qp = DualActiveSet<kPlanVariables, 2 * kPlanVariables>;
  /// One force: its step and its leg.
  struct Variable {
    std::size_t step, leg;
  };

  std::size_t choose_variables(const ForcePlanInput& input) noexcept;
  void set_cost(const ForcePlanInput& input, double step, std::size_t steps) noexcept;
  void set_rows(const Eigen::Matrix3d& ground) noexcept;

  ForcePlanParameters parameters_;
  Eigen::Matrix3d inverse_inertia_;
  std::array<Variable, kPlanVariables / 3> variables_{};
  std::size_t count_ = 0;  ///< of variables_
  Qp::Problem problem_;
  Qp qp_;
};

}  // namespace robot_control

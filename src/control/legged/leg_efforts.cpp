#include <Eigen/Geometry>
#include <algorithm>

#include "control/legged/leg_controller.h"
#include "machine/gravity.h"

namespace robot_control {
namespace {

constexpr std::size_t kForwards = 0, kSideways = 1, kUpwards = 2, kTurning = 5;

}  // namespace

/// Returns the forces on the feet in N, stance axes, that accelerate the body along x, y and z and about the vertical.
std::array<Eigen::Vector3d, kLegs> LegController::pushing(const LoadInput& load,
                                                          const LeggedEquations& equations) const noexcept {
  std::array<Eigen::Vector3d, kLegs> result;
  result.fill(Eigen::Vector3d::Zero());
  double carried = 0, levers = 0;
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    carried += load.share[leg];
    levers += load.share[leg] * load.feet[leg].squaredNorm();
  }
  if (state_.phase != LegPhase::kStanding || carried < 1) return result;
  const Eigen::Vector3d force =
      dynamics_.mass() / carried *
      Eigen::Vector3d(state_.body[kForwards].acceleration, state_.body[kSideways].acceleration,
                      state_.body[kUpwards].acceleration);
  const double turning = equations.mass(5, 5) * state_.body[kTurning].acceleration / levers;
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const Eigen::Vector2d& lever = load.feet[leg];
    result[leg] = load.share[leg] * (force + turning * Eigen::Vector3d(-lever.y(), lever.x(), 0));
  }
  return result;
}

void LegController::write(const std::array<double, kLegsJoints>& rates, CommandFrame& out) noexcept {
  const Eigen::Matrix3d turned = rotation();
  const Eigen::Vector3d up = turned.row(2);
  LeggedMotion motion{.angles = state_.angles, .gravity = -kGravity * up};
  LeggedEquations equations;
  dynamics_.step(motion, equations);
  state_.centre = {equations.centre_of_gravity.x(), equations.centre_of_gravity.y()};
  LoadInput load{.share = state_.share};
  double carried = 0;
  // While the body accelerates, the forces balance about the point on which it leans.
  Eigen::Vector2d lean = Eigen::Vector2d::Zero();
  if (state_.phase == LegPhase::kStanding)
    lean = Eigen::Vector2d(state_.body[kForwards].acceleration, state_.body[kSideways].acceleration) / kGravity;
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const Eigen::Vector3d lever = turned * (foot_in_base(leg, turned) - equations.centre_of_gravity);
    load.feet[leg] = lever.head<2>() - lever.z() * lean;
    carried += state_.share[leg] / (kLegs - 1);
  }
  load.weight = dynamics_.mass() * kGravity * std::min(1.0, carried);
  const std::array<double, kLegs> forces = carried > 0 ? shared_loads(load) : std::array<double, kLegs>{};
  const std::array<Eigen::Vector3d, kLegs> pushes = pushing(load, equations);
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const std::size_t first = kLegJoints * leg;
    Eigen::Vector3d foot;
    const Eigen::Matrix3d jacobian = legs_[leg].kinematics.jacobian(LegModel::angles_of(state_.angles, leg), foot);
    const Eigen::Vector3d effort = equations.bias.segment<3>(static_cast<Eigen::Index>(6 + first)) -
                                   jacobian.transpose() * (forces[leg] * up + turned.transpose() * pushes[leg]);
    for (std::size_t i = 0; i < kLegJoints; ++i) {
      out.joints[first + i] = {.mode = JointMode::kImpedance,
                               .position = state_.angles[first + i],
                               .velocity = rates[first + i],
                               .stiffness = tuning_.stiffness,
                               .damping = tuning_.damping,
                               .effort = effort[static_cast<Eigen::Index>(i)]};
    }
  }
}

}  // namespace robot_control

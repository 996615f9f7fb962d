#include <Eigen/Geometry>
#include <algorithm>

#include "control/legged/leg_controller.h"
#include "control/legged/stand/foot_forces.h"
#include "machine/gravity.h"

namespace robot_control {
namespace {

constexpr double kSmooth = 0.005;  // s, low pass of the accelerations

using Vector = Eigen::Matrix<double, kLeggedDofs, 1>;

}  // namespace

/// Returns the rate of the reference in the base's axes.
LeggedMotion LegController::reference_motion(const Eigen::Matrix3d& turned,
                                             const std::array<double, kLegsJoints>& rates) const noexcept {
  LeggedMotion motion{.angles = state_.angles, .rates = rates};
  const Eigen::Matrix3d yawed = Eigen::AngleAxisd(state_.body[5].value, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  motion.linear =
      turned.transpose() * Eigen::Vector3d(state_.body[0].speed, state_.body[1].speed, state_.body[2].speed);
  motion.angular =
      state_.body[3].speed * Eigen::Vector3d::UnitX() +
      turned.transpose() * (state_.body[4].speed * yawed.col(1) + state_.body[5].speed * Eigen::Vector3d::UnitZ());
  motion.gravity = -kGravity * (turned.transpose() * Eigen::Map<const Eigen::Vector3d>(state_.up.data()));
  return motion;
}

void LegController::write(const std::array<double, kLegsJoints>& rates, CommandFrame& out) noexcept {
  const Pose pose = this->pose();
  const Eigen::Matrix3d turned = rotation(pose);
  const LeggedMotion motion = reference_motion(turned, rates);
  LeggedEquations equations;
  dynamics_.step(motion, equations);
  for (std::size_t i = 0; i < 3; ++i) state_.centre[i] = equations.centre_of_gravity[static_cast<Eigen::Index>(i)];
  accelerate(motion);
  const Vector efforts = equations.mass * Eigen::Map<const Vector>(state_.acceleration.data()) + equations.bias;
  FootForcesInput load{.share = state_.share, .up = turned.row(2)};
  double carried = 0;
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    load.feet[leg] = foot_in_base(leg, pose, turned);
    carried += state_.share[leg] / (kLegs - 1);
  }
  load.force = std::min(1.0, carried) * efforts.head<3>();
  load.moment = std::min(1.0, carried) * efforts.segment<3>(3);
  std::array<Eigen::Vector3d, kLegs> forces;
  forces.fill(Eigen::Vector3d::Zero());
  if (carried > 0) forces = foot_forces(load);
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const std::size_t first = kLegJoints * leg;
    Eigen::Vector3d foot;
    const Eigen::Matrix3d jacobian = legs_[leg].kinematics.jacobian(LegModel::angles_of(state_.angles, leg), foot);
    const Eigen::Vector3d effort =
        efforts.segment<3>(static_cast<Eigen::Index>(6 + first)) - jacobian.transpose() * forces[leg];
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

/// Filters the acceleration of the reference: Rᵀ p̈, ω̇, q̈.
void LegController::accelerate(const LeggedMotion& motion) noexcept {
  std::array<double, kLeggedDofs> velocity{};
  for (std::size_t i = 0; i < 3; ++i) {
    velocity[i] = motion.linear[static_cast<Eigen::Index>(i)];
    velocity[3 + i] = motion.angular[static_cast<Eigen::Index>(i)];
  }
  std::copy(motion.rates.begin(), motion.rates.end(), velocity.begin() + 6);
  for (std::size_t i = 0; i < velocity.size(); ++i) {
    const double change = (velocity[i] - state_.velocity[i]) / period_;
    state_.acceleration[i] += std::min(1.0, period_ / kSmooth) * (change - state_.acceleration[i]);
  }
  state_.velocity = velocity;
}

}  // namespace robot_control

#include "control/legged/stand/nominal_stance.h"

#include "control/legged/leg_tuning.h"
#include "control/legged/stand/foot_forces.h"

namespace robot_control {

NominalStance nominal_stance(const LegModel& robot) noexcept {
  const LegDynamics dynamics(robot);
  const double height = nominal_height(robot);
  NominalStance stance;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    Eigen::Vector3d& foot = stance.feet[leg];
    foot = robot.legs[leg].kinematics.position(robot.legs[leg].lying);
    foot.z() = robot.belly + robot.legs[leg].foot_radius - height;
    middle += foot / kLegs;
  }
  for (int pass = 0; pass < 2; ++pass) {  // the centre of gravity comes above the middle of the feet
    const Eigen::Vector3d off = stance.equations.centre_of_gravity - middle;
    for (std::size_t leg = 0; leg < kLegs; ++leg) {
      if (pass > 0) stance.feet[leg].head<2>() += off.head<2>();
      const LegSolution solution = robot.legs[leg].kinematics.inverse(stance.feet[leg]);
      if (pass > 0 && solution.reach != FootReach::kReached) stance.short_leg = static_cast<LegPlace>(leg);
      for (std::size_t i = 0; i < kLegJoints; ++i) stance.motion.angles[kLegJoints * leg + i] = solution.angles[i];
    }
    dynamics.step(stance.motion, stance.equations);
  }
  return stance;
}

Eigen::Matrix3d NominalStance::inertia() const noexcept {
  const Eigen::Matrix3d lever = cross_matrix(equations.centre_of_gravity);
  return equations.mass.block<3, 3>(3, 3) + equations.mass(0, 0) * lever * lever;
}

double nominal_height(const LegModel& robot) noexcept {
  const LegGeometry& first = robot.legs[0].kinematics.geometry();
  return leg_tuning(robot).height - first.hip.z() - first.upper.z() + robot.belly + robot.legs[0].foot_radius;
}

}  // namespace robot_control

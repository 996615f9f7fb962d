#include "estimation/legged/feet_motion.h"

#include <Eigen/Geometry>
#include <cmath>

namespace robot_control {

FeetMotion feet_motion(const std::array<Leg, kLegs>& legs, const SensorFrame& sensors, const Eigen::Vector3d& rate,
                       const Eigen::Vector3d& up) noexcept {
  FeetMotion feet;
  for (std::size_t i = 0; i < kLegsJoints; ++i) {
    feet.angles[i] = has_position(sensors.joints[i]) ? sensors.joints[i].position : 0;
    feet.rates[i] = valid_velocity(sensors.joints[i]);
  }
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const LegGeometry& geometry = legs[leg].kinematics.geometry();
    const Eigen::Vector3d speeds = LegModel::angles_of(feet.rates, leg);
    feet.jacobian[leg] = legs[leg].kinematics.jacobian(LegModel::angles_of(feet.angles, leg), feet.place[leg]);
    const double first = geometry.sign[0] * feet.angles[kLegJoints * leg];
    const double pitching = geometry.sign[1] * speeds[1] + geometry.sign[2] * speeds[2];
    const Eigen::Vector3d shank =
        rate + Eigen::Vector3d(geometry.sign[0] * speeds[0], pitching * std::cos(first), pitching * std::sin(first));
    feet.rolling[leg] = legs[leg].foot_radius * shank.cross(up);
    feet.base_velocity[leg] = feet.rolling[leg] - feet.jacobian[leg] * speeds - rate.cross(feet.place[leg]);
  }
  return feet;
}

}  // namespace robot_control

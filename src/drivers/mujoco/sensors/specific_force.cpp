#include "drivers/mujoco/sensors/specific_force.h"

#include "drivers/mujoco/model/point_velocity.h"

namespace robot_control {

SpecificForce::SpecificForce(const MujocoModel& model) : model_(model.model.get()), site_(model.imu) {}

void SpecificForce::reset(const mjData& data) noexcept {
  velocity_ = point_velocity(*model_, data, model_->site_bodyid[site_], data.site_xpos + 3 * site_);
  orientation_ = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(data.site_xmat + 9 * site_);
}

Eigen::Vector3d SpecificForce::step(const mjData& data) noexcept {
  const Eigen::Vector3d velocity_before = velocity_;
  const Eigen::Matrix3d orientation_before = orientation_;
  reset(data);
  const Eigen::Vector3d gravity(model_->opt.gravity);
  const Eigen::Vector3d force = (velocity_ - velocity_before) / model_->opt.timestep - gravity;
  return 0.5 * (orientation_before + orientation_).transpose() * force;
}

}  // namespace robot_control

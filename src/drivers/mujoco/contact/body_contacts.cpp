#include "drivers/mujoco/contact/body_contacts.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "drivers/mujoco/model/mjcf.h"
#include "drivers/mujoco/model/point_velocity.h"

namespace robot_control {
namespace {

using Vector = Eigen::Map<const Eigen::Vector3d>;

}  // namespace

BodyContacts::BodyContacts(const MujocoModel& model)
    : model_(model.model.get()), base_body_(model.base_body), number_of_(static_cast<std::size_t>(model_->nbody), -1) {
  if (model.robot.drive_wheels > 0) return;
  for (const std::string& link : model.robot.contacts) {
    const int body = mj_name2id(model_, mjOBJ_BODY, mjcf_body_name(link).c_str());
    number_of_[static_cast<std::size_t>(body)] = static_cast<int>(bodies_.size());
    bodies_.push_back({.body = body});
  }
}

void BodyContacts::weigh(const mjData& data) noexcept {
  if (bodies_.empty()) return;
  reset();
  for (int i = 0; i < data.ncon; ++i) {
    const mjContact& contact = data.contact[i];
    if (contact.efc_address < 0) continue;
    double side = -1;  // the contact's normal points from the first shape to the second
    for (const int geom : {contact.geom1, contact.geom2}) {
      const int number = number_of_[static_cast<std::size_t>(model_->geom_bodyid[geom])];
      if (number >= 0) add(bodies_[static_cast<std::size_t>(number)], data, i, side);
      side = 1;
    }
  }
  Eigen::Matrix<double, 3, 3, Eigen::RowMajor> to_world;
  std::copy_n(data.xmat + 9 * base_body_, 9, to_world.data());
  for (Body& body : bodies_) body.force = to_world.transpose() * body.force;
}

void BodyContacts::add(Body& body, const mjData& data, int index, double side) const noexcept {
  const mjContact& contact = data.contact[index];
  mjtNum force[6];
  mj_contactForce(model_, &data, index, force);
  const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> axes =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(contact.frame);
  body.normal_force += force[0];
  body.force += side * axes.transpose() * Vector(force);
  const int first = model_->geom_bodyid[contact.geom1], second = model_->geom_bodyid[contact.geom2];
  const Eigen::Vector3d sliding =
      point_velocity(*model_, data, first, contact.pos) - point_velocity(*model_, data, second, contact.pos);
  const Vector normal(contact.frame);
  if (force[0] > 0) body.slip = std::max(body.slip, (sliding - sliding.dot(normal) * normal).norm());
}

}  // namespace robot_control

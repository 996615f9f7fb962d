#include "drivers/mujoco/contact/wheel_contacts.h"

#include <Eigen/Dense>
#include <cmath>
#include <cstring>

#include "drivers/driver.h"
#include "drivers/mujoco/model/point_velocity.h"
#include "machine/gravity.h"

namespace robot_control {
namespace {

using Vector = Eigen::Map<const Eigen::Vector3d>;

const char* const kRegion = "friction/";

bool inside(const mjModel& model, const mjData& data, int region, const mjtNum* point) {
  mjtNum offset[3], local[3];
  mju_sub3(offset, point, data.geom_xpos + 3 * region);
  mju_mulMatTVec(local, data.geom_xmat + 9 * region, offset, 3, 3);
  const mjtNum* size = model.geom_size + 3 * region;
  if (model.geom_type[region] == mjGEOM_BOX) {
    return std::abs(local[0]) <= size[0] && std::abs(local[1]) <= size[1] && std::abs(local[2]) <= size[2];
  }
  const bool ball = model.geom_type[region] == mjGEOM_SPHERE;
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) sum += std::pow(local[axis] / size[ball ? 0 : axis], 2);
  return sum <= 1;
}

/// Returns the friction on the second shape in N, world axes. It is in the rows behind that of the normal, along the
/// other axes of the contact's frame.
Eigen::Vector3d native_friction(const mjData& data, const mjContact& contact) {
  if (contact.efc_address < 0 || contact.dim < 3) return Eigen::Vector3d::Zero();
  const mjtNum* force = data.efc_force + contact.efc_address;
  return force[1] * Vector(contact.frame + 3) + force[2] * Vector(contact.frame + 6);
}

void check_region(const mjModel& model, int region, const std::string& scene) {
  const int type = model.geom_type[region];
  const bool known = type == mjGEOM_BOX || type == mjGEOM_SPHERE || type == mjGEOM_ELLIPSOID;
  if (known && model.geom_contype[region] == 0 && model.geom_conaffinity[region] == 0) return;
  throw DriverError(scene + ": shape \"" + mj_id2name(&model, mjOBJ_GEOM, region) +
                    "\": a region of friction is a box, a sphere or an ellipsoid that collides with nothing. Give it "
                    "such a type, contype=\"0\" and conaffinity=\"0\", or another name.");
}

}  // namespace

WheelContacts::WheelContacts(const MujocoModel& model, const MujocoPlantParameters& parameters)
    : model_(model.model.get()),
      brush_(parameters.tyre == TyreModel::kBrush),
      sense_(parameters.contact_sensors),
      base_body_(model.base_body),
      drive_wheels_(model.robot.drive_wheels),
      ground_friction_(parameters.ground_friction),
      wheel_of_(static_cast<std::size_t>(model_->ngeom), -1),
      slip_noise_(model.robot.drive_wheels, parameters) {
  for (std::size_t i = 0; i < model.wheel_shape.size(); ++i) {
    Wheel wheel;
    wheel.shape = model.wheel_shape[i];
    wheel.body = model_->geom_bodyid[wheel.shape];
    wheel.dof = model_->body_dofadr[wheel.body];
    wheel.radius = model_->geom_size[3 * wheel.shape];
    wheel.omni = model.robot.wheels[i].omni;
    if (i < drive_wheels_) wheel.side = model.robot.wheels[i].side;
    wheel_of_[static_cast<std::size_t>(wheel.shape)] = static_cast<int>(i);
    wheels_.push_back(wheel);
  }
  for (int geom = 0; geom < model_->ngeom; ++geom) {
    const char* name = mj_id2name(model_, mjOBJ_GEOM, geom);
    if (name == nullptr || std::strncmp(name, kRegion, std::strlen(kRegion)) != 0) continue;
    check_region(*model_, geom, parameters.scene);
    regions_.push_back(geom);
  }
  measure_tyres(model);
}

void WheelContacts::measure_tyres(const MujocoModel& model) {
  const MujocoData data = set_down(model);
  mj_step1(model_, data.get());
  const int nv = model_->nv;
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const auto count = static_cast<Eigen::Index>(wheels_.size());
  Rows jacobian(3 * count, nv), answer(3 * count, nv);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Wheel& wheel = wheels_[static_cast<std::size_t>(i)];
    mjtNum point[3];
    mju_addScl3(point, data->geom_xpos + 3 * wheel.shape, model.up.data(), -wheel.radius);
    mj_jac(model_, data.get(), jacobian.data() + 3 * i * nv, nullptr, point, wheel.body);
  }
  mj_solveM(model_, data.get(), answer.data(), jacobian.data(), static_cast<int>(3 * count));
  const Eigen::MatrixXd mobility = jacobian * answer.transpose();
  const Vector up(model.up.data());
  const Eigen::Matrix3d tangent = Eigen::Matrix3d::Identity() - up * up.transpose();
  const double weight = model_->body_subtreemass[model.base_body] * kGravity;
  const std::size_t driven = drive_wheels_;
  for (Eigen::Index i = 0; i < count; ++i) {
    double sum = 0;
    for (Eigen::Index j = 0; j < count; ++j) sum += (tangent * mobility.block<3, 3>(3 * i, 3 * j) * tangent).norm();
    Wheel& wheel = wheels_[static_cast<std::size_t>(i)];
    const std::size_t sharing = static_cast<std::size_t>(i) < driven ? driven : wheels_.size();
    wheel.tyre = tyre_parameters(1 / sum, wheel.radius, weight / static_cast<double>(sharing), model_->opt.timestep);
  }
}

void WheelContacts::reset() {
  slip_noise_.reset();
  for (Wheel& wheel : wheels_) {
    wheel.contacts = {};
    wheel.normal_force = wheel.slip = 0;
    wheel.force.setZero();
  }
}

/// Advances the random slip by the mean distance of each side's wheels.
void WheelContacts::roll_on(const mjData& data) noexcept {
  for (const std::size_t side : {0u, 1u}) {
    double distance = 0;
    for (const Wheel& wheel : wheels_) {
      if (wheel.side == side) distance += std::abs(data.qvel[wheel.dof]) * wheel.radius * model_->opt.timestep;
    }
    slip_noise_.step(side, distance / static_cast<double>(drive_wheels_ / 2));
  }
}

void WheelContacts::observe(const mjData& data) noexcept {
  roll_on(data);
  for (Wheel& wheel : wheels_) {
    wheel.slip = 0;
    for (Contact& contact : wheel.contacts) contact.touches = false;
  }
  for (int i = 0; i < data.ncon; ++i) {
    for (const int geom : {data.contact[i].geom1, data.contact[i].geom2}) {
      const int wheel = wheel_of_[static_cast<std::size_t>(geom)];
      if (wheel >= 0) observe(wheels_[static_cast<std::size_t>(wheel)], data, i);
    }
  }
  for (Wheel& wheel : wheels_) {
    for (Contact& contact : wheel.contacts) {
      if (!contact.touches && contact.other >= 0) contact = {};
    }
  }
}

void WheelContacts::observe(Wheel& wheel, const mjData& data, int index) noexcept {
  const mjContact& contact = data.contact[index];
  const int other = contact.geom1 == wheel.shape ? contact.geom2 : contact.geom1;
  Contact* slot = nullptr;
  for (Contact& candidate : wheel.contacts) {
    if (!candidate.touches && candidate.other == other) {
      slot = &candidate;
      break;
    }
    if (slot == nullptr && candidate.other < 0) slot = &candidate;
  }
  if (slot == nullptr) return;
  slot->other = other;
  slot->touches = true;
  slot->address = index;
  slot->side = contact.geom2 == wheel.shape ? 1 : -1;

  const int ground = model_->geom_bodyid[other];
  TyreInput& input = slot->input;
  input.normal = Vector(contact.frame);
  input.velocity = point_velocity(*model_, data, wheel.body, contact.pos);
  input.turn_rate = Vector(data.cvel + 6 * wheel.body).dot(input.normal);
  if (model_->body_weldid[ground] != 0) {
    input.velocity -= point_velocity(*model_, data, ground, contact.pos);
    input.turn_rate -= Vector(data.cvel + 6 * ground).dot(input.normal);
  }
  if (wheel.side) input.velocity += added_speed(wheel, data, contact.pos);
  input.velocity -= input.velocity.dot(input.normal) * input.normal;
  if (wheel.omni) let_slide_aside(wheel, data, *slot);
  input.rim_speed = wheel.radius * data.qvel[wheel.dof];
  input.grip = friction(data, contact, other) * slot->normal_force;
  wheel.slip = std::max(wheel.slip, input.velocity.norm());
}

/// Returns ε times the speed in m/s that the wheel's rotation adds to its contact.
Eigen::Vector3d WheelContacts::added_speed(const Wheel& wheel, const mjData& data, const mjtNum* point) const noexcept {
  const Vector axle(data.xaxis + 3 * model_->body_jntadr[wheel.body]);
  const Eigen::Vector3d arm = Vector(point) - Vector(data.geom_xpos + 3 * wheel.shape);
  return slip_noise_.error(*wheel.side) * data.qvel[wheel.dof] * axle.cross(arm);
}

void WheelContacts::let_slide_aside(const Wheel& wheel, const mjData& data, Contact& contact) const noexcept {
  const Vector axle(data.xaxis + 3 * model_->body_jntadr[wheel.body]);
  const Eigen::Vector3d& normal = contact.input.normal;
  const Eigen::Vector3d aside = (axle - axle.dot(normal) * normal).normalized();
  contact.input.velocity -= contact.input.velocity.dot(aside) * aside;
  contact.input.turn_rate = 0;
  contact.state.deflection -= contact.state.deflection.dot(aside) * aside;
}

double WheelContacts::friction(const mjData& data, const mjContact& contact, int other) const noexcept {
  for (const int region : regions_) {
    if (inside(*model_, data, region, contact.pos)) return model_->geom_friction[3 * region];
  }
  return ground_friction_.value_or(model_->geom_friction[3 * other]);
}

// Adds Jᵀ f for the dofs that move the body, by their motion axes. It does the same as mj_applyFT at a fraction of the
// cost.
void WheelContacts::push(mjData& data, int body, const mjtNum* point, const Eigen::Vector3d& force,
                         const Eigen::Vector3d& torque) const noexcept {
  const int holder = model_->body_weldid[body];
  if (holder == 0) return;
  const Vector centre(data.subtree_com + 3 * model_->body_rootid[body]);
  const Eigen::Vector3d moment = torque + (Vector(point) - centre).cross(force);
  for (int dof = model_->body_dofadr[holder] + model_->body_dofnum[holder] - 1; dof >= 0;
       dof = model_->dof_parentid[dof]) {
    const mjtNum* axis = data.cdof + 6 * dof;
    data.qfrc_applied[dof] += Vector(axis).dot(moment) + Vector(axis + 3).dot(force);
  }
}

void WheelContacts::apply(mjData& data) noexcept {
  if (!brush_) return;
  for (Wheel& wheel : wheels_) {
    for (Contact& contact : wheel.contacts) {
      if (!contact.touches) continue;
      const TyreForce tyre = step_tyre(wheel.tyre, contact.state, contact.input, model_->opt.timestep);
      const mjtNum* point = data.contact[contact.address].pos;
      const Eigen::Vector3d torque = tyre.torque * contact.input.normal;
      contact.friction = tyre.force;
      push(data, wheel.body, point, tyre.force, torque);
      push(data, model_->geom_bodyid[contact.other], point, -tyre.force, -torque);
    }
  }
}

void WheelContacts::weigh(const mjData& data) noexcept {
  for (Wheel& wheel : wheels_) {
    wheel.normal_force = 0;
    for (Contact& contact : wheel.contacts) {
      if (!contact.touches) continue;
      // The first row is the normal force, both for a frictionless contact and for an elliptic cone.
      const int row = data.contact[contact.address].efc_address;
      contact.normal_force = row < 0 ? 0 : data.efc_force[row];
      wheel.normal_force += contact.normal_force;
    }
    if (sense_) sense(wheel, data);
  }
}

void WheelContacts::sense(Wheel& wheel, const mjData& data) const noexcept {
  using Rotation = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>;
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  for (const Contact& contact : wheel.contacts) {
    if (!contact.touches) continue;
    force += contact.side * contact.normal_force * contact.input.normal + contact.friction;
    if (!brush_) force += contact.side * native_friction(data, data.contact[contact.address]);
  }
  wheel.force = Rotation(data.xmat + 9 * base_body_).transpose() * force;
}

SlipNoise::SlipNoise(std::size_t wheels, const MujocoPlantParameters& parameters)
    : seed_(parameters.seed),
      deviation_(parameters.sensor_errors == ErrorLevel::kField && wheels > 2
                     ? parameters.wheel_slip_noise / std::sqrt(2 * kLength)
                     : 0) {
  reset();
}

void SlipNoise::reset() {
  random_[0].seed(seed_, kLeftSlipStream);
  random_[1].seed(seed_, kRightSlipStream);
  error_ = {};
}

void SlipNoise::step(std::size_t side, double distance) noexcept {
  if (deviation_ == 0 || distance == 0) return;
  const double kept = std::exp(-std::abs(distance) / kLength);
  double& error = error_[side];
  error = kept * error + deviation_ * std::sqrt(1 - kept * kept) * random_[side].next();
}

}  // namespace robot_control

#pragma once
/// BodyContacts measures how the ground touches the contact bodies of a machine without wheels
/// (MachineModel::contacts): the feet of a robot on legs. MuJoCo's own Coulomb friction acts there.
///
///   mj_step2  →  weigh  →  mj_step1
///
/// `weigh` reads the contacts at which the step began, with the forces of the step.

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <vector>

#include "drivers/mujoco/model/mujoco_model.h"

namespace robot_control {

class BodyContacts {
 public:
  /// A machine with wheels has none here.
  explicit BodyContacts(const MujocoModel& model);

  void reset() noexcept {
    for (Body& body : bodies_) body = {.body = body.body};
  }
  void weigh(const mjData& data) noexcept;

  std::size_t count() const noexcept { return bodies_.size(); }
  /// Returns the sum of the normal forces on body `i` in N.
  double normal_force(std::size_t i) const noexcept { return bodies_[i].normal_force; }
  /// Returns the force on body `i` in N, base axes.
  const Eigen::Vector3d& force(std::size_t i) const noexcept { return bodies_[i].force; }
  /// Returns how fast the contact point of body `i` slides over the other shape in m/s; of several the fastest.
  double slip(std::size_t i) const noexcept { return bodies_[i].slip; }

 private:
  struct Body {
    int body = 0;
    double normal_force = 0;
    Eigen::Vector3d force = Eigen::Vector3d::Zero();
    double slip = 0;
  };
  void add(Body& body, const mjData& data, int contact, double side) const noexcept;

  const mjModel* model_;
  int base_body_;
  std::vector<Body> bodies_;
  std::vector<int> number_of_;  ///< index into bodies_ per MuJoCo body; −1: none
};

}  // namespace robot_control

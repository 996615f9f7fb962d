#pragma once
/// The wheels' contacts with the world, and on brush tyres (tyre.h) their friction. In every MuJoCo step:
///
///   mj_step1  →  observe  →  apply  →  mj_step2  →  weigh
///
/// `observe` finds the contacts of the new state and their slip; `apply` adds the tyres' forces to qfrc_applied;
/// `weigh` reads the normal forces that the step found, which bound the friction of the next one. A wheel may stand
/// on several things at once (floor and kerb); each contact has a tyre state of its own, kept as long as wheel and
/// other shape touch.
///
/// Friction μ of a contact: that of a region of the scene in which it lies, else ground_friction, else the other
/// shape's `friction`. A region is a shape of the scene named "friction/…" that collides with nothing
/// (contype="0" conaffinity="0"); a box, sphere or ellipsoid. So a patch of ice lies in a floor that stays a plane.
///
/// A caster that nothing turns into the direction of travel (WheelModel::omni) has friction along its rolling direction
/// alone.
///
/// On brush tyres the drive wheels of a robot in the field slip at random (slip_noise.h).
///
/// Where contact sensors are asked for, `weigh` also finds the whole force on each wheel, friction included.
///
/// With native friction `apply` does nothing, MuJoCo's own forces act; regions then have no effect.
///
/// m of a tyre: 1/λ, λ = Σⱼ |Aᵢⱼ|, A = J M⁻¹ Jᵀ the accelerations that unit forces at the lowest points j of all the
/// wheels give to that of wheel i, at the start pose: Gershgorin's bound for all tyres acting at once.

#include <mujoco/mujoco.h>

#include <array>
#include <optional>
#include <vector>

#include "drivers/contact/slip_noise.h"
#include "drivers/contact/tyre.h"
#include "drivers/model/mujoco_model.h"
#include "drivers/mujoco_plant_parameters.h"

namespace robot_control {

class WheelContacts {
 public:
  /// Throws DriverError: a region that is none of the shapes above, or collides.
  WheelContacts(const MujocoModel& model, const MujocoPlantParameters& parameters);

  /// Nothing touches, all tyres are relaxed.
  void reset();

  void observe(const mjData& data) noexcept;
  void apply(mjData& data) noexcept;
  void weigh(const mjData& data) noexcept;

  /// N: sum over the contacts of drive wheel `wheel`, of the last `weigh`.
  double normal_force(std::size_t wheel) const noexcept { return wheels_[wheel].normal_force; }
  /// N, base axes: on `wheel`, of the last `weigh`; drive wheels, then casters. Zero without contact sensors.
  const Eigen::Vector3d& force(std::size_t wheel) const noexcept { return wheels_[wheel].force; }
  /// Drive wheels and casters.
  std::size_t count() const noexcept { return wheels_.size(); }
  /// m/s: the fastest contact's, of the last `observe`.
  double slip(std::size_t wheel) const noexcept { return wheels_[wheel].slip; }

 private:
  static constexpr std::size_t kContacts = 4;  ///< per wheel; more slide without friction

  struct Contact {
    int other = -1;  ///< geom; -1: free
    bool touches = false;
    int address = 0;  ///< into mjData::contact
    double normal_force = 0;
    double side = 1;  ///< +1: the contact's normal points to the wheel, else −1
    TyreInput input;
    TyreState state;
    Eigen::Vector3d friction = Eigen::Vector3d::Zero();  ///< N, world axes, of the tyre
  };
  struct Wheel {
    int shape = 0, body = 0, dof = 0;
    double radius = 0;
    bool omni = false;
    std::optional<Side> side;  ///< of a drive wheel
    TyreParameters tyre;
    std::array<Contact, kContacts> contacts;
    double normal_force = 0;
    Eigen::Vector3d force = Eigen::Vector3d::Zero();
    double slip = 0;
  };

  void observe(Wheel& wheel, const mjData& data, int contact) noexcept;
  void roll_on(const mjData& data) noexcept;
  Eigen::Vector3d added_speed(const Wheel& wheel, const mjData& data, const mjtNum* point) const noexcept;
  void let_slide_aside(const Wheel& wheel, const mjData& data, Contact& contact) const noexcept;
  double friction(const mjData& data, const mjContact& contact, int other) const noexcept;
  Eigen::Vector3d velocity(const mjData& data, int body, const mjtNum* point) const noexcept;
  void push(mjData& data, int body, const mjtNum* point, const Eigen::Vector3d& force,
            const Eigen::Vector3d& torque) const noexcept;
  void sense(Wheel& wheel, const mjData& data) const noexcept;
  void measure_tyres(const MujocoModel& model);

  const mjModel* model_;
  bool brush_;
  bool sense_;
  int base_body_;
  std::size_t drive_wheels_;
  std::optional<double> ground_friction_;
  std::vector<int> wheel_of_;  ///< per geom; -1: none
  std::vector<int> regions_;   ///< geoms
  std::vector<Wheel> wheels_;  ///< drive wheels, then casters
  SlipNoise slip_noise_;
};

}  // namespace robot_control

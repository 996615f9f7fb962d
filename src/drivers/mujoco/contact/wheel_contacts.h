#pragma once
/// WheelContacts finds the wheels' contacts with the world and computes the friction of brush tyres (tyre.h). In every
/// MuJoCo step:
///
///   mj_step1  →  observe  →  apply  →  mj_step2  →  weigh
///
/// `observe` finds the contacts of the new state and their slip. `apply` adds the tyres' forces to qfrc_applied.
/// `weigh` reads the normal forces of the step, which bound the friction in the next one. A wheel may touch several
/// shapes at once (floor and kerb). Each contact has its own tyre state as long as wheel and shape touch.
///
/// The friction μ of a contact is that of the scene's region that contains it, else ground_friction, else the other
/// shape's `friction`. A region is a box, sphere or ellipsoid of the scene named "friction/…" that collides with
/// nothing (contype="0" conaffinity="0"). So a patch of ice can be part of a plane floor.
///
/// A caster that does not swivel (TrueWheel::omni) has friction only along its rolling direction.
///
/// At error level kField, drive wheels with brush tyres slip at random (SlipNoise).
///
/// With contact sensors, `weigh` also computes the total force on each wheel with friction.
///
/// With native friction, MuJoCo's own forces act, and `apply` and regions have no effect.
///
/// The mass m of a tyre (tyre.h) is 1/λ with λ = Σⱼ |Aᵢⱼ| at the start pose. A = J M⁻¹ Jᵀ has the accelerations of
/// wheel i's lowest point by unit forces at the lowest points j of all wheels: Gershgorin's bound for all tyres at
/// once.

#include <mujoco/mujoco.h>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "drivers/mujoco/contact/tyre.h"
#include "drivers/mujoco/model/mujoco_model.h"
#include "drivers/mujoco/mujoco_plant_parameters.h"
#include "drivers/mujoco/sensors/normal_stream.h"

namespace robot_control {

/// SlipNoise computes the random slip of wheels behind each other, which scrub in every curve. The wheels of a side
/// roll as if their radius were (1 + ε) times the true one. Over the distance s of the rim, ε is an Ornstein–Uhlenbeck
/// process of the correlation length kLength. The difference between the distances of rim and ground therefore grows as
/// a random walk:
///
///   variance of ∫ε ds = σ² s  for s ≫ kLength        variance of ε = σ²/(2 kLength)
///
/// Here σ = wheel_slip_noise. The slip is zero unless sensor_errors is kField and the robot has more than one wheel per
/// side.
class SlipNoise {
 public:
  static constexpr double kLength = 0.1;  ///< m; in the recordings, slip is not correlated after half a second

  /// `wheels` is the number of drive wheels.
  SlipNoise(std::size_t wheels, const MujocoPlantParameters& parameters);

  void reset();

  /// Advances ε after the rims of `side` (0: left, 1: right) have rolled by `distance` m.
  void step(std::size_t side, double distance) noexcept;

  /// Returns ε of `side`.
  double error(std::size_t side) const noexcept { return error_[side]; }

 private:
  std::uint64_t seed_;
  double deviation_;  ///< standard deviation of ε
  std::array<NormalStream, 2> random_;
  std::array<double, 2> error_{};
};

class WheelContacts {
 public:
  /// Throws DriverError for a region of another shape, or one that collides.
  WheelContacts(const MujocoModel& model, const MujocoPlantParameters& parameters);

  /// Removes all contacts; all tyres are relaxed.
  void reset();

  void observe(const mjData& data) noexcept;
  void apply(mjData& data) noexcept;
  void weigh(const mjData& data) noexcept;

  /// Returns the sum of normal forces of `wheel` (drive wheels, then casters) in N at the last `weigh`.
  double normal_force(std::size_t wheel) const noexcept { return wheels_[wheel].normal_force; }
  /// Returns the force on `wheel` in N, base axes, at the last `weigh`; zero without
  /// contact sensors.
  const Eigen::Vector3d& force(std::size_t wheel) const noexcept { return wheels_[wheel].force; }
  /// Returns the number of drive wheels and casters.
  std::size_t count() const noexcept { return wheels_.size(); }
  /// Returns the slip of the fastest contact in m/s at the last `observe`.
  double slip(std::size_t wheel) const noexcept { return wheels_[wheel].slip; }

 private:
  static constexpr std::size_t kContacts = 4;  ///< per wheel; further contacts have no friction

  struct Contact {
    int other = -1;  ///< geom; -1: the contact is not used
    bool touches = false;
    int address = 0;  ///< index into mjData::contact
    double normal_force = 0;
    double side = 1;  ///< +1: the contact's normal points to the wheel, else −1
    TyreInput input;
    TyreState state;
    Eigen::Vector3d friction = Eigen::Vector3d::Zero();  ///< N, world axes, force of the tyre
  };
  struct Wheel {
    int shape = 0, body = 0, dof = 0;
    double radius = 0;
    bool omni = false;
    std::optional<std::size_t> side;  ///< of a drive wheel: index into MachineModel::groups
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
  std::vector<int> wheel_of_;  ///< index of the wheel per geom; -1: none
  std::vector<int> regions_;   ///< geoms
  std::vector<Wheel> wheels_;  ///< drive wheels, then casters
  SlipNoise slip_noise_;
};

}  // namespace robot_control

#pragma once
/// A robot whose joints hold it on its feet. While no foot has a share of the weight, they hold the legs alone.
///
/// The stance frame has its origin where that of the base was when it began to rise. Its x axis shows ahead, its z axis
/// up from the ground, whose slope the attitude gave in the lying posture (ground_slope.h). Let aᵢ be the feet, p the
/// body's position and R its rotation in it. The feet in the base's axes are Rᵀ(aᵢ − p), and the joint angles are those
/// of LegKinematics::inverse. A ball as a foot rolls: aᵢ moves with ωᵢ × (0, 0, r), ωᵢ the rate of the shank.
///
/// Each joint gets an impedance about its angle. The feed-forward is the effort of the whole robot's motion along its
/// reference, M a + h − Jᵀ f (leg_dynamics.h). The feet that stand give the force and the moment that moving the body
/// and all legs needs (foot_forces.h).

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "control/legged/leg_tuning.h"
#include "control/legged/tracked_axis.h"
#include "machine/legs/leg_dynamics.h"
#include "machine/legs/leg_model.h"
#include "signals/command_frame.h"
#include "signals/geometry.h"

namespace robot_control {

class Stance {
 public:
  /// The body in the stance frame: x, y, height above one that lies level in m, roll, pitch, yaw in rad.
  using Pose = std::array<double, 6>;
  static constexpr std::size_t kX = 0, kY = 1, kZ = 2, kRoll = 3, kPitch = 4, kYaw = 5;  ///< indices of a Pose

  struct State {
    LegsValues angles{};                             ///< rad, of the last command
    std::array<Vector3, kLegs> places{};             ///< m, aᵢ
    std::array<TrackedAxis, 6> body{};               ///< by index of a Pose
    std::uint64_t lifted = kLegs;                    ///< the leg in the air, or on its way; kLegs: none
    std::array<TrackedAxis, 3> foot{};               ///< m, of the lifted foot from its place
    std::array<double, kLegs> share{};               ///< of foot_forces.h
    Vector3 centre{};                                ///< m, of gravity, in the base's axes
    Vector3 up{0, 0, 1};                             ///< the vertical in the stance frame
    std::array<double, kLeggedDofs> velocity{};      ///< of the reference, in the order of leg_dynamics.h
    std::array<double, kLeggedDofs> acceleration{};  ///< of the reference, through a low pass
  };

  /// `period` s.
  Stance(const LegModel& robot, double period);

  /// Fills the joints of the command, and the twist of the body. The angles have changed with these rates in rad/s.
  void command(State& state, const LegsValues& rates, CommandFrame& out) const noexcept;

 protected:
  /// Moves the joint angles to those of the present pose, no faster than the joints may. The nearest angles to a foot
  /// out of reach are not continuous. Notes if a leg does not reach its foot.
  void set_angles(State& state, std::uint64_t& reasons) const noexcept;
  /// Returns what the standing legs have left in this pose of the body: the least of several angles in rad. They are
  /// those of joints to the ends of their ranges, of knees to kMinBend, and of shanks until their knees are on the
  /// ground. It is negative if a leg does not reach its foot.
  double spare(const State& state, const Pose& pose) const noexcept;
  /// Returns x and y of the body in m at which its centre of gravity is amid the feet, or above three of them.
  Eigen::Vector2d above_support(const State& state) const noexcept;
  static Pose pose(const State& state) noexcept;

  double period_;
  std::array<Leg, kLegs> legs_;
  LegTuning tuning_;
  double ground_;   ///< m, height of the ground below the base of a robot that lies level
  double nominal_;  ///< m, height of the standing body above one that lies level

 private:
  Eigen::Vector3d foot_in_base(const State& state, std::size_t leg, const Pose& pose,
                               const Eigen::Matrix3d& turned) const noexcept;
  void roll_feet(State& state, const LegsValues& rates) const noexcept;
  void accelerate(State& state, const LeggedMotion& motion) const noexcept;

  LegDynamics dynamics_;
  LegsValues joint_steps_{};  ///< rad, of a cycle at the speed limit
};

}  // namespace robot_control

#pragma once
/// How much of what they can the legs of a robot need to walk, in a pose of its body.
///
///   speed   |q̇| of a joint, of its velocity limit, during stance and swing (swing.h)
///   torque  |Jᵀ f| of a joint, of kEffortShare/kSpeedShare of its effort limit. f is the weight, on as many feet as
///           the gait leaves on the ground at least, at the ends and in the middle of a stance. It is parallel to the
///           line through the centre of gravity and the middle of the feet that bear: these turn no body, so the load
///           of a joint hardly grows where its foot moves away with those of the other legs
///   reach   infinite where a leg stretches beyond kLengthShare of its length, or a joint leaves its range, in other poses
///           than the nominal one less kFromEnd
///
/// The largest of these is at most kSpeedShare where the legs carry the body. The centre of gravity stays above the
/// middle of the nominal feet.

#include <Eigen/Core>
#include <array>

#include "control/legged/stand/nominal_stance.h"
#include "control/legged/walk/gait.h"
#include "control/legged/walk/twist_limiter.h"
#include "machine/legs/leg_model.h"

namespace robot_control {

inline constexpr double kSpeedShare = 0.85;
inline constexpr double kLengthShare = 0.95;
inline constexpr double kEffortShare = 0.97;  ///< the rest bears the leg itself (docs/evidence/legs.md, weak_hips)
inline constexpr double kFromEnd = 0.03;      ///< rad

/// Height in m, roll and pitch in rad of a body that walks, from the nominal pose.
using CarriedBody = std::array<double, 3>;

/// Returns the velocity in m/s of a foot that stands on the ground, below a body with this twist.
Eigen::Vector3d velocity_below(const Eigen::Vector3d& foot, const WalkingTwist& twist) noexcept;

class LegUse {
 public:
  static constexpr int kSamples = 24;  ///< of a swing

  LegUse(const LegModel& robot, const NominalStance& stance) noexcept;

  /// Returns what a steady walk needs, while the pose changes with `rates` in m/s and rad/s.
  double steady(const Gait& gait, const WalkingTwist& twist, const CarriedBody& body = {}, int samples = kSamples,
                const CarriedBody& rates = {}) const noexcept;

  /// Returns the same without torques.
  double swinging(const Gait& gait, const WalkingTwist& twist, const CarriedBody& body = {}, int samples = kSamples,
                  const CarriedBody& rates = {}) const noexcept;

  /// Returns what the feet need that stand on where `last` ends, at the end of their first stance in `next`.
  double changing(const Gait& last, const Gait& next, const WalkingTwist& twist) const noexcept;

 private:
  struct Place {
    Eigen::Matrix3d back = Eigen::Matrix3d::Identity();  ///< level axes → those of the base
    double height = 0;                                   ///< m
    double rises = 0;                                    ///< m/s
    Eigen::Vector3d turns = Eigen::Vector3d::Zero();     ///< rad/s, level axes
    double from_end = 0;                                 ///< rad, of joints from the ends of their ranges
  };
  static Place place_of(const CarriedBody& body, const CarriedBody& rates) noexcept;
  /// Returns where a foot stands in the middle of its stance (foothold.h).
  Eigen::Vector3d placed(std::size_t leg, const WalkingTwist& twist, const CarriedBody& body) const noexcept;
  /// Returns what a leg needs whose foot has this place and velocity, and bears this force, in level axes.
  double needed_at(std::size_t leg, const Place& body, const Eigen::Vector3d& place, const Eigen::Vector3d& velocity,
                   const Eigen::Vector3d& force) const noexcept;

  std::array<LegKinematics, kLegs> legs_;
  LegsValues speeds_{};                        ///< rad/s, limits
  LegsValues efforts_{};                       ///< N·m, of torques that count as the speed limit
  std::array<Eigen::Vector3d, kLegs> feet_{};  ///< m, nominal
  Eigen::Vector3d centre_;                     ///< m, of gravity
  double weight_;                              ///< N
};

}  // namespace robot_control

#pragma once
/// A LegModel is a machine that stands on four legs of three turning joints each. It alone knows front and rear legs.
///
/// A leg is found by place and axis, never by name. It has three joints in a row on the root body. The first turns
/// about the lengthwise axis x, the others about the lateral axis y, within kAxleTolerance at the zero pose. Its foot
/// is the shape of the last body that reaches farthest from the third joint.
///
/// The joints rest in the lying posture. They are those of front left, front right, rear left and rear right leg, each
/// from the body outwards. The contacts are the last bodies of the legs, in the same order.

#include <array>

#include "machine/legs/leg_kinematics.h"
#include "machine/legs/leg_parameters.h"
#include "machine/machine_model.h"

namespace robot_control {

inline constexpr std::size_t kLegs = 4;
inline constexpr std::size_t kLegsJoints = kLegs * kLegJoints;
using LegsValues = std::array<double, kLegsJoints>;  ///< by the joints of a LegModel

enum class LegPlace { kFrontLeft, kFrontRight, kRearLeft, kRearRight };

/// Returns "front_left", "front_right", "rear_left" or "rear_right".
const char* name_of(LegPlace place) noexcept;

struct Leg {
  LegKinematics kinematics;
  double foot_radius = 0;  ///< m; 0: the foot is no ball, its centre is the farthest point
  double knee_radius = 0;  ///< m, how far it reaches below its third joint (lying_posture.h)
  /// These angles lie down: the body rests on the ground, and the folded leg does not bear it (lying_posture.h).
  LegAngles lying = LegAngles::Zero();
};

struct LegModel : MachineModel {
  std::array<Leg, kLegs> legs;  ///< by LegPlace; joint j of leg i is joints[3 i + j]
  double rotor_inertia = 0;     ///< kg·m², of each joint (LegParameters)
  double belly = 0;             ///< m, height of the body's lowest point in the base's axes
  double lying_pitch = 0;       ///< rad, of the body on level ground: it rests on its lowest point (lying_posture.h)

  /// Returns the angles of leg `leg` among those of all joints.
  static LegAngles angles_of(const LegsValues& all, std::size_t leg) noexcept {
    return {all[3 * leg], all[3 * leg + 1], all[3 * leg + 2]};
  }

  std::string parts() const override;

  /// Returns the length of the shortest leg in m.
  double leg_length() const noexcept;
};

inline constexpr double kReferenceMass = 12.7;  ///< kg, of the robot whose values others get in proportion
inline constexpr double kReferenceLeg = 0.426;  ///< m, likewise

/// Returns the rotor inertia of a joint, in kg·m², of a robot of this mass (kg) with legs of this length (m). Robots of
/// like shape have one in proportion to mass · length². The published 0.01 of Go1, A1 and Go2 and 0.011 of Barkour
/// (MuJoCo Menagerie) belong to 13 … 16 kg and legs of 0.4 m.
double usual_rotor_inertia(double mass, double leg_length) noexcept;

/// Returns the model that a machine is. Throws RobotError for a machine without legs.
const LegModel& leg_model_of(const MachineModel& machine);

/// Throws RobotError for a number of legs other than four, and for two legs at one corner. It throws RobotError for
/// joints without effort or speed limits, feet without a shape, other joints that move, and wheels on legs. A knee that
/// cannot bend as the parameters say is refused, too, and so is what read_machine refuses.
LegModel read_legs(const RobotDescription& description, const MachineParameters& machine, const LegParameters& legs);

}  // namespace robot_control

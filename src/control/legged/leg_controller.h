#pragma once
/// The controller of a robot on four legs: it lies, stands up, moves its body while it stands, lifts one foot, and lies
/// down. While it lies, its joints can be moved one by one.
///
///   lying ─► gathering ─► rising ─► standing ─► lowering ─► lying
///   lying ─► joints ─► gathering or lying
///
///   lying      every joint brakes
///   gathering  the joints move from where they are to the lying posture. There the slope of the ground is measured
///   rising     the feet go down to the ground where they lie, the body rises within rise_time to the nominal height,
///              with its centre of gravity amid the feet
///   standing   the body follows the request, and one foot may be in the air
///   lowering   body and foot return to the nominal pose, then the body sinks
///   joints     the joints follow Request::joints (joint_motion.h), within their ranges and nine tenths of their speed
///              limits. The legs carry their own weight alone. Without a request in force the joints stay where they
///              are
///
/// Without a permit, an angle of each joint or, while it walks, a state of this cycle, every joint brakes. The robot
/// goes on where it was if that ends within kMaxGap; else, and after a permit to brake, it lies.
///
/// A Request::mode that the present posture does not allow has no effect. The posture of the request is
///
///   while it stands           the pose of the body from the nominal one. Where no request is in force any more
///                             (kNoWish), the body stops where it is
///   while a foot is lifted    the place of this foot from where it stood: x, y, and height above the ground. The body
///                             has its nominal attitude. Without a request the foot is set down again
///
/// A twist lets the robot stand up and walk (walk/walker.h). It ends the walk with a zero. Another gait begins when
/// its legs carry the body at the twist of then. Until then the twist is limited by both gaits (walking_speed.h).
/// While it walks, the body takes height, roll and pitch of the request within half of their ranges. It takes no more
/// than the legs carry on the spot (walk/leg_use.h). The twist is limited to what they carry in the pose in force
/// and in the requested one. The body waits before a pose in which they do not carry the twist of now.
///
/// The stance frame has its origin where that of the base was when it began to rise. Its x axis shows ahead, its z axis
/// up from the ground, whose slope the attitude gave in the lying posture (ground_slope.h). The centre of gravity
/// stands amid the feet along the vertical. On a slope that is too steep the robot lies again (kReasonTooSteep). Let aᵢ
/// be the feet, p the body's position and R its rotation in it. The feet in the base's axes are Rᵀ(aᵢ − p), and the
/// joint angles are those of LegKinematics::inverse. A ball as a foot rolls: aᵢ moves with ωᵢ × (0, 0, r), ωᵢ the rate
/// of the shank.
///
/// Each joint gets an impedance about its angle. The feed-forward is the effort of the whole robot's motion along its
/// reference, M a + h − Jᵀ f (leg_dynamics.h). The feet that stand give the force and the moment that moving the body
/// and all legs needs (foot_forces.h). To lift a foot, the body first moves its centre of gravity above the other feet.
/// Then this foot's share goes to zero, and it goes up. It carries again after it was set down.
///
/// Every axis of the body and of the foot is limited in speed, acceleration and range. The axes of the body share their
/// acceleration (tracked_axis.h), and roll and pitch share their range. So a request that steps on all axes does not
/// unload a foot. The body stops before a pose for which a joint meets the end of its range (kReasonOutOfReach). It
/// also stops before a pose with an almost straight knee, or with a knee on the ground. To lie down it returns from any
/// pose.
///
/// If the permit limits the speed of the base to v, body and lifted foot follow the request at v/V of their speeds
/// (kReasonPermitSlow). V is the largest speed of the body to the front. At v = 0 both stay where they are. Standing
/// up, setting a foot down and lying down are not limited.
///
/// Gains and times follow from mass m and leg length l: stiffness ∝ m l, damping ∝ m l^1.5, times ∝ √l.

#include <array>
#include <cstdint>

#include "control/common/command_watch.h"
#include "control/common/control_input.h"
#include "control/legged/joints/joint_motion.h"
#include "control/legged/leg_controller_parameters.h"
#include "control/legged/leg_tuning.h"
#include "control/legged/tracked_axis.h"
#include "control/legged/walk/leg_use.h"
#include "control/legged/walk/twist_limiter.h"
#include "control/legged/walk/walker.h"
#include "control/legged/walk/walking_speed.h"
#include "machine/legs/leg_dynamics.h"
#include "machine/legs/leg_model.h"
#include "signals/command_frame.h"
#include "signals/legged/legged_command.h"

namespace robot_control {

inline constexpr std::uint64_t kMaxGap = 20;  ///< cycles; the monitor latches a longer loss
inline constexpr double kLoadTime = 0.2;      ///< s, in which a foot's share of the weight comes and goes

static_assert(kLegsJoints == kRequestJoints);

class LegController {
 public:
  static constexpr std::uint64_t kPose = kPartHeight | kPartRoll | kPartPitch | kPartX | kPartY | kPartYaw;
  static constexpr std::uint64_t kWalk = kPartLinearX | kPartLinearY | kPartAngularZ;
  static constexpr std::uint64_t kExecutable = kPose | kWalk | kPartMode | kPartJoints;  ///< of RequestPart

  /// `period` s.
  LegController(const LegModel& robot, const LegControllerParameters& parameters, double period);

  void enter_run(const VelocityCommand& inbox, bool with_zero) noexcept;

  /// Fills everything but `out.head`. It is real-time safe.
  void step(const ControlInput& input, CommandFrame& out) noexcept;

  LegPhase phase() const noexcept { return state_.phase; }

  /// The body in the stance frame: x, y, height above one that lies level in m, roll, pitch, yaw in rad.
  using Pose = std::array<double, 6>;

  /// The part of a twist that the legs carry, in two poses and two gaits.
  struct CarriedTwist {
    WalkingTwist twist{};
    std::array<CarriedBody, 2> bodies{};
    std::array<std::uint64_t, 2> gaits{};
    double part = 1;  ///< 0 … 1

    bool operator==(const CarriedTwist&) const = default;
  };

  struct State {
    explicit State(const CommandWatch& empty) : watch(empty) {}

    CommandWatch watch;
    LegPhase phase = LegPhase::kLying;
    std::uint64_t gap = 0;                     ///< cycles in which it could not command, up to the present one
    double elapsed = 0;                        ///< s, in this phase
    std::uint64_t sinks = 0;                   ///< 1: lowering, and the body has begun to sink
    std::array<double, kLegsJoints> from{};    ///< rad, joint angles at the beginning of gathering
    std::array<double, kLegsJoints> angles{};  ///< rad, of the last command
    std::array<Vector3, kLegs> places{};       ///< m, aᵢ
    JointMotion joints;
    std::uint64_t joints_requested = 0;  ///< cycle of the request that they follow
    std::array<TrackedAxis, 6> body{};
    Pose held{};                        ///< from the nominal pose, what the body moves to
    double pace = 1;                    ///< part of the speeds of body and foot that the permit allows
    double margin = 0;                  ///< of `spare`, which the body keeps: kMargin, or that of the nominal pose
    std::uint64_t blocked = 0;          ///< 1: the body brakes before a pose that it does not enter
    Pose blocked_target{};              ///< what was requested then
    std::uint64_t follows = 0;          ///< 1: `held` is that of a request in force
    std::uint64_t lifted = kLegs;       ///< the leg in the air, or on its way; kLegs: none
    std::array<TrackedAxis, 3> foot{};  ///< m, of the lifted foot from its place
    Vector3 foot_target{};              ///< m
    std::array<double, kLegs> share{};  ///< of foot_forces.h
    Vector3 centre{};                   ///< m, of gravity, in the base's axes
    Vector3 up{0, 0, 1};                ///< the vertical in the stance frame
    std::array<double, 2> home{};       ///< m, x and y of the standing body: its centre of gravity is amid its feet
    Walker::State walk;
    TwistLimiter::State twist;
    std::array<TrackedAxis, 3> carried{};            ///< of CarriedBody: the body that walks
    CarriedBody lean_wanted{};                       ///< what was requested last, within the ranges
    CarriedBody lean_target{};                       ///< what the legs carry of it on the spot
    CarriedTwist carried_twist;                      ///< of the last cycle
    std::uint64_t gait = 0;                          ///< the last one that was chosen
    std::uint64_t lies_next = 0;                     ///< 1: it lies down when the walk has ended
    std::uint64_t steep = 0;                         ///< 1: it lies as gathered, on a slope that is too steep
    double idle = 0;                                 ///< s without a request of motion
    std::array<double, kLeggedDofs> velocity{};      ///< of the reference, in the order of leg_dynamics.h
    std::array<double, kLeggedDofs> acceleration{};  ///< of the reference, through a low pass
  };
  const State& state() const noexcept { return state_; }
  void set_state(const State& state) noexcept { state_ = state; }

 private:
  static constexpr std::size_t kX = 0, kY = 1, kZ = 2, kRoll = 3, kPitch = 4, kYaw = 5;  ///< indices of a Pose
  static constexpr double kArrived = 0.0005;                                             ///< m and rad

  bool advance(const Request& request, const ControlInput& input, std::uint64_t& reasons) noexcept;
  bool known(const Mode& mode) const noexcept;
  bool walks(const Request& request) const noexcept;
  void begin_walk(const ControlInput& input) noexcept;
  void walk(const ControlInput& input, const Request& request, CommandFrame& out) noexcept;
  bool placed(const ControlInput& input) const noexcept;
  std::uint64_t choose_gait(const Request& request, const WalkingTwist& twist) noexcept;
  WalkingTwist capable(std::uint64_t wanted) const noexcept;
  bool carries(std::uint64_t gait, const WalkingTwist& twist) const noexcept;
  double time_scale() const noexcept;
  double pace_of(const WalkingTwist& twist) const noexcept;
  CarriedBody carried_body() const noexcept;
  double used(const WalkingTwist& twist, const CarriedBody& body, std::uint64_t wanted,
              const CarriedBody& rates = {}) const noexcept;
  double carried_part(const WalkingTwist& twist, std::uint64_t wanted) noexcept;
  void carry(const Request& request, std::uint64_t wanted, std::uint64_t& reasons) noexcept;
  void stand_here(const ControlInput& input) noexcept;
  void pause() noexcept;
  void report(CommandFrame& out) const noexcept;
  void enter(LegPhase phase, double elapsed) noexcept;
  void move_joints(const Request& request, std::uint64_t& reasons) noexcept;
  bool stands_up_here(const ControlInput& input, std::uint64_t& reasons) noexcept;
  void gather(const ControlInput& input, std::uint64_t& reasons) noexcept;
  void rise(double elapsed, std::uint64_t& reasons) noexcept;
  void stand(const Request& request, std::uint64_t& reasons) noexcept;
  void choose_pose(const Request& request, std::uint64_t& reasons) noexcept;
  void lower(std::uint64_t& reasons) noexcept;
  bool move(const Pose& target, std::uint64_t& reasons) noexcept;
  std::array<AxisBounds, 6> paced_motion() const noexcept;
  bool body_arrived(const Pose& target) const noexcept;
  void move_foot(const Request& request, bool wanted, bool supported, std::uint64_t& reasons) noexcept;
  Eigen::Vector2d above_support() const noexcept;
  Eigen::Vector2d standing_place() const noexcept;
  bool set_angles() noexcept;
  void roll_feet(const std::array<double, kLegsJoints>& rates) noexcept;
  void write(const std::array<double, kLegsJoints>& rates, CommandFrame& out) noexcept;
  LeggedMotion reference_motion(const Eigen::Matrix3d& turned,
                                const std::array<double, kLegsJoints>& rates) const noexcept;
  void accelerate(const LeggedMotion& motion) noexcept;
  double spare(const Pose& pose) const noexcept;
  double margin() const noexcept;
  Pose pose() const noexcept;
  static Eigen::Matrix3d rotation(const Pose& pose) noexcept;
  static double within(double value, double range, std::uint64_t& reasons) noexcept;
  void limit_lean(double& roll, double& pitch, std::uint64_t& reasons) const noexcept;
  Eigen::Vector3d foot_in_base(std::size_t leg, const Pose& pose, const Eigen::Matrix3d& turned) const noexcept;
  double lying(std::size_t joint) const noexcept;

  double period_;
  std::array<Leg, kLegs> legs_;
  LegDynamics dynamics_;
  LegTuning tuning_;
  std::array<JointRange, kLegsJoints> joint_ranges_;
  std::array<AxisBounds, kLegsJoints> joint_motion_;
  std::array<double, kLegsJoints> joint_steps_{};  ///< rad, of a cycle at the speed limit
  double ground_;       ///< m, height of the ground below the base of a robot that lies level
  double nominal_;      ///< m, height of the standing body above one that lies level
  double lying_pitch_;  ///< rad
  std::array<AxisBounds, 6> body_motion_;
  double lie_down_after_;  ///< s; 0: never
  TwistLimiter limiter_;
  Walker walker_;
  LegUse leg_use_;
  Speeds fastest_;            ///< by gait
  double foot_distance_ = 0;  ///< m, of the farthest foot from the centre of gravity
  State state_;
};

}  // namespace robot_control

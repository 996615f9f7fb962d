/// The body of a standing robot: its motion towards a pose, and the angles of the legs that follow from it.

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "control/legged/leg_controller.h"

namespace robot_control {
namespace {

constexpr double kArrivedSpeed = 0.02;  // m/s and rad/s
constexpr double kMinBend = 0.3;        // rad, of the knee of a standing leg: a straight one turns without bound
constexpr double kMargin = 0.03;        // of `spare`, for what the feet roll while the body brakes

using Map = Eigen::Map<const Eigen::Vector3d>;

}  // namespace

/// Returns `value` within ± `range`, and notes if it was beyond.
double LegController::within(double value, double range, std::uint64_t& reasons) noexcept {
  if (std::abs(value) > range) reasons |= kReasonOutOfReach;
  return std::clamp(value, -range, range);
}

/// Makes the lean of roll and pitch together, from the vertical, at most the range or the slope, and notes if it was
/// beyond.
void LegController::limit_lean(double& roll, double& pitch, std::uint64_t& reasons) const noexcept {
  const double slope_roll = std::asin(state_.up[1]), slope_pitch = -std::asin(state_.up[0]);
  const double lean = std::hypot(roll + slope_roll, pitch + slope_pitch);
  const double range = std::max(tuning_.lean, std::hypot(slope_roll, slope_pitch));
  if (lean <= range) return;
  reasons |= kReasonOutOfReach;
  roll = (roll + slope_roll) * range / lean - slope_roll;
  pitch = (pitch + slope_pitch) * range / lean - slope_pitch;
}

/// Moves the body towards a pose. Returns true where it has arrived.
bool LegController::move(const Pose& target, std::uint64_t& reasons) noexcept {
  const bool moves = stopping_time(state_.body, body_motion_) > 0;
  if (state_.blocked == 0 || !moves || target != state_.blocked_target) {
    std::array<TrackedAxis, 6> next = state_.body;
    track(next, target, paced_motion(), period_);
    const double left = spare(stopping_place(next, body_motion_));
    const bool leaves = left < state_.margin && left < spare(stopping_place(state_.body, body_motion_));
    state_.blocked = leaves ? 1 : 0;
    state_.blocked_target = target;
    if (!leaves) state_.body = next;
  }
  if (state_.blocked != 0) {
    brake(state_.body, body_motion_, period_);
    reasons |= kReasonOutOfReach;
  }
  if (!set_angles()) reasons |= kReasonOutOfReach;
  const bool arrived = body_arrived(target);
  if (!arrived && state_.pace < 1) reasons |= kReasonPermitSlow;
  return arrived;
}

std::array<AxisBounds, 6> LegController::paced_motion() const noexcept {
  std::array<AxisBounds, 6> motion = body_motion_;
  for (AxisBounds& axis : motion) axis = paced(axis, state_.pace);
  return motion;
}

bool LegController::body_arrived(const Pose& target) const noexcept {
  for (std::size_t i = 0; i < target.size(); ++i) {
    const TrackedAxis& axis = state_.body[i];
    if (std::abs(axis.value - target[i]) >= kArrived || std::abs(axis.speed) >= kArrivedSpeed) return false;
  }
  return true;
}

/// Returns what `spare` has to stay above while the robot stands as it does now.
double LegController::margin() const noexcept {
  return std::min(kMargin, spare(pose()));
}

LegController::Pose LegController::pose() const noexcept {
  Pose result;
  std::transform(state_.body.begin(), state_.body.end(), result.begin(),
                 [](const TrackedAxis& axis) { return axis.value; });
  return result;
}

Eigen::Matrix3d LegController::rotation(const Pose& pose) noexcept {
  using Axis = Eigen::AngleAxisd;
  return (Axis(pose[kYaw], Eigen::Vector3d::UnitZ()) * Axis(pose[kPitch], Eigen::Vector3d::UnitY()) *
          Axis(pose[kRoll], Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

Eigen::Vector3d LegController::foot_in_base(std::size_t leg, const Pose& pose,
                                            const Eigen::Matrix3d& turned) const noexcept {
  Eigen::Vector3d place = Map(state_.places[leg].data());
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    if (leg == state_.lifted) place[axis] += state_.foot[i].value;
    place[axis] -= pose[i];
  }
  return turned.transpose() * place;
}

/// Returns what the standing legs have left in this pose of the body: the least of several angles in rad. They are
/// those of joints to the ends of their ranges, of knees to kMinBend, and of shanks until their knees are on the
/// ground. It is negative if a leg does not reach its foot.
double LegController::spare(const Pose& pose) const noexcept {
  const Eigen::Matrix3d turned = rotation(pose);
  double result = std::numeric_limits<double>::infinity();
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    if (leg == state_.lifted) continue;
    const LegKinematics& kinematics = legs_[leg].kinematics;
    const LegSolution solution = kinematics.inverse(foot_in_base(leg, pose, turned));
    if (solution.reach != FootReach::kReached) return -1;
    for (std::size_t i = 0; i < kLegJoints; ++i) {
      const double angle = solution.angles[static_cast<Eigen::Index>(i)];
      const JointRange& range = kinematics.range(i);
      result = std::min({result, angle - range.lower, range.upper - angle});
    }
    const Eigen::Vector3d knee = turned * kinematics.knee(solution.angles);
    const double clear = pose[kZ] + knee.z() - ground_ - legs_[leg].knee_radius;
    result = std::min({result, std::abs(kinematics.bend(solution.angles)) - kMinBend, clear / kinematics.length()});
  }
  return result;
}

/// Moves the joint angles to those of the present pose, no faster than the joints may. The nearest angles to a foot out
/// of reach are not continuous. Returns false if a leg does not reach its foot.
bool LegController::set_angles() noexcept {
  const Pose pose = this->pose();
  const Eigen::Matrix3d turned = rotation(pose);
  bool reached = true;
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const LegSolution solution = legs_[leg].kinematics.inverse(foot_in_base(leg, pose, turned));
    reached = reached && solution.reach == FootReach::kReached;
    for (std::size_t i = 0; i < kLegJoints; ++i) {
      const std::size_t joint = kLegJoints * leg + i;
      double& angle = state_.angles[joint];
      angle = std::clamp(solution.angles[static_cast<Eigen::Index>(i)], angle - joint_steps_[joint],
                         angle + joint_steps_[joint]);
    }
  }
  return reached;
}

void LegController::roll_feet(const std::array<double, kLegsJoints>& rates) noexcept {
  const Eigen::Matrix3d turned = rotation(pose());
  const Eigen::Vector3d body(state_.body[kRoll].speed, state_.body[kPitch].speed, state_.body[kYaw].speed);
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    if (state_.share[leg] == 0) continue;
    const LegGeometry& geometry = legs_[leg].kinematics.geometry();
    const double* rate = &rates[kLegJoints * leg];
    const double first = geometry.sign[0] * state_.angles[kLegJoints * leg];
    const double pitching = geometry.sign[1] * rate[1] + geometry.sign[2] * rate[2];
    const Eigen::Vector3d shank =
        turned * Eigen::Vector3d(geometry.sign[0] * rate[0], pitching * std::cos(first), pitching * std::sin(first)) +
        body;
    state_.places[leg][0] += shank.y() * legs_[leg].foot_radius * period_;
    state_.places[leg][1] -= shank.x() * legs_[leg].foot_radius * period_;
  }
}

}  // namespace robot_control

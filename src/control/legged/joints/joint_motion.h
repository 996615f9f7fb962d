#pragma once
/// Moves the joints of a robot that lies to Request::joints, within their ranges and nine tenths of their speed limits.
/// The legs carry their own weight alone. With h = kHorizon and Δt the period,
///
///   reference   goes straight from where it is to a new target, and is there after h
///   joint       follows the reference within speed and acceleration (tracked_axis.h)
///
/// A sender that states at each time t where its path is at t + h moves the joints along this path. Without a request
/// in force, each joint stops as its acceleration allows.

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "control/legged/leg_tuning.h"
#include "control/legged/tracked_axis.h"
#include "machine/legs/leg_model.h"
#include "signals/legged/legged_command.h"
#include "signals/velocity_command.h"

namespace robot_control {

struct JointMotion {
  static constexpr double kHorizon = 0.1;  ///< s

  std::array<TrackedAxis, kLegsJoints> axes{};  ///< rad
  LegsValues reference{};                       ///< rad
  double left = 0;                              ///< s, until the reference reaches the target
  std::uint64_t follows = 0;                    ///< 1: a request was in force in the last step
  std::uint64_t requested = 0;                  ///< cycle of the last request

  /// Begins at rest at these positions in rad.
  void begin(const LegsValues& positions) noexcept {
    *this = {};
    reference = positions;
    for (std::size_t i = 0; i < kLegsJoints; ++i) axes[i].value = positions[i];
  }

  /// Advances by `dt` s with the request in force, which was received in `request_cycle`.
  void step(const Request& request, std::uint64_t request_cycle, const AllJointBounds& bounds, double dt,
            std::uint64_t& reasons) noexcept {
    if (request.mode.kind != ModeKind::kJoints) return stop(bounds, dt);
    LegsValues target = request.joints;
    for (std::size_t i = 0; i < kLegsJoints; ++i)
      target[i] = std::clamp(target[i], bounds[i].range.lower, bounds[i].range.upper);
    if (target != request.joints) reasons |= kReasonOutOfReach;
    follow(target, std::exchange(requested, request_cycle) != request_cycle, bounds, dt);
  }

  /// Advances by `dt` s towards `target` in rad; `fresh`: it was requested now.
  void follow(const LegsValues& target, bool fresh, const AllJointBounds& bounds, double dt) noexcept {
    follows = 1;
    if (fresh) left = kHorizon;
    const double part = left > dt ? dt / left : 1;
    left = std::max(0.0, left - dt);
    for (std::size_t i = 0; i < kLegsJoints; ++i) reference[i] += part * (target[i] - reference[i]);
    move(bounds, dt);
  }

  /// Advances by `dt` s without a request.
  void stop(const AllJointBounds& bounds, double dt) noexcept {
    for (std::size_t i = 0; i < kLegsJoints && follows != 0; ++i)
      reference[i] = stopping_place(std::array{axes[i]}, std::array{bounds[i].motion})[0];
    follows = 0;
    move(bounds, dt);
  }

 private:
  void move(const AllJointBounds& bounds, double dt) noexcept {
    for (std::size_t i = 0; i < kLegsJoints; ++i) {
      std::array axis{axes[i]};
      track(axis, std::array{reference[i]}, std::array{bounds[i].motion}, dt);
      axes[i] = axis[0];
    }
  }
};

}  // namespace robot_control

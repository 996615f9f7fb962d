#pragma once
/// A simulator sends this frame to telemetry and tests: the true state. No estimator, controller or monitor receives
/// it.

#include <array>
#include <cstdint>

#include "signals/frame_head.h"
#include "signals/geometry.h"
#include "signals/joint.h"
#include "signals/sensor_frame.h"

namespace robot_control {

struct TruthFrame {
  FrameHead head;
  Pose pose_world;   ///< base_link relative to its place at cycle 0, where x is its heading and z the ground's normal
  Twist twist_base;  ///< twist of base_link in its own axes
  std::array<JointSample, kMaxJoints> joints{};     ///< before any sensor error
  std::uint64_t contact_count = 0;                  ///< contacts below, in the order of MachineModel::contacts
  std::array<double, kMaxContacts> normal_force{};  ///< N, mean over [t_k-1, t_k)
  std::array<double, kMaxContacts> slip{};          ///< m/s, speed of the contact patch over ground
};

}  // namespace robot_control

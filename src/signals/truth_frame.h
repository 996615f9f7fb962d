#pragma once
/// mujoco_plant → telemetry, tests: what really happens. No estimator, controller or monitor sees it.

#include <array>

#include "signals/frame_head.h"
#include "signals/geometry.h"
#include "signals/joint.h"
#include "signals/sensor_frame.h"

namespace robot_control {

struct TruthFrame {
  FrameHead head;
  Pose pose_world;   ///< base_link from where it was at cycle 0: x its heading there, z the normal of the ground
  Twist twist_base;  ///< of base_link in its own axes
  std::array<JointSample, kMaxJoints> joints{};     ///< before any sensor error
  std::array<double, kMaxContacts> normal_force{};  ///< N, per wheel, mean over [t_k-1, t_k)
  std::array<double, kMaxContacts> slip{};          ///< m/s, per wheel: speed of the contact patch over ground
};

}  // namespace robot_control

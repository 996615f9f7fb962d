#pragma once
/// Estimates the contact of each wheel with the ground from a state frame whose other parts are complete.
///
///   slipᵢ = signᵢ rᵢ ω_i − (v_x − yᵢ ω_z)      probabilityᵢ = confidence of the encoders of the wheel's side
///
/// ω_i is the joint's velocity, v_x and ω_z the twist of base_link and yᵢ the wheel's place in base axes. Wheels of a
/// robot that turns by skidding slip in every turn.

#include <algorithm>
#include <cstddef>

#include "machine/wheeled/drive_train.h"
#include "signals/fixed_vector.h"
#include "signals/state_frame.h"

namespace robot_control {

class WheelSlip {
 public:
  explicit WheelSlip(const DriveTrain& robot) {
    for (std::size_t i = 0; i < std::min(robot.wheels.size(), kMaxWheels); ++i) {
      const WheelModel& wheel = robot.wheels[i];
      wheels_.emplace_back(Wheel{.joint = wheel.joint,
                                 .encoder = wheel.side == Side::kLeft ? kLeftEncoder : kRightEncoder,
                                 .rim_per_joint = wheel.sign * wheel.radius,
                                 .y = wheel.centre_base[1]});
    }
  }

  /// Writes the contacts of the frame.
  void write(StateFrame& out) const noexcept {
    const Twist& twist = out.base.twist_base;
    out.contact_count = wheels_.size();
    for (std::size_t i = 0; i < wheels_.size(); ++i) {
      const Wheel& wheel = wheels_[i];
      const double rolled = wheel.rim_per_joint * out.joint_velocity[wheel.joint];
      out.contacts[i] = {.probability = out.wheeled.confidence[wheel.encoder],
                         .slip = rolled - (twist.linear[0] - wheel.y * twist.angular[2])};
    }
  }

 private:
  struct Wheel {
    std::size_t joint = 0;
    SensorIndex encoder = kLeftEncoder;
    double rim_per_joint = 0;  ///< m
    double y = 0;              ///< m, base axes
  };

  FixedVector<Wheel, kMaxWheels> wheels_;
};

static_assert(kMaxWheels <= kMaxContacts);

}  // namespace robot_control

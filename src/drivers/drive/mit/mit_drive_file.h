#pragma once
/// The drive file of motors in MIT mode: what all dialects have in common.

#include <algorithm>
#include <cmath>

#include "drivers/drive/can_drive_file.h"
#include "drivers/drive/mit/mit_joint.h"

namespace robot_control {

/// s without an answer, after which a motor is silent: 20 ms from a loss on, with a cycle of 2 ms.
inline constexpr double kMitSilence = 0.018;
inline constexpr double kMaxMissing = 12;  ///< answers in a row, of a motor that is asked more often

inline constexpr double kMinTimeoutPeriods = 10;  ///< of the loop, of a timeout that a motor is given

/// Joint has the members of MitJoint, and its `timeout` in s where the motors have one.
template <class Joint>
class MitFile : public CanFileOf<Joint> {
 public:
  explicit MitFile(DriveFileRequest given) : CanFileOf<Joint>(std::move(given)) {
    this->every_.drive.max_silence = max_missing();
    if constexpr (requires { this->every_.timeout; })
      this->every_.timeout = std::max(this->every_.timeout, min_timeout());
  }

  /// All frames are orders and their answers. Three motors at 1 kHz have 6 of at most 135 bits in 1 ms: one of them may
  /// be repeated in each cycle.
  double max_load() const override { return 0.85; }

  /// A position beyond position_range of the motor has no raw number. The joint is at offset ± motor position / gear.
  DriveCapability capability(std::size_t joint) const override {
    DriveCapability capability = CanFileOf<Joint>::capability(joint);
    const Joint& its = this->joints()[joint];
    const double reach = its.ranges.position / its.drive.gear;
    capability.lower = its.drive.offset - reach;
    capability.upper = its.drive.offset + reach;
    return capability;
  }

  /// A bus that loses 5 % of the frames each way, with twelve motors at 500 Hz, reaches it once in 50 hours.
  double tolerated_silence() const override { return static_cast<double>(max_missing()) * this->request().period(); }

 protected:
  void check(const Joint& joint, JointValues& values) const override {
    const DriveParameters& drive = joint.drive;
    if (drive.torque_limit > joint.ranges.torque * drive.gear)
      values.refuse("torque_limit", "must be at most torque_range · gear, which the motor can be ordered");
    if (drive.velocity_limit * drive.gear > joint.ranges.velocity)
      values.refuse("velocity_limit", "must be at most velocity_range / gear, which the motor can report");
    if (!requires { Joint::kSendsVoltage; } && drive.min_voltage != 0)
      values.refuse("min_voltage", "must be 0: such a motor does not send its voltage with its answers",
                    "remove it; the motor reports under-voltage by itself");
    if constexpr (requires { joint.timeout; }) {
      if (joint.timeout < min_timeout() * (1 - 1.0e-9))
        values.refuse("timeout", "must be at least ten periods of the loop (robot.rate)",
                      "set a longer one: a host that is late for a few cycles would release the motor");
    }
  }

 private:
  std::uint64_t max_missing() const {
    return static_cast<std::uint64_t>(
        std::clamp(std::floor(kMitSilence * this->request().rate + 1.0e-9), 3.0, kMaxMissing));
  }
  double min_timeout() const { return kMinTimeoutPeriods * this->request().period(); }
};

}  // namespace robot_control

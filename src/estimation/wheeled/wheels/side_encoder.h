#pragma once
/// Converts the encoder angles of one side's wheels to the travel of that side since the last accepted angles.
///
///   travel = mean over the side's wheels of signᵢ · radiusᵢ · (qᵢ − qᵢ,last)    [m]
///
/// Each wheel's speed is that of the tracking loop of the wheel loops (machine/encoders/tracking_loop.h), without a
/// torque that explains its acceleration. A difference over one period would jump by a count: 1.5 rad/s with 4096
/// counts at 1 kHz. For kMaxHoldTime after a reset the speed is held.
///
/// The side's wheels are read together: one unused sample rejects the reading. The first reading is the offset, without
/// travel. A sample that is missing, not finite, impossible or old is not used; the next good one brings the travel of
/// the gap. A difference is impossible above 2 · velocity_limit times the time passed, plus kEncoderSlack; without a
/// limit, kFastestWheel replaces 2 · velocity_limit. With the tracked speed q̇ and the time t since the last reading, it
/// is also impossible where
///
///   |q − qₗₐₛₜ − q̇·t| > kNewZero + |q̇|·(t + gap) + kFastestSpinUp·t²/2
///
/// The last term is missing for a jump to zero, |q| ≤ kEncoderSlack + |q̇|·t, as an encoder makes that is switched on
/// again. From the first impossible reading on, these bounds do not widen: the angle continues at the tracked speed.
///
/// If angles stay impossible for more than kMaxHeld readings, the encoder was reset. Then the present angles become the
/// offset, and the travel in between is lost. So do the first angles after a drive had a fault and no position.

#include <array>

#include "estimation/common/tuning.h"
#include "machine/encoders/tracking_loop.h"
#include "machine/wheeled/drive_train.h"
#include "signals/fixed_vector.h"
#include "signals/sensor_frame.h"

namespace robot_control {

/// A SampleTime holds when a joint was sampled that a law used last, so that the law uses each sample once.
class SampleTime {
 public:
  /// Returns whether the sample is younger than the accepted one. A sample without age is always new.
  bool precedes(const SensorFrame& sensors, const JointSample& sample) const noexcept {
    return sample.age_ns <= 0 || !known_ || time_of(sensors, sample) > accepted_ns_;
  }

  void accept(const SensorFrame& sensors, const JointSample& sample) noexcept {
    accepted_ns_ = time_of(sensors, sample);
    known_ = true;
  }

 private:
  static std::int64_t time_of(const SensorFrame& sensors, const JointSample& sample) noexcept {
    return sensors.head.stamp_ns - sample.age_ns;
  }

  std::int64_t accepted_ns_ = 0;
  bool known_ = false;
};

enum class EncoderReading : std::uint8_t {
  kTravel,    ///< `travel` holds the travel
  kOffset,    ///< first reading
  kLost,      ///< the angles restarted: an unknown travel was lost
  kRejected,  ///< not used
};

class SideEncoder {
 public:
  /// There must be at least one wheel on that side. `bandwidth` (Hz) is that of the speeds, `period` is in s.
  SideEncoder(const DriveTrain& robot, Side side, double bandwidth, double period);

  /// `dt` is the time in s since the last call.
  EncoderReading step(const SensorFrame& sensors, double dt) noexcept;

  /// Returns the travel since the last reading that was not rejected, in m; 0 except after kTravel.
  double travel() const noexcept { return travel_; }
  /// Returns the time in which that travel was made, in s.
  double time() const noexcept { return time_; }
  double speed() const noexcept;          ///< m/s, tracked
  void set_speed(double speed) noexcept;  ///< m/s
  /// Uses the encoder's count of the other side until these wheels turn.
  void assume_encoder_of(const SideEncoder& other) noexcept;
  /// Writes rad/s of the wheels in the joint's own sign.
  void write(std::array<double, kMaxJoints>& joint_velocity) const noexcept;
  /// Returns true if a reading was accepted in the last step.
  bool received() const noexcept { return waiting_ == 0 && known_; }
  bool known() const noexcept { return known_; }        ///< A reading was accepted in this run.
  double waiting() const noexcept { return waiting_; }  ///< s since a reading was accepted
  /// Returns the usual gap between readings, in s. It is the largest gap, fading by kForgetting per reading because
  /// stamps jitter and readings come in batches. It is at most kMaxGap.
  double gap() const noexcept { return gap_; }

 private:
  /// Holds times in s.
  struct Wait {
    double time = 0;  ///< since the last accepted reading
    double open = 0;  ///< of that, until the first reading that was rejected
    double late = 0;  ///< by which a reading may be held up
  };
  struct Wheel {
    std::size_t joint;
    double metres_per_radian;
    double velocity_bound;  ///< rad/s
    double angle = 0;       ///< rad, as last accepted
    SampleTime taken{};     ///< of that angle
    bool faulty = false;    ///< The drive had a fault in the last step.
    TrackingLoop tracking;

    Wheel(const WheelModel& wheel, const DriveTrain& robot, double bandwidth, double period);
    bool measured(const SensorFrame& sensors) const noexcept;
    bool plausible(const SensorFrame& sensors, const Wait& wait) const noexcept;
    bool lost_zero(const SensorFrame& sensors) noexcept;  ///< The drive may come back with another zero.
    double accept(const SensorFrame& sensors) noexcept;   ///< m, travel
    void track(double periods) noexcept;                  ///< since the last accepted angle; 0: it does not continue
  };

  FixedVector<Wheel, kMaxWheels> wheels_;
  double period_;
  double since_lost_ = Tuning::kMaxHoldTime;  ///< s since the encoder was reset
  double travel_ = 0;
  double time_ = 0;
  double waiting_ = 0;
  double open_ = 0;  ///< s, until the first rejected reading
  double gap_ = 0;
  bool known_ = false;
  bool zero_lost_ = false;      ///< A wheel may have another zero than at its last reading.
  std::uint64_t rejected_ = 0;  ///< impossible readings in a row
};

}  // namespace robot_control

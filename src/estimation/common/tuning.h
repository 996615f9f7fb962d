#pragma once
/// These are the constants of the estimator that are neither parameters (estimator_parameters.h) nor derived. Each line
/// states unit, meaning and origin. Deviations are standard deviations.
///
/// The origin "recordings" means drives of real robots, or with their errors (bench/odometry/recordings.py,
/// field_bench.py). The origin "faults" means sensors that fail shortly (test_short_faults.py).

#include <cstdint>

namespace robot_control {

struct Tuning {
  // These constants were measured or chosen on drives.

  static constexpr double kFirstSlip = 5e-3;   ///< m/√m, slip noise of a side at the start; skid steers, recordings
  static constexpr double kFirstScrub = 0.05;  ///< rad/√rad, noise of a turn at the start; skid steers, recordings
  static constexpr double kUnwatched = 2;  ///< factor on both where no gyro watches the turn of the wheels; recordings
  static constexpr double kLevelStep = 0.2;         ///< step of the logarithm of these levels per block; recordings
  static constexpr double kCalibrationWalk = 0.04;  ///< 1/m, walk of ratio and base, of the slip noise; recordings
  static constexpr double kOffset = 0.08;  ///< s, deviation of the clock offset at the start; recordings: 0.03 … 0.17
  static constexpr double kOffsetWalk = 2e-3;  ///< s/√s, walk of the clock offset; recordings
  static constexpr double kAgreement = 0.05;   ///< share of a doubt of the heading that an agreeing block takes
  static constexpr double kSlowTime = 3.0;     ///< s, in which slow errors of the accelerometer change; recordings
  static constexpr double kBatch = 0.3;        ///< share of the usual gap, below which readings are a batch; recordings

  // These constants of slip (slip/) were measured or chosen on drives.

  static constexpr double kPathSlip = 2e-3;  ///< m/√m, slip of rolling wheels in the path difference; recordings
  static constexpr double kSlowAcceleration = 0.02;  ///< m/s², slow error: 2 mrad of tilt, a motor's hum; recordings

  // These constants are conventions of statistics.

  static constexpr double kSignificant = 3;  ///< deviations; the three-sigma rule
  static constexpr double kHuber = 1.345;    ///< deviations by which an innovation counts at most; P. J. Huber, 1964
  static constexpr double kGate = 6;         ///< deviations, beyond which an innovation is not used
  static constexpr double kSignificantTurn = 10;     ///< deviations of a turn above which a block shows the wheel base
  static constexpr double kProof = 5;                ///< deviations that prove slip: 1 of 1.7 million normal residuals
  static constexpr double kChoiceDeviation = 0.577;  ///< 1/√3: the truth lies evenly within ± a difference of speeds
  static constexpr double kNormal90 = 1.645;         ///< deviations, 90 % quantile of |normal|
  static constexpr std::uint64_t kFirstResiduals = 8;  ///< residuals whose largest is the first level: 90 % quantile
  static constexpr double kForgetting = 0.1;           ///< weight of one reading in a fading mean or maximum
  static constexpr double kQuantileStep = 0.5;         ///< step of the logarithm of a level: 1.6 up, 1/1.05 down

  // These constants are time scales.

  static constexpr double kSlipSpan = 0.4;        ///< s: T of slip_watch.h
  static constexpr double kPointInterval = 0.05;  ///< s between two points of the difference: an eighth of T
  static constexpr double kBlock = 1.0;           ///< s between comparisons of wheels and gyro; memory of confidences
  static constexpr std::uint64_t kMaxHeld = 4;    ///< cycles or readings, the life of a command (gate/gate.h)
  static constexpr double kMinHoldTime = 0.02;    ///< s for which a sample of an IMU holds at least: 50 Hz
  static constexpr double kMaxHoldTime = 0.2;     ///< s for which a sample or a bridged gap holds at most
  static constexpr double kSlowAccelerometer = 0.03;  ///< s between samples, above which motion is not resolved
  static constexpr double kSlowWheels = 0.08;         ///< s, likewise between two readings of the wheels
  static constexpr double kMaxGap = 0.5;              ///< s, upper bound of the usual gap between readings of a wheel

  static constexpr double kShowTime = 0.5;       ///< s, low pass of corrections of the pose that is shown
  static constexpr double kConstantRate = 10.0;  ///< s of one rate on standing wheels: time-out for an old bias

  // These limits are physical bounds or stated tolerances. None was tuned.

  static constexpr double kGyroRange = 100;            ///< rad/s, beyond the range of MEMS gyros
  static constexpr double kAccelerometerRange = 1000;  ///< m/s², beyond the range of MEMS accelerometers
  static constexpr double kFastestWheel = 1000;        ///< rad/s, 10⁴ rpm, if the robot names no limit
  static constexpr double kFastestSpinUp = 500;        ///< rad/s², a free wheel of 0.005 kg m² under 2.5 N m
  static constexpr double kEncoderSlack = 0.1;         ///< rad, some counts of a coarse encoder, and backlash
  static constexpr double kNewZero = 1.0;              ///< rad, of a jump; more than a wheel turns between two readings
  static constexpr double kSteepest = 0.6;     ///< sine of a tilt, 37°, at which rubber on dry ground begins to slide
  static constexpr double kInitialTilt = 0.1;  ///< rad, deviation at switch-on; the steepest road
  static constexpr double kMaxOffset = 0.4;    ///< s, twice the largest clock offset of the recordings
  static constexpr double kFirstLevel = 10;    ///< level before any residual: real floors shake 10 … 40 times
  static constexpr double kMaxNis = 1e6;       ///< nis that enters a confidence
  static constexpr double kRestart = 0.05;     ///< m and rad, deviation added by a restart or a lost travel
  static constexpr double kPlanarVariance = 1e-4;  ///< m² and rad² of z, roll and pitch on an even floor: 1 cm, 0.6°
  static constexpr double kSpeedShare = 0.02;      ///< share of an encoder's quantum that the tracking loop leaves
  static constexpr double kMinSlipSpeed = 0.02;    ///< m/s, and rad/s at rest: slower slip counts as none
  static constexpr double kSlowestComparison = 0.01;  ///< m/s below which nothing is learned of a wheel
  static constexpr double kUnknownBias = 2e-3;        ///< rad/s, 7° in a minute, above which the heading is degraded
  static constexpr double kUnknownHeading = 0.02;     ///< rad, 1°, between wheels and gyro: a degraded heading
};

}  // namespace robot_control

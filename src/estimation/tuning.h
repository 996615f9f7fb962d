#pragma once
/// Every constant of the estimator that is neither a parameter (estimator_parameters.h) nor derived from the robot or
/// from parameters: value, unit, meaning; origin. Deviations are standard deviations.
///
/// Origin "recordings": chosen on drives of real robots and on drives with their errors (lab/odometry/recordings.py,
/// field_bench.py); "faults": on drives in which a sensor fails for a short time (lab/odometry/short_faults.py).

#include <array>
#include <cstdint>

namespace robot_control {

struct Tuning {
  // Measured or chosen on drives.

  static constexpr double kFirstSlip = 5e-3;    ///< m/√m, slip noise of a side at the start; skid steers, recordings
  static constexpr double kFirstScrub = 0.05;   ///< rad/√rad, noise of a turn at the start; skid steers, recordings
  static constexpr double kFirstTwist = 0.016;  ///< likewise, of one wheel on either side; recordings, vacuum robot
  static constexpr double kLevelStep = 0.2;     ///< of the logarithm of these levels per block; recordings
  static constexpr double kCalibrationWalk = 0.04;  ///< 1/m, walk of ratio and base, of the slip noise; recordings
  static constexpr double kOffset = 0.08;  ///< s, deviation of the clock offset at the start; recordings: 0.03 … 0.17
  static constexpr double kOffsetWalk = 2e-3;           ///< s/√s, walk of the clock offset; recordings
  static constexpr double kAccelerometerAtRest = 0.03;  ///< m/s², rocking and a motor's hum in a mean; recordings
  static constexpr double kSlowTime = 3.0;   ///< s, in which slow errors of the accelerometer change; recordings
  static constexpr double kMountedGyro = 2;  ///< noise of a mounted gyro over its data sheet's; recordings: 1.5 … 1.9
  static constexpr double kTipping = 0.5;    ///< rad/s about x and y, beyond which a gyro is taken to fail; faults
  static constexpr double kConstantRate = 10.0;  ///< s of one rate on standing wheels: it is the gyro's bias; faults
  static constexpr double kBatch = 0.3;      ///< of the usual gap between readings, below which they came in a batch;
                                             ///< recordings
  static constexpr double kGapFading = 0.9;  ///< of the largest gap per reading; recordings, of stamps with jitter

  // Slip (slip/), measured or chosen on drives.

  static constexpr double kPathSlip = 2e-3;  ///< m/√m, slip of wheels that roll, in the path difference; recordings
  static constexpr double kWindUp = 1.6e-3;  ///< rad/√(rad/s), of treads and gears in a turn that changes; recordings
  static constexpr double kSlowAcceleration = 0.02;  ///< m/s², slow error, as of 2 mrad of tilt; recordings
  static constexpr double kFirstLevel = 10;          ///< of residuals, before one is learned: it shakes; recordings

  // Conventions of statistics.

  static constexpr double kSignificant = 3;  ///< deviations; the three-sigma rule
  static constexpr double kHuber = 2;        ///< deviations, by which an innovation pulls at most; P. J. Huber, 1964
  static constexpr double kGate = 6;         ///< deviations, beyond which an innovation is not used
  static constexpr double kSignificantTurn = 10;  ///< deviations, from which on a block's turn shows the wheel base:
                                                  ///< below, the noise that rate and innovation share would drive it
  static constexpr double kLevelMemory = 0.05;    ///< 1/blocks, of the correlation of innovations: 20 blocks
  static constexpr double kStampMemory = 50;      ///< readings, of the stamps' jitter: its deviation is known to 10 %
  static constexpr double kNoisePrior = 4;        ///< windows that kMountedGyro is worth: 1 s
  static constexpr double kProof = 5;             ///< deviations that prove slip: 1 of 1.7 million normal residuals
  static constexpr double kChoiceDeviation =
      0.577;  ///< of a choice between two speeds: the true one lies evenly within their difference
  static constexpr double kNormal90 = 1.645;           ///< deviations, 90 % quantile of |normal|
  static constexpr std::uint64_t kFirstResiduals = 8;  ///< whose largest is the first level: their 90 % quantile
  static constexpr double kQuantileStep = 0.5;         ///< of the logarithm of a level: 1.6 up, 1/1.05 down
  static constexpr double kUsualSpeedShare = 0.1;      ///< of the speed of one residual in the usual one

  // Time scales.

  static constexpr std::array<double, 4> kResidualSpans{0.1, 0.2, 0.4, 0.8};  ///< s: T of slip_residual.h
  static constexpr double kPointInterval = 0.05;  ///< s between two points of the differences: half the shortest T
  static constexpr double kBlock = 1.0;           ///< s, between two comparisons of wheels and gyro; of the confidences
  static constexpr std::uint64_t kMaxHeld = 4;    ///< cycles or readings: as long as a command lives (hal/gate.h)
  static constexpr double kShortestHold = 0.02;   ///< s, for which a sample of an IMU holds at least: 50 Hz
  static constexpr double kLongestHold = 0.2;     ///< s, at most; of one repeated sample of a gyro; of a gap that is
                                                  ///< bridged, of a gyro or of a wheel
  static constexpr double kSlowAccelerometer = 0.03;  ///< s between samples, beyond which motion is not resolved
  static constexpr double kLongestGap = 0.5;          ///< s, usual gap between readings of a wheel at most

  // Limits of what is possible or stated. None was tuned.

  static constexpr double kGyroRange = 100;            ///< rad/s, beyond the range of MEMS gyros
  static constexpr double kAccelerometerRange = 1000;  ///< m/s², likewise
  static constexpr double kFastestWheel = 1000;        ///< rad/s, 10⁴ rpm; where the robot names no limit
  static constexpr double kEncoderSlack = 0.1;         ///< rad, some counts of a coarse encoder, and backlash
  static constexpr double kSteepest = 0.6;             ///< sine of a tilt, 37°: rubber on dry ground begins to slide
  static constexpr double kInitialTilt = 0.1;          ///< rad, deviation at switch-on: the steepest road
  static constexpr double kFloor = 0.01;               ///< rad, of the tilt of two places; twice what DIN 18202 allows
  static constexpr double kLargestOffset = 0.4;        ///< s, twice the largest clock offset of the recordings
  static constexpr double kLeastTwist = 5e-4;          ///< rad/√rad, a hard tyre on a hard floor
  static constexpr double kLargestSlip = 0.05;         ///< m/√m, ten times that of skid steers
  static constexpr double kLargestTwist = 1.0;         ///< rad/√rad, nothing is known of a turn
  static constexpr double kLargestCorrelation = 0.9;   ///< of two innovations in a row
  static constexpr double kLargestNis = 1e6;           ///< that enters a confidence
  static constexpr double kRestart = 0.05;             ///< m and rad, deviation added by a restart or a lost travel
  static constexpr double kPlanarVariance = 1e-4;  ///< m², rad²: 1 cm, 0.6°, of z, roll and pitch on an even floor
  static constexpr double kSpeedShare = 0.02;      ///< of an encoder's quantum, what the tracking loop leaves of it
  static constexpr double kLeastSlip = 0.02;       ///< m/s, and rad/s at rest: slower slip counts as none
  static constexpr double kSlowestComparison = 0.01;  ///< m/s: of slower wheels nothing is learned
  static constexpr double kUnknownBias = 2e-3;        ///< rad/s, 7° in a minute: a heading that is called degraded
  static constexpr double kUnknownHeading = 0.02;     ///< rad, 1°, that wheels and gyro are apart: likewise
};

}  // namespace robot_control

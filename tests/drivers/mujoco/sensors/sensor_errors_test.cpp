/// Sensor errors are compared with their theory. A sample variance of n normal numbers has the relative deviation
/// √(2/n), a mean σ/√n, a correlation 1/√n. Every bound is five of them, which one test in a million misses, and the
/// seeds are fixed.

#include "drivers/mujoco/sensors/sensor_errors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "drivers/driver.h"
#include "drivers/mujoco/two_wheels.h"
#include "support/message_of.h"

namespace robot_control::tests {

constexpr double kDeviations = 5;
constexpr double kCount = 2 * std::numbers::pi / 4096;  // rad

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// Mean of (x − x̄)(y − ȳ).
double covariance(const std::vector<double>& x, const std::vector<double>& y) {
  const double mean_x = mean(x), mean_y = mean(y);
  double sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i) sum += (x[i] - mean_x) * (y[i] - mean_y);
  return sum / static_cast<double>(x.size());
}

double variance(const std::vector<double>& x) {
  return covariance(x, x);
}

double correlation(const std::vector<double>& x, const std::vector<double>& y) {
  return covariance(x, y) / std::sqrt(variance(x) * variance(y));
}

double variance_bound(std::size_t count) {
  return kDeviations * std::sqrt(2.0 / static_cast<double>(count));
}

double correlation_bound(std::size_t count) {
  return kDeviations / std::sqrt(static_cast<double>(count));
}

struct SensorErrorsTest : testing::Test {
  SensorErrorsTest() {
    parameters_.seed = 7;
    parameters_.sensor_errors = ErrorLevel::kDataSheet;
  }

  SensorErrors errors() const { return {robot_, {}, parameters_, period_}; }

  /// The measurements of a robot at rest, one vector per axis.
  using Axes = std::array<std::vector<double>, 3>;
  struct Record {
    Axes gyro, accelerometer;
  };
  static Record record(SensorErrors& errors, std::size_t count) {
    Record result;
    for (std::size_t i = 0; i < count; ++i) {
      Measurement measurement;
      errors.step(measurement);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        result.gyro[axis].push_back(measurement.imu.angular_velocity[axis]);
        result.accelerometer[axis].push_back(measurement.imu.linear_acceleration[axis]);
      }
    }
    return result;
  }
  Record record(std::size_t count) const {
    SensorErrors fresh = errors();
    return record(fresh, count);
  }

  /// Switches bias and walk off, so that white noise alone is left.
  void white_only() {
    parameters_.gyro_bias = parameters_.gyro_bias_walk = 0;
    parameters_.accelerometer_bias = parameters_.accelerometer_bias_walk = 0;
  }

  DriveTrain robot_ = two_wheels();
  MujocoPlantParameters parameters_;
  double period_ = 0.001;
};

TEST_F(SensorErrorsTest, HaveTheFiguresOfTheDataSheet) {
  constexpr double kGravity = 9.80665, kDegree = std::numbers::pi / 180;
  constexpr double kThreeDigits = 0.005, kTwoDigits = 0.05;
  const auto near = [](double value, double expected, double rounding) { EXPECT_NEAR(value / expected, 1, rounding); };
  near(parameters_.gyro_noise, 0.014 * kDegree, kThreeDigits);
  near(parameters_.gyro_bias, 1 * kDegree, kThreeDigits);
  near(parameters_.gyro_bias_walk, 0.015 * kDegree * 2 / std::sqrt(3600), kTwoDigits);
  near(parameters_.accelerometer_noise, 175e-6 * kGravity, kThreeDigits);
  near(parameters_.accelerometer_bias, 20e-3 * kGravity, kThreeDigits);
  near(parameters_.accelerometer_bias_walk, 0.2e-3 * kGravity * 2 / std::sqrt(3600), kTwoDigits);
}

TEST_F(SensorErrorsTest, HaveTheDensityAskedForAtEveryRate) {
  constexpr std::size_t kSamples = 100000;
  white_only();
  for (const double period : {0.01, 0.001, 0.0005}) {
    period_ = period;
    const Record noise = record(kSamples);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double gyro = parameters_.gyro_noise * parameters_.gyro_noise / period;
      const double accelerometer = parameters_.accelerometer_noise * parameters_.accelerometer_noise / period;
      EXPECT_NEAR(variance(noise.gyro[axis]) / gyro, 1, variance_bound(kSamples)) << period << ' ' << axis;
      EXPECT_NEAR(variance(noise.accelerometer[axis]) / accelerometer, 1, variance_bound(kSamples)) << period;
      EXPECT_LT(std::abs(mean(noise.gyro[axis])), correlation_bound(kSamples) * std::sqrt(gyro));
    }
  }
}

TEST_F(SensorErrorsTest, AreNormal) {
  constexpr std::size_t kSamples = 100000;
  white_only();
  const Record noise = record(kSamples);
  const double deviation = std::sqrt(variance(noise.gyro[0]));
  double third = 0, fourth = 0, within = 0;
  for (const double value : noise.gyro[0]) {
    const double z = value / deviation;
    third += z * z * z / kSamples;
    fourth += z * z * z * z / kSamples;
    within += std::abs(z) < 1 ? 1.0 / kSamples : 0;
  }
  // The deviations of skewness and kurtosis of n normal numbers are √(6/n) and √(24/n), that of a share p is √(p(1 −
  // p)/n).
  EXPECT_NEAR(third, 0, kDeviations * std::sqrt(6.0 / kSamples));
  EXPECT_NEAR(fourth, 3, kDeviations * std::sqrt(24.0 / kSamples));
  EXPECT_NEAR(within, 0.6827, kDeviations * std::sqrt(0.6827 * 0.3173 / kSamples));
}

TEST_F(SensorErrorsTest, AreWhite) {
  constexpr std::size_t kSamples = 100000;
  white_only();
  const Record noise = record(kSamples);
  for (const std::size_t lag : {1u, 2u, 10u}) {
    const std::vector<double>& all = noise.gyro[2];
    const auto shift = static_cast<std::ptrdiff_t>(lag);
    EXPECT_LT(std::abs(correlation({all.begin(), all.end() - shift}, {all.begin() + shift, all.end()})),
              correlation_bound(kSamples - lag))
        << lag;
  }
}

TEST_F(SensorErrorsTest, AreIndependentFromAxisToAxisAndFromDeviceToDevice) {
  constexpr std::size_t kSamples = 100000;
  white_only();
  const Record noise = record(kSamples);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_LT(std::abs(correlation(noise.gyro[axis], noise.gyro[(axis + 1) % 3])), correlation_bound(kSamples));
    EXPECT_LT(std::abs(correlation(noise.gyro[axis], noise.accelerometer[axis])), correlation_bound(kSamples));
  }
}

TEST_F(SensorErrorsTest, DrawABiasForEverySeedAndAxis) {
  constexpr std::size_t kSeeds = 2000;
  Axes gyro, accelerometer;
  for (parameters_.seed = 0; parameters_.seed < kSeeds; ++parameters_.seed) {
    const SensorErrors drawn = errors();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      gyro[axis].push_back(drawn.gyro().bias()[axis]);
      accelerometer[axis].push_back(drawn.accelerometer().bias()[axis]);
    }
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(variance(gyro[axis]) / std::pow(parameters_.gyro_bias, 2), 1, variance_bound(kSeeds));
    EXPECT_NEAR(variance(accelerometer[axis]) / std::pow(parameters_.accelerometer_bias, 2), 1, variance_bound(kSeeds));
    EXPECT_LT(std::abs(mean(gyro[axis])), correlation_bound(kSeeds) * parameters_.gyro_bias);
    EXPECT_LT(std::abs(correlation(gyro[axis], gyro[(axis + 1) % 3])), correlation_bound(kSeeds));
    EXPECT_LT(std::abs(correlation(gyro[axis], accelerometer[axis])), correlation_bound(kSeeds));
  }
}

TEST_F(SensorErrorsTest, KeepTheBiasWhereNothingWalks) {
  parameters_.gyro_noise = parameters_.gyro_bias_walk = 0;
  SensorErrors drawn = errors();
  const Vector3 bias = drawn.gyro().bias();
  const Record rest = record(drawn, 1000);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const double value : rest.gyro[axis]) EXPECT_EQ(value, bias[axis]);
  }
}

TEST_F(SensorErrorsTest, WalkWithTheVarianceThatGrowsWithTime) {
  constexpr std::size_t kSeeds = 1000;
  constexpr std::size_t kSteps = 400;
  parameters_.gyro_noise = parameters_.gyro_bias = 0;
  std::vector<double> half, whole;
  for (parameters_.seed = 0; parameters_.seed < kSeeds; ++parameters_.seed) {
    const Record walk = record(kSteps + 1);
    for (const std::vector<double>& axis : walk.gyro) {
      EXPECT_EQ(axis[0], 0) << "it begins at the bias that was drawn";
      half.push_back(axis[kSteps / 2]);
      whole.push_back(axis[kSteps]);
    }
  }
  const double expected = std::pow(parameters_.gyro_bias_walk, 2) * kSteps * period_;
  EXPECT_NEAR(variance(whole) / expected, 1, variance_bound(3 * kSeeds));
  EXPECT_NEAR(variance(half) / (expected / 2), 1, variance_bound(3 * kSeeds));
}

TEST_F(SensorErrorsTest, AddToTheTruth) {
  parameters_.gyro_noise = parameters_.gyro_bias_walk = 0;
  SensorErrors drawn = errors();
  Measurement measurement;
  measurement.imu.angular_velocity = {1, 2, 3};
  drawn.step(measurement);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(measurement.imu.angular_velocity[axis], static_cast<double>(axis + 1) + drawn.gyro().bias()[axis]);
  }
}

TEST_F(SensorErrorsTest, ScaleTheTrueRateAndNothingElse) {
  parameters_.gyro_noise = parameters_.gyro_bias_walk = 0;
  parameters_.accelerometer_noise = parameters_.accelerometer_bias = parameters_.accelerometer_bias_walk = 0;
  parameters_.gyro_scale_error = -0.004;
  SensorErrors drawn = errors();
  Measurement measurement;
  measurement.imu.angular_velocity = {1, -2, 3};
  measurement.imu.linear_acceleration = {1, -2, 3};
  drawn.step(measurement);
  const Vector3 bias = drawn.gyro().bias();
  constexpr double kRounding = 1e-15;  // of numbers around 3
  EXPECT_NEAR(measurement.imu.angular_velocity[0], 0.996 + bias[0], kRounding);
  EXPECT_NEAR(measurement.imu.angular_velocity[1], -1.992 + bias[1], kRounding);
  EXPECT_NEAR(measurement.imu.angular_velocity[2], 2.988 + bias[2], kRounding);
  EXPECT_EQ(measurement.imu.linear_acceleration, (Vector3{1, -2, 3}));
}

TEST_F(SensorErrorsTest, DoNotDependOnTheOtherDevice) {
  const Record both = record(1000);
  parameters_.gyro_noise = parameters_.gyro_bias = parameters_.gyro_bias_walk = 0;
  parameters_.encoder_resolution = 0;
  EXPECT_EQ(record(1000).accelerometer, both.accelerometer);
}

TEST_F(SensorErrorsTest, DoNotDependOnErrorsOfOtherKinds) {
  white_only();
  const Record white = record(1000);
  parameters_.gyro_bias = MujocoPlantParameters{}.gyro_bias;
  SensorErrors biased = errors();
  const Vector3 bias = biased.gyro().bias();
  const Record with_bias = record(biased, 1000);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < 1000; ++i) {
      EXPECT_NEAR(with_bias.gyro[axis][i] - bias[axis], white.gyro[axis][i], 1e-16) << "but for rounding";
    }
  }
}

TEST_F(SensorErrorsTest, CountTheAngle) {
  SensorErrors encoder = errors();
  double last = 0;
  for (int i = 0; i < 2000; ++i) {
    const double angle = 0.37 * kCount * i - 0.1;  // several samples per count
    Measurement measurement;
    measurement.joints[kLeftWheel] = {.position = angle, .velocity = 0.37 * kCount / period_, .effort = 1.25};
    encoder.step(measurement);
    const JointSample& seen = measurement.joints[kLeftWheel];
    EXPECT_LE(std::abs(seen.position - angle), kCount / 2 * (1 + 1e-9));
    EXPECT_NEAR(seen.position / kCount, std::round(seen.position / kCount), 1e-9);
    // Two angles of about 1 rad are subtracted: 2⁻⁵² each, over a period.
    EXPECT_NEAR(seen.velocity, i == 0 ? 0 : (seen.position - last) / period_, 1e-12 / period_);
    EXPECT_EQ(seen.effort, 1.25) << "a drive knows its current";
    last = seen.position;
  }
}

TEST_F(SensorErrorsTest, CountTheSpeedInStepsOfACountPerPeriod) {
  SensorErrors encoder = errors();
  double travelled = 0;
  for (int i = 0; i < 1000; ++i) {
    Measurement measurement;
    measurement.joints[kRightWheel].position = 0.25 * kCount * i;
    encoder.step(measurement);
    const double speed = measurement.joints[kRightWheel].velocity;
    EXPECT_TRUE(speed == 0 || std::abs(speed - kCount / period_) < 1e-9) << speed;
    travelled += speed * period_;
  }
  EXPECT_NEAR(travelled, 0.25 * kCount * 999, kCount) << "nothing gets lost between the counts";
}

TEST_F(SensorErrorsTest, ShiftTheZeroOfEachJointOfARobotWithoutWheels) {
  parameters_.joint_offset = 0.01;
  std::vector<double> left, right;
  for (parameters_.seed = 0; parameters_.seed < 1000; ++parameters_.seed) {
    SensorErrors encoder = errors();
    for (const double angle : {0.0, 1.0}) {
      Measurement measurement;
      measurement.joints[kLeftWheel].position = measurement.joints[kRightWheel].position = angle;
      encoder.step(measurement);
      left.push_back(measurement.joints[kLeftWheel].position - angle);
      right.push_back(measurement.joints[kRightWheel].position - angle);
    }
    EXPECT_NEAR(left.end()[-1], left.end()[-2], kCount) << "it stays";
  }
  EXPECT_NEAR(variance(left) / (0.01 * 0.01), 1, variance_bound(1000));
  EXPECT_LE(std::abs(correlation(left, right)), correlation_bound(1000));
}

TEST_F(SensorErrorsTest, CountTheTurnsOfAJointThatIsHeld) {
  const auto seen = [&] {
    SensorErrors encoder = errors();
    Measurement measurement;
    measurement.joints[kSwivel].position = 0.1234567;
    encoder.step(measurement);
    return measurement.joints[kSwivel].position;
  };
  robot_.joints[kSwivel].role = JointRole::kHeld;
  constexpr double kBehindGear = kCount / 100;
  EXPECT_NEAR(seen(), std::round(0.1234567 / kBehindGear) * kBehindGear, 1e-15);
  robot_.joints[kSwivel].prismatic = true;
  EXPECT_EQ(seen(), 0.1234567) << "its path has no counts per turn";
}

TEST_F(SensorErrorsTest, LeaveJointsWithoutAnActuatorAlone) {
  SensorErrors encoder = errors();
  Measurement measurement;
  measurement.joints[kSwivel] = {.position = 0.1234567, .velocity = 0.7654321};
  encoder.step(measurement);
  EXPECT_EQ(measurement.joints[kSwivel].position, 0.1234567);
  EXPECT_EQ(measurement.joints[kSwivel].velocity, 0.7654321);
}

TEST_F(SensorErrorsTest, AreNoneOfNoResolution) {
  parameters_.encoder_resolution = 0;
  SensorErrors encoder = errors();
  Measurement measurement;
  measurement.joints[kLeftWheel] = {.position = 0.1234567, .velocity = 0.7654321};
  encoder.step(measurement);
  EXPECT_EQ(measurement.joints[kLeftWheel].position, 0.1234567);
  EXPECT_EQ(measurement.joints[kLeftWheel].velocity, 0.7654321);
}

TEST_F(SensorErrorsTest, MakeAllSamplesLateTogether) {
  parameters_.sensor_delay = 3;
  parameters_.encoder_resolution = 0;
  white_only();
  parameters_.gyro_noise = parameters_.accelerometer_noise = 0;
  SensorErrors late = errors();
  for (int k = 0; k < 20; ++k) {
    Measurement measurement;
    measurement.joints[kLeftWheel].position = k;
    measurement.imu.angular_velocity[2] = k;
    late.step(measurement);
    EXPECT_EQ(measurement.joints[kLeftWheel].position, std::max(0, k - 3));
    EXPECT_EQ(measurement.imu.angular_velocity[2], std::max(0, k - 3));
  }
}

TEST_F(SensorErrorsTest, RefuseADelayThatIsTooLong) {
  parameters_.sensor_delay = kMaxDelay + 1;
  const std::string message = message_of<DriverError>([&] { errors(); });
  EXPECT_NE(message.find("sensor_delay = 101"), std::string::npos) << message;
  EXPECT_NE(message.find("100"), std::string::npos) << message;
}

TEST_F(SensorErrorsTest, AreNoneWhenSwitchedOff) {
  parameters_.sensor_errors = ErrorLevel::kIdeal;
  parameters_.sensor_delay = 5;
  SensorErrors none = errors();
  for (int k = 0; k < 20; ++k) {
    Measurement measurement;
    measurement.joints[kLeftWheel] = {.position = 0.1 * k, .velocity = 0.01 * k};
    measurement.imu.linear_acceleration[2] = 9.81;
    none.step(measurement);
    EXPECT_EQ(measurement.joints[kLeftWheel].position, 0.1 * k);
    EXPECT_EQ(measurement.joints[kLeftWheel].velocity, 0.01 * k);
    EXPECT_EQ(measurement.imu.linear_acceleration[2], 9.81);
    EXPECT_EQ(measurement.imu.angular_velocity[0], 0);
  }
}

}  // namespace robot_control::tests

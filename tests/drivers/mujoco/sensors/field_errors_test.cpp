/// Checks the additional errors of the field, beyond the data sheet, against their theory. A sample variance of n
/// independent normal numbers has the relative deviation √(2/n). Every bound is five of them, and the seeds are fixed.

#include <cmath>

#include "drivers/mujoco/constants.h"
#include "drivers/mujoco/contact/wheel_contacts.h"
#include "drivers/mujoco/mujoco_plant.h"
#include "drivers/mujoco/plant_fixture.h"
#include "drivers/mujoco/sensors/sensor_errors.h"
#include "drivers/mujoco/two_wheels.h"
#include "support/robots/made_robot.h"

namespace robot_control::tests {

double bound(std::size_t count) {
  return 5 * std::sqrt(2.0 / static_cast<double>(count));
}

double mean_square(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return sum / static_cast<double>(values.size());
}

struct VibrationTest : testing::Test {
  VibrationTest() { errors_.accelerometer_slow_error = 0; }

  Vibration made() const {
    Vibration vibration({{kLeftWheel, 0.1}, {kRightWheel, 0.1}}, errors_, kStep);
    vibration.reset(3);
    return vibration;
  }
  /// The vibration that is added at `speed` m/s, one cycle after the other.
  ImuSample step(Vibration& vibration, double speed) const {
    Measurement measurement;
    measurement.joints[kLeftWheel].velocity = measurement.joints[kRightWheel].velocity = speed / 0.1;
    vibration.step(measurement);
    return measurement.imu;
  }
  /// Integrals over `seconds` each: gyro z [rad], accelerometer x [m/s].
  std::array<std::vector<double>, 2> integrals(double speed, double seconds, std::size_t count) const {
    Vibration vibration = made();
    std::array<std::vector<double>, 2> result;
    for (std::size_t i = 0; i < count; ++i) {
      double turned = 0, faster = 0;
      for (int k = 0; k < std::lround(seconds / kStep); ++k) {
        const ImuSample added = step(vibration, speed);
        turned += added.angular_velocity[2] * kStep;
        faster += added.linear_acceleration[0] * kStep;
      }
      result[0].push_back(turned);
      result[1].push_back(faster);
    }
    return result;
  }

  MujocoPlantParameters errors_;
};

// The low pass takes 2/(2π·50 Hz·1 s) = 0.6 % of the variance at the two ends of the second.
TEST_F(VibrationTest, IntegratesAsWhiteNoiseInProportionToSpeedAndRoughness) {
  constexpr std::size_t kValues = 1000;
  constexpr double kEnds = 0.01;
  for (const double speed : {0.5, -1.0}) {
    for (const double roughness : {1.0, 3.0}) {
      errors_.roughness = roughness;
      const auto [gyro, accelerometer] = integrals(speed, 1, kValues);
      const double scale = std::pow(speed * roughness, 2);
      EXPECT_NEAR(mean_square(gyro) / (scale * std::pow(errors_.gyro_vibration, 2)), 1, bound(kValues) + kEnds);
      EXPECT_NEAR(mean_square(accelerometer) / (scale * std::pow(errors_.accelerometer_vibration, 2)), 1,
                  bound(kValues) + kEnds);
    }
  }
}

TEST_F(VibrationTest, IsNoneAtRest) {
  Vibration vibration = made();
  for (int k = 0; k < 100; ++k) {
    const ImuSample added = step(vibration, 0);
    EXPECT_EQ(added.angular_velocity, Vector3{});
    EXPECT_EQ(added.linear_acceleration, Vector3{});
  }
}

TEST_F(VibrationTest, ItsSlowErrorChangesAlongTheWayAlone) {
  errors_.accelerometer_slow_error = 0.08;
  errors_.accelerometer_vibration = 0;
  Vibration vibration = made();
  const Vector3 before = step(vibration, 0).linear_acceleration;
  for (int k = 0; k < 100; ++k) EXPECT_EQ(step(vibration, 0).linear_acceleration, before);

  // One value every five lengths: their correlation is e⁻⁵.
  constexpr std::size_t kValues = 2000;
  std::vector<double> apart, close;
  for (std::size_t i = 0; i < kValues; ++i) {
    const double first = step(vibration, 5 * Vibration::kLength / kStep).linear_acceleration[0];
    const double second = step(vibration, Vibration::kLength / kStep).linear_acceleration[0];
    apart.push_back(first);
    close.push_back(second - first);
  }
  EXPECT_NEAR(mean_square(apart) / (0.08 * 0.08), 1, bound(kValues));
  EXPECT_NEAR(mean_square(close) / (2 * 0.08 * 0.08 * (1 - std::exp(-1))), 1, bound(kValues));
}

std::vector<int> reported(double delay, double jitter, int cycles) {
  LateSamples<int> device(delay, jitter, kStep, kImuLateStream);
  device.reset(1);
  std::vector<int> result;
  for (int k = 0; k < cycles; ++k) {
    int sample = k;
    device.step(sample);
    result.push_back(sample);
  }
  return result;
}

TEST(LateSamplesTest, ReportTheSampleOfADelayAgoAndTheFirstUntilThen) {
  const std::vector<int> samples = reported(0.05, 0, 200);
  for (int k = 0; k < 200; ++k) EXPECT_EQ(samples[static_cast<std::size_t>(k)], std::max(0, k - 50));
}

// Nothing overtakes: a sample waits for the late ones before it, so the mean age is above that of a single sample,
// 2 ms · √(2/π) = 1.6 ms, and below the most that one can be late.
TEST(LateSamplesTest, KeepTheirOrderAndAreNeverEarlyNorLost) {
  const std::vector<int> samples = reported(0.01, 0.002, 100000);
  double age = 0;
  std::size_t held = 0;
  for (std::size_t k = 100; k < samples.size(); ++k) {
    ASSERT_GE(samples[k], samples[k - 1]);
    ASSERT_LE(samples[k], static_cast<int>(k) - 10);
    ASSERT_GE(samples[k], static_cast<int>(k) - 10 - 12);
    held += samples[k] == samples[k - 1] ? 1 : 0;
    age += static_cast<double>(k) - samples[k];
  }
  age /= static_cast<double>(samples.size() - 100);
  EXPECT_GT(age, 11.6);
  EXPECT_LT(age, 17);
  EXPECT_GT(held, samples.size() / 10) << "some cycles bring no new sample";
}

struct SlipNoiseTest : testing::Test {
  SlipNoiseTest() {
    made_.axles = {0.2, -0.2};
    parameters_.sensor_errors = ErrorLevel::kField;
  }

  static constexpr std::size_t kLeft = 0, kRight = 1;

  MadeRobot made_;
  MujocoPlantParameters parameters_;
};

// Over 1 m, ten lengths, the exact variance of the integral is σ²·(1 − (1 − e⁻¹⁰)/10).
TEST_F(SlipNoiseTest, AddsUpAsARandomWalkAlongTheWay) {
  constexpr std::size_t kValues = 2000;
  constexpr double kWay = 0.001;  // m
  SlipNoise noise(made_.model().wheels.size(), parameters_);
  std::vector<double> sums;
  for (std::size_t i = 0; i < kValues; ++i) {
    double sum = 0;
    for (int k = 0; k < 1000; ++k) {
      noise.step(kLeft, kWay);
      sum += noise.error(kLeft) * kWay;
    }
    sums.push_back(sum);
    EXPECT_EQ(noise.error(kRight), 0) << "the sides are independent";
    noise.step(kLeft, 100);  // forgets
  }
  const double expected = std::pow(parameters_.wheel_slip_noise, 2) * (1 - (1 - std::exp(-10)) / 10);
  EXPECT_NEAR(mean_square(sums) / expected, 1, bound(kValues));
}

TEST_F(SlipNoiseTest, IsOfTheFieldAndOfWheelsBehindEachOtherAlone) {
  const auto error = [&] {
    SlipNoise noise(made_.model().wheels.size(), parameters_);
    noise.step(kLeft, 1);
    return noise.error(kLeft);
  };
  EXPECT_NE(error(), 0);
  parameters_.sensor_errors = ErrorLevel::kDataSheet;
  EXPECT_EQ(error(), 0);
  parameters_.sensor_errors = ErrorLevel::kField;
  made_.axles = {0};
  made_.ball_x = -0.2;
  EXPECT_EQ(error(), 0);
}

/// The robot of SlipNoiseTest, straight ahead on the plant.
struct FieldPlant : SlipNoiseTest {
  struct Driven {
    double rims = 0;    ///< m, mean of both sides
    double ground = 0;  ///< m, ahead
    double yaw = 0;     ///< rad
    std::vector<double> accelerometer, rates, positions;
  };
  Driven drive() {
    parameters_.scene = kFlat;
    MujocoPlant plant(made_.model(), parameters_, kStep);
    plant.start();
    Driven driven;
    std::vector<JointCommand> commands(plant.model().robot.joints.size());
    for (int k = 0; k < 4000; ++k) {
      commands.assign(commands.size(), velocity_command(std::min(1.0, k / 1000.0) * 10));
      plant.write(commands);
      SensorFrame sensors;
      plant.read(sensors);
      driven.accelerometer.push_back(sensors.imu.linear_acceleration[0]);
      driven.rates.push_back(sensors.imu.angular_velocity[2]);
      driven.positions.push_back(sensors.joints[0].position);
    }
    TruthFrame truth;
    plant.truth(truth);
    for (std::size_t wheel = 0; wheel < 4; ++wheel) driven.rims += truth.joints[wheel].position * made_.radius / 4;
    driven.ground = truth.pose_world.position[0];
    driven.yaw = 2 * std::asin(truth.pose_world.orientation[2]);
    return driven;
  }
};

// Over 3.5 m the way of the mean of two sides differs by σ·√(3.5/2) = 6.6 mm; the yaw by σ·√7/B, B about the scrubbing
// robot's effective base.
TEST_F(FieldPlant, ASkidSteerSlipsAtRandom) {
  parameters_.centre_of_gravity_error = 0;
  const Driven field = drive();
  parameters_.sensor_errors = ErrorLevel::kDataSheet;
  const Driven exact = drive();
  EXPECT_LT(std::abs(exact.rims - exact.ground), 0.002) << "tyres creep while they pull";
  EXPECT_LT(std::abs(exact.yaw), 1e-4);
  EXPECT_GT(std::abs(field.rims - field.ground), 0.001);
  EXPECT_LT(std::abs(field.rims - field.ground), 5 * 0.0066);
  EXPECT_GT(std::abs(field.yaw), 1e-3);
  EXPECT_LT(std::abs(field.yaw), 5 * 0.0132 / 0.5);
}

TEST_F(FieldPlant, TheSameSeedGivesTheSameBitsAndAnotherOneOthers) {
  const Driven first = drive(), second = drive();
  EXPECT_EQ(first.accelerometer, second.accelerometer);
  EXPECT_EQ(first.rates, second.rates);
  EXPECT_EQ(first.ground, second.ground);
  parameters_.seed = 1;
  const Driven other = drive();
  EXPECT_NE(first.accelerometer, other.accelerometer);
  EXPECT_NE(first.ground, other.ground);
}

TEST_F(FieldPlant, NothingOfTheFieldReachesTheDataSheet) {
  parameters_.sensor_errors = ErrorLevel::kDataSheet;
  const Driven plain = drive();
  parameters_.roughness = 10;
  parameters_.imu_delay = parameters_.imu_jitter = parameters_.encoder_jitter = 0.1;
  parameters_.wheel_slip_noise = parameters_.centre_of_gravity_error = 0.1;
  const Driven same = drive();
  EXPECT_EQ(plain.accelerometer, same.accelerometer);
  EXPECT_EQ(plain.positions, same.positions);
  EXPECT_EQ(plain.ground, same.ground);
}

TEST_F(FieldPlant, EncodersAreAsLateAsTheirJitterSays) {
  const Driven on_time = drive();
  parameters_.encoder_jitter = 0.005;
  const Driven late = drive();
  double largest = 0;
  for (std::size_t k = 0; k < late.positions.size(); ++k) {
    ASSERT_LE(late.positions[k], on_time.positions[k] + 1e-9);
    largest = std::max(largest, on_time.positions[k] - late.positions[k]);
  }
  EXPECT_GT(largest, 0.005 * 10) << "a standard deviation at 10 rad/s";
  EXPECT_LT(largest, 6 * 0.005 * 10 + 0.01) << "six of them and a cycle";
}

TEST_F(FieldPlant, TheCentreOfGravityIsOff) {
  parameters_.scene = kFlat;
  const auto centre = [&] {
    MujocoPlant plant(made_.model(), parameters_, kStep);
    plant.start();
    const mjtNum* of_all = plant.data()->subtree_com + 3 * plant.model().base_body;
    const mjtNum* base = plant.data()->xpos + 3 * plant.model().base_body;
    return std::array<double, 2>{of_all[0] - base[0], of_all[1] - base[1]};
  };
  const auto field = centre();
  parameters_.sensor_errors = ErrorLevel::kDataSheet;
  const auto described = centre();
  const double off = parameters_.centre_of_gravity_error * made_.wheel_base;
  EXPECT_NEAR(field[0] - described[0], off, 1e-4) << "but for the lean of the robot";
  EXPECT_NEAR(field[1] - described[1], off, 1e-4);
}

// Otherwise the noise of one sample would pass for the bias in a short rest.
TEST(FieldErrors, BeginWithWhatTheImuMeasuredBefore) {
  MujocoPlantParameters parameters;
  parameters.sensor_errors = ErrorLevel::kField;
  parameters.imu_delay = 0.05;
  parameters.imu_jitter = 0;
  SensorErrors errors(two_wheels(), {}, parameters, kStep);
  std::set<double> rates;
  for (int i = 0; i < 50; ++i) {
    Measurement standing;
    errors.step(standing);
    rates.insert(standing.imu.angular_velocity[2]);
  }
  EXPECT_EQ(rates.size(), 50u);
}

}  // namespace robot_control::tests

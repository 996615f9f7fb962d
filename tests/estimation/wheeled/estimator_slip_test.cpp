// Wheels slip: the state soon reports which and why, and the covariance holds what the path errs. Rolling wheels raise
// no flag.

#include "estimation/wheeled/estimator_fixture.h"
#include "support/constants.h"

namespace robot_control::tests {

/// Stands for two seconds, drives curves in which the clock offset is found, then 0.5 m/s; the noise is that of a
/// consumer IMU.
struct EstimatorSlipTest : EstimatorFixture {
  explicit EstimatorSlipTest(int curves = 20000) {
    robot_.noise = {.gyro = 1e-4, .accelerometer = 1e-3, .counts = 4096};
    stand(2000);
    for (int i = 0; i < curves; ++i) drive(0.5, 0.6 * std::sin(i * 2e-3), 1);
    drive(0.5, 0, 6000);  // in which the level of the residuals is learned
    EXPECT_EQ(state_.wheeled.slip, 0u);
  }
  bool names(std::uint64_t reasons) const { return (state_.wheeled.slip & reasons) == reasons; }
  /// Cycles, of `cycles` with the present motion, until slip is flagged; counts the flagged ones.
  int flagged(int cycles) {
    int count = 0;
    for (int i = 0; i < cycles; ++i) {
      robot_.go(robot_.motion);
      observe();
      count += has(kStateSlip) ? 1 : 0;
    }
    return count;
  }
  void recover(int cycles = 3000) {
    robot_.tread = {};
    for (int i = 0; i < cycles; ++i) {
      robot_.go(robot_.motion);
      observe();
    }
  }
  /// m, deviation of the position.
  double deviation() const { return std::sqrt(state_.base.pose_covariance[0] + state_.base.pose_covariance[7]); }
  double raw_error() const {
    return std::hypot(state_.wheeled.odometry.x - robot_.x(), state_.wheeled.odometry.y - robot_.y());
  }
};

struct SlippingWheels {
  std::optional<double> left, right;
  std::uint64_t named;
};

struct EstimatorWheelsTest : EstimatorSlipTest, testing::WithParamInterface<SlippingWheels> {};

TEST_P(EstimatorWheelsTest, NamesWheelsThatSpinOrAreStuckAndEndsWithThem) {
  robot_.tread = {GetParam().left, GetParam().right};
  EXPECT_GT(flagged(600), 600 - 1000 * Tuning::kSlipSpan);  // later, slow errors of the accelerometer explain it
  EXPECT_EQ(state_.wheeled.slip, GetParam().named);
  EXPECT_EQ(state_.wheeled.confidence[kRightEncoder], 0);
  EXPECT_LT(position_error(), 3 * deviation());
  EXPECT_LT(yaw_error(), 0.01);
  recover();
  EXPECT_EQ(state_.wheeled.slip, 0u);
  EXPECT_LT(position_error(), 3 * deviation());
}

INSTANTIATE_TEST_SUITE_P(SpinningOrStuck, EstimatorWheelsTest,
                         testing::Values(SlippingWheels{{}, 1.0, kSlipSpinning}, SlippingWheels{0.0, {}, kSlipStalled},
                                         SlippingWheels{1.0, 1.0, kSlipSpinning}));

// The accelerometer's bias is not known, so its integral of a slide would move the path by metres.
TEST_F(EstimatorFixture, ASlideBeforeTheFirstRestIsNotCorrected) {
  robot_.noise = {.gyro = 1e-4, .accelerometer = 1e-3, .counts = 4096};
  const auto slipping = [&] {
    int count = 0;
    drive(0.5, 0, 10000);
    robot_.tread = {1.0, 1.0};
    for (int i = 0; i < 1000; ++i) {
      robot_.go(robot_.motion);
      observe();
      count += has(kStateSlip) ? 1 : 0;
    }
    robot_.tread = {};
    return count;
  };
  EXPECT_EQ(slipping(), 0);
  EXPECT_NEAR(x(), state_.wheeled.odometry.x, 0.02);
  drive(0.5, 0, 1000);
  stand(3000);
  EXPECT_GT(slipping(), 500);
}

// Friction brakes the body with 1 m/s² for half a second, 0.125 m long.
TEST_F(EstimatorSlipTest, LockedWheelsOfARobotThatSlidesOn) {
  robot_.tread = {0.0, 0.0};
  int flagged = 0;
  for (int i = 0; i < 450; ++i) {
    drive(0, 0, 1);
    flagged += has(kStateSlip) ? 1 : 0;
    if (i == 200) {
      EXPECT_TRUE(names(kSlipStalled));
    }
  }
  EXPECT_GT(flagged, 50) << "until wheels and gyro stand";
  drive(0, 0, 3000);
  EXPECT_TRUE(has(kStateStandstill));
  EXPECT_EQ(state_.wheeled.slip, 0u);
  EXPECT_GT(raw_error(), 0.1);
  EXPECT_LT(position_error(), 1.1 * raw_error());
  EXPECT_LT(position_error(), 3 * deviation());
}

/// The robot has not turned yet: wheels and accelerometer may be a tenth of a second apart.
struct EstimatorSlipBeforeATurn : EstimatorSlipTest {
  EstimatorSlipBeforeATurn() : EstimatorSlipTest(0) {}
};

TEST_F(EstimatorSlipBeforeATurn, LockedWheelsAreNoWorseThanTheWheels) {
  robot_.tread = {0.0, 0.0};
  drive(0, 0, 3000);
  EXPECT_GT(raw_error(), 0.1);
  EXPECT_LT(position_error(), 1.1 * raw_error());
}

// The body leans by 2°: the accelerometer shows an endless slide. The path does not move.
TEST_F(EstimatorSlipTest, ABodyThatLeansDoesNotDriftAway) {
  robot_.accelerometer_bias.y() += 0.34;
  double farthest = 0;
  for (int i = 0; i < 20000; ++i) {
    drive(0.5, 0, 1);
    farthest = std::max(farthest, position_error());
  }
  EXPECT_LT(farthest, 0.1);  // 1 % of the way
}

// This holds from the first cycle of the verdict on.
TEST_F(EstimatorSlipTest, TheVelocityOfASlideIsAsUncertainAsItIsWrong) {
  robot_.tread = {1.5, 1.5};
  while (flagged(1) == 0) ASSERT_LT(robot_.distance, 20);
  for (int i = 0; i < 300; ++i) {
    ASSERT_NEAR(speed(), 0.5, 4 * std::sqrt(state_.base.twist_covariance[0])) << "cycle " << i;
    flagged(1);
  }
}

TEST_F(EstimatorSlipTest, IsNotForgottenWhereThePoseIsSet) {
  robot_.tread = {1.0, 1.0};
  drive(0.5, 0, 500);
  ASSERT_TRUE(has(kStateSlip));
  estimator_.set_pose({3, 2, 1});
  for (int i = 0; i < 50; ++i) {
    drive(0.5, 0, 1);
    ASSERT_TRUE(names(kSlipSpinning)) << i;
  }
}

TEST_F(EstimatorSlipTest, CanBeSwitchedOff) {
  EstimatorParameters parameters;
  parameters.slip_detection = false;
  Estimator trusting(parameters, two_wheeler(), kPeriod);
  StateFrame state;
  RollingRobot robot;
  for (int i = 0; i < 4000; ++i) {
    robot.drive(i < 500 ? 0 : 0.5, 0);
    if (i == 2500) robot.tread[1] = 0.8;
    trusting.step(robot.frame(), state);
    ASSERT_EQ(state.wheeled.slip, 0u);
    ASSERT_EQ(state.base.flags & kStateSlip, 0u);
  }
}

void rolls(RollingRobot&, int) {}
double level(double) {
  return 0;
}

/// Random drives with noise, always rolling; the flagged share is measured.
struct EstimatorRollingTest : testing::Test {
  static constexpr unsigned kSeeds = 4;

  template <class Shake, class PitchRate>
  double flagged(const DriveTrain& model, Shake shake, PitchRate pitch_rate) {
    double sum = 0;
    for (unsigned seed = 1; seed <= kSeeds; ++seed) sum += flagged(seed, model, shake, pitch_rate);
    return sum / kSeeds;
  }
  template <class Shake, class PitchRate>
  double flagged(unsigned seed, const DriveTrain& model, Shake shake, PitchRate pitch_rate) {
    RollingRobot robot(model, kPeriod, seed);
    robot.noise = {.gyro = 2.44e-4, .accelerometer = 2e-3, .counts = 4096};
    robot.radius_ratio = 0.003;
    robot.wheel_base = 0.01;
    robot.gyro_bias = {0.001, 0.001, -0.0015};
    robot.accelerometer_bias = {0.05, -0.05, 0.1};
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> any(-1, 1);
    Estimator estimator(rigid_tyres(), model, kPeriod);
    StateFrame state;
    double linear = 0;
    double angular = 0;
    int count = 0;
    constexpr int kCycles = 60000;
    for (int i = 0; i < kCycles; ++i) {
      if (i > 2000 && i % 3000 == 0) {
        linear = 0.6 * any(random);
        angular = any(random);
      }
      shake(robot, i);
      robot.drive(linear, angular, i > 2000 ? pitch_rate(i * kPeriod) : 0);
      estimator.step(robot.frame(), state);
      count += (state.base.flags & kStateSlip) != 0 ? 1 : 0;
    }
    return count / static_cast<double>(kCycles);
  }
};

// Promised: ≤ 3 % of the time.
TEST_F(EstimatorRollingTest, RollingIsNotCalledSlip) {
  EXPECT_LE(flagged(two_wheeler(), rolls, level), 0.03);
}

// 1° RMS at 1.5 Hz, about the contact; the IMU is 0.3 m above it.
TEST_F(EstimatorRollingTest, GroundThatPitchesTheBodyIsNotCalledSlip) {
  DriveTrain model = two_wheeler();
  model.imu_in_base.position = {0.1, 0, 0.3};
  const double amplitude = std::numbers::sqrt2 * std::numbers::pi / 180;
  const double frequency = 2 * std::numbers::pi * 1.5;
  const auto pitch_rate = [&](double t) { return amplitude * frequency * std::cos(frequency * t); };
  EXPECT_LE(flagged(model, rolls, pitch_rate), 0.03);
}

constexpr double kMaxCreep = 0.03;  // of rubber under force

TEST_F(EstimatorRollingTest, CreepIsNotCalledSlip) {
  const auto creeps = [](RollingRobot& robot, int) {
    for (const std::size_t side : {0U, 1U}) {
      const double sign = side == 0 ? -1 : 1;
      const double rolling = robot.motion.velocity.x() + sign / 2 * two_wheeler().wheel_base * robot.motion.rate.z();
      robot.tread[side] = rolling * (1 - 0.4 * kMaxCreep * sign);
    }
  };
  EXPECT_LE(flagged(two_wheeler(), creeps, level), 0.03);
}

}  // namespace robot_control::tests

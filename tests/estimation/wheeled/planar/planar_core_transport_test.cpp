// Compares the transport of the planar core's covariance in a step with derivatives of the step by differences.

#include "estimation/wheeled/planar/planar_core_fixture.h"

namespace robot_control::tests {

constexpr double kDerivative = 1e-8;  // relative, of a central difference of 1e-5

/// x → x behind the step, in closed form: gyro scale included.
using Step = std::function<CoreVector(const CoreVector&)>;

CoreMatrix derivative(const Step& step, const CoreVector& at) {
  constexpr double kSmall = 1e-5;
  CoreMatrix by;
  for (int i = 0; i < by.cols(); ++i) {
    CoreVector more = at;
    CoreVector less = at;
    more[i] += kSmall;
    less[i] -= kSmall;
    by.col(i) = (step(more) - step(less)) / (2 * kSmall);
  }
  return by;
}

/// A core whose error state is correlated throughout, in the middle of a block.
struct CoreTransportTest : testing::Test {
  CoreTransportTest() : core_(core_without_noise()) {
    core_.place({1.0, -2.0, 0.7});
    practise(core_, 5);
    core_.set_calibration({.radius_ratio_deviation = 0.004, .wheel_base_deviation = 0.01});
    practise(core_, 5);
    // The corrections left a calibration of about 0 and a bias of about 0.
    core_.begin_block(0.5);
    core_.turn_by_gyro(0.1, 0.2);
    core_.roll(0.05, 0.03, 0.5);
  }
  void expect_transport(const Step& step, const CoreMatrix& before, const CoreVector& at, const CoreMatrix& noise) {
    const CoreMatrix by = derivative(step, at);
    const CoreMatrix expected = by * before * by.transpose() + noise;
    const CoreMatrix p = *core_.covariance();
    for (int i = 0; i < p.rows(); ++i) {
      for (int k = 0; k < p.cols(); ++k) {
        const double scale = std::sqrt(expected(i, i) * expected(k, k));
        EXPECT_NEAR(p(i, k), expected(i, k), kDerivative * scale) << i << ", " << k;
      }
    }
  }
  PlanarCore core_;
};

TEST_F(CoreTransportTest, TheGyroTurnsByItsBiasAndItsScale) {
  constexpr double kAngle = 0.05;
  constexpr double kInterval = 0.1;
  const CoreMatrix before = *core_.covariance();
  const CoreVector at = values_of(core_);
  const Step step = [&](CoreVector x) {
    x[PlanarCore::kYaw] += (1 + x[PlanarCore::kScale]) * (kAngle - x[PlanarCore::kBias] * kInterval);
    return x;
  };
  core_.turn_by_gyro(kAngle, kInterval);
  EXPECT_NEAR(core_.pose().yaw, step(at)[PlanarCore::kYaw], 1e-15);
  expect_transport(step, before, at, CoreMatrix::Zero());
}

// The wheels are read late by the clock offset, in which the robot turned.
TEST_F(CoreTransportTest, AWayTurnsWithTheYawOfItsReading) {
  constexpr double kRate = 0.8;
  const double x = 0.3;
  const double y = -0.4;
  const CoreMatrix before = *core_.covariance();
  const CoreVector at = values_of(core_);
  const Step step = [&](CoreVector state) {
    const double turned =
        state[PlanarCore::kYaw] - at[PlanarCore::kYaw] - kRate * (state[PlanarCore::kOffset] - at[PlanarCore::kOffset]);
    state[PlanarCore::kX] += std::cos(turned) * x - std::sin(turned) * y;
    state[PlanarCore::kY] += std::sin(turned) * x + std::cos(turned) * y;
    return state;
  };
  CoreMatrix noise = CoreMatrix::Zero();  // the mean of two sides that slip by themselves, over 0.5 m
  noise(PlanarCore::kX, PlanarCore::kX) = noise(PlanarCore::kY, PlanarCore::kY) = core_.slip() * core_.slip() / 2 * 0.5;
  core_.roll(x, y, kRate);
  expect_transport(step, before, at, noise);
}

// The calibration is that of the model here.
TEST_F(CoreTransportTest, TheWheelsTurnByTheirCalibration) {
  PlanarCoreParams params = core_without_noise();
  params.slip_least = 0;
  core_ = PlanarCore(params);
  core_.roll(1, 2, 0);
  const double left = 0.2;
  const double right = 0.5;
  const CoreMatrix before = *core_.covariance();
  const CoreVector at = values_of(core_);
  const Step step = [&](CoreVector x) {
    PlanarCore other(params);
    other.set_calibration({1 + x[PlanarCore::kRatio], 1 + x[PlanarCore::kBase]});
    x[PlanarCore::kYaw] += other.wheel_turn(left, right);
    return x;
  };
  core_.turn_by_wheels(left, right, 0);
  EXPECT_NEAR(core_.pose().yaw, (right - left) / params.wheel_base, 1e-15);
  const CoreMatrix by = derivative(step, at);
  CoreMatrix noise = CoreMatrix::Zero();
  noise(PlanarCore::kYaw, PlanarCore::kYaw) = (*core_.covariance())(PlanarCore::kYaw, PlanarCore::kYaw) -
                                              (by * before * by.transpose())(PlanarCore::kYaw, PlanarCore::kYaw);
  EXPECT_GT(noise(PlanarCore::kYaw, PlanarCore::kYaw), 0) << "slip of both sides";
  expect_transport(step, before, at, noise);
}

// Straight on for s metres in T seconds: σ_yaw² = b² T² + n² T, and across the way b² (s T)²/4 + n² s² T/3.
TEST(CoreTransport, TheCovarianceOfAStraightWayIsThatOfTheClosedForm) {
  constexpr double kBias = 0.01;
  constexpr double kNoise = 1e-2;
  constexpr double kSeconds = 20;
  constexpr double kWay = 10;
  PlanarCore core({.gyro_noise = kNoise, .gyro_bias_walk = 0, .gyro_bias_initial = kBias});
  constexpr int kSteps = 2000;
  for (int i = 0; i < kSteps; ++i) {
    core.turn_by_gyro(0, kSeconds / kSteps);
    core.roll(kWay / kSteps, 0, 0);
  }
  const double slips = core.slip() * core.slip() / 2 * kWay;
  const double yaw = kBias * kBias * kSeconds * kSeconds + kNoise * kNoise * kSeconds;
  const double across =
      kBias * kBias * kWay * kWay * kSeconds * kSeconds / 4 + kNoise * kNoise * kWay * kWay * kSeconds / 3;
  EXPECT_NEAR((*core.covariance())(PlanarCore::kYaw, PlanarCore::kYaw), yaw, 1e-9 * yaw);
  EXPECT_NEAR((*core.covariance())(PlanarCore::kY, PlanarCore::kY), across + slips,
              2e-3 * across);  // of the sum for the integral
  EXPECT_NEAR((*core.covariance())(PlanarCore::kX, PlanarCore::kX), slips, 1e-9 * slips);
}

}  // namespace robot_control::tests

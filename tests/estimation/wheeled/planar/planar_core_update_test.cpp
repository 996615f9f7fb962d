// Compares the planar core's update with that of the textbook: a Kalman filter with a considered state (S. F. Schmidt,
// 1966).

#include "estimation/wheeled/planar/planar_core_fixture.h"

namespace robot_control::tests {

constexpr double kRounding = 1e-12;  // relative
constexpr double kBase = PlanarCoreParams{}.wheel_base;

/// A block of 0.4 m and 0.3 rad is about to end. The calibration is held, so that it does not walk.
struct CoreUpdateTest : testing::Test {
  CoreUpdateTest() {
    practise(core_, 3);
    core_.begin_block(0.1);
    core_.turn_by_gyro(0.3, 1.0);
    core_.roll(0.4 * std::cos(core_.pose().yaw), 0.4 * std::sin(core_.pose().yaw), 0.3);
  }
  /// m: motion of the right side beyond the turn of the gyro.
  PlanarCore::Innovation end_block(double innovation) {
    const double turn = kBase * (1 + core_.base()) * (core_.turned() - core_.offset() * kLater);
    const double difference = turn + innovation - core_.ratio() * kWay;
    left_ = kWay - difference / 2;
    right_ = kWay + difference / 2;
    return core_.end_block({.time = 1.0, .left = left_, .right = right_, .rate = 0.1 + kLater});
  }
  /// d innovation / d state, of a block that ends with `innovation` m.
  CoreVector measurement(double innovation) const {
    CoreVector h = CoreVector::Zero();
    h[PlanarCore::kYaw] = kBase * (1 + core_.base());
    h[PlanarCore::kAnchor] = -h[PlanarCore::kYaw];
    h[PlanarCore::kBase] = kBase * (core_.turned() - core_.offset() * kLater) + innovation / (1 + core_.base());
    h[PlanarCore::kOffset] = -kBase * (1 + core_.base()) * kLater;
    h[PlanarCore::kRatio] = -kWay;
    return h;
  }
  static constexpr double kWay = 0.4;
  static constexpr double kLater = 0.4;  // rad/s, by which it turns faster at the end
  PlanarCore core_{rolling_wheels()};
  double left_ = 0, right_ = 0;
};

TEST_F(CoreUpdateTest, ABlockIsAKalmanUpdateThatConsidersTheGyrosScale) {
  const CoreMatrix before = *core_.covariance();
  const CoreVector x = values_of(core_);
  constexpr double kInnovation = 2e-4;
  const CoreVector h = measurement(kInnovation);
  const PlanarCore::Innovation verdict = end_block(kInnovation);
  ASSERT_TRUE(verdict.used);
  ASSERT_LT(verdict.nis, 1);
  const double s = kInnovation * kInnovation / verdict.nis;
  const double r = s - h.dot(before * h);
  ASSERT_GT(r, 0) << "slip and encoders";
  CoreVector gain = before * h / s;
  gain[PlanarCore::kScale] = 0;
  const CoreMatrix left = CoreMatrix::Identity() - gain * h.transpose();
  const CoreMatrix expected = left * before * left.transpose() + r * gain * gain.transpose();  // Joseph's form
  const CoreVector change = values_of(core_) - x;
  for (int i = 0; i < change.size(); ++i) {
    EXPECT_NEAR(change[i], kInnovation * gain[i], kRounding * std::sqrt(before(i, i)) + 1e-15) << i;
  }
  const CoreMatrix p = *core_.covariance();
  for (int i = 0; i < p.rows(); ++i) {
    for (int k = 0; k < p.cols(); ++k) {
      if (i == k && (i == PlanarCore::kRatio || i == PlanarCore::kBase || i == PlanarCore::kOffset)) {
        EXPECT_GT(p(i, i), expected(i, i)) << "it walks";
      } else {
        EXPECT_NEAR(p(i, k), expected(i, k), 1e-9 * std::sqrt(before(i, i) * before(k, k))) << i << ", " << k;
      }
    }
  }
}

TEST_F(CoreUpdateTest, TheGyrosScaleIsNeverBetterKnown) {
  const double before = core_.deviation(PlanarCore::kScale);
  practise(core_, 100);
  EXPECT_EQ(core_.deviation(PlanarCore::kScale), before);
}

// Huber's bound lets an innovation of n deviations s pull as one of kHuber √w does, with w = n² s / kHuber².
TEST_F(CoreUpdateTest, AnInnovationBeyondHubersBoundWidensItsOwnDeviation) {
  constexpr double kInnovation = 0.02;
  const double variance = (*core_.covariance())(PlanarCore::kBias, PlanarCore::kBias);
  const double bias = core_.bias();
  const double ph = (*core_.covariance() * measurement(kInnovation))[PlanarCore::kBias];
  const PlanarCore::Innovation verdict = end_block(kInnovation);
  ASSERT_TRUE(verdict.used);
  ASSERT_GT(verdict.nis, 2 * Tuning::kHuber * Tuning::kHuber);
  const double widened = kInnovation * kInnovation / (Tuning::kHuber * Tuning::kHuber);
  EXPECT_NEAR(core_.bias() - bias, ph * kInnovation / widened, 1e-9 * std::abs(ph / kInnovation));
  EXPECT_NEAR((*core_.covariance())(PlanarCore::kBias, PlanarCore::kBias), variance - ph * ph / widened,
              1e-9 * variance);
}

// The first block of a turn shows the sum of the errors of bias and base.
TEST_F(CoreUpdateTest, ABaseThatIsNotKnownStaysInTheDeviationOfTheBias) {
  constexpr double kWrong = 0.06;
  constexpr double kTurn = 0.4;
  PlanarCore core{PlanarCoreParams{.drags_wheels = false, .ratio_deviation = 0.001}};
  core.begin_block(kTurn);
  core.turn_by_gyro(kTurn, 1.0);
  const double difference = kBase * (1 + kWrong) * kTurn;
  core.end_block({.time = 1.0, .left = kWay - difference / 2, .right = kWay + difference / 2, .rate = kTurn});
  EXPECT_LT(std::abs(core.bias()), 2.5 * core.deviation(PlanarCore::kBias));
  EXPECT_LT(std::abs(core.pose().yaw - kTurn), 2.5 * core.deviation(PlanarCore::kYaw));
}

TEST_F(CoreUpdateTest, AnInnovationBeyondSixDeviationsIsNotUsed) {
  PlanarCore other = core_;
  const double deviation = 1e-4 / std::sqrt(end_block(1e-4).nis);
  core_ = other;
  const CoreVector x = values_of(core_);
  EXPECT_FALSE(end_block(6.5 * deviation).used);
  EXPECT_EQ((values_of(core_) - x).norm(), 0);
}

TEST_F(CoreUpdateTest, WhatIsHeldIsNotLearned) {
  PlanarCoreParams params;
  params.ratio_deviation = params.wheel_base_deviation = 0;
  core_ = PlanarCore(params);
  core_.set_calibration({1.01, 1.02});
  practise(core_, 20);
  EXPECT_EQ(core_.calibration().radius_ratio, 1.01);
  EXPECT_EQ(core_.calibration().wheel_base_factor, 1.02);
}

// The gyro's mean at rest, of variance r. The correction of the pose is held back, because it is not significant.
TEST_F(CoreUpdateTest, ARestIsAKalmanUpdateOfTheBias) {
  const CoreMatrix before = *core_.covariance();
  const CoreVector x = values_of(core_);
  constexpr double kVariance = 1e-6;
  core_.rest(0.003, kVariance, false);
  CoreVector gain = before.col(PlanarCore::kBias) / (before(PlanarCore::kBias, PlanarCore::kBias) + kVariance);
  gain[PlanarCore::kScale] = 0;
  const CoreVector change = values_of(core_) - x;
  const double innovation = 0.003 - x[PlanarCore::kBias];
  for (int i = 0; i < change.size(); ++i) {
    const bool held = i >= PlanarCore::kX && i <= PlanarCore::kAnchor;
    EXPECT_NEAR(change[i], held ? 0 : innovation * gain[i], 1e-12) << i;
  }
  CoreVector h = CoreVector::Zero();
  h[PlanarCore::kBias] = 1;
  const CoreMatrix left = CoreMatrix::Identity() - gain * h.transpose();
  const CoreMatrix expected = left * before * left.transpose() + kVariance * gain * gain.transpose();
  const CoreMatrix p = *core_.covariance();
  for (int i = 0; i < p.rows(); ++i) {
    for (int k = 0; k < p.cols(); ++k) {
      EXPECT_NEAR(p(i, k), expected(i, k), 1e-9 * std::sqrt(before(i, i) * before(k, k))) << i << ", " << k;
    }
  }
}

/// Rests for 4 s after 240 s at 0.5 m/s without a rest; the gyro reads `bias`, rad/s.
PlanarCore rested_late(double bias) {
  PlanarCore core;
  for (int i = 0; i < 240; ++i) {
    core.turn_by_gyro(bias, 1.0);
    core.roll(0.5 * std::cos(core.pose().yaw), 0.5 * std::sin(core.pose().yaw), 0);
  }
  core.rest(bias, square(PlanarCoreParams{}.gyro_noise) / 4, false);
  return core;
}

// The rest corrects the path of 240 s at once, and odom follows without a jump.
TEST(PlanarCoreShown, FollowsACorrectionByALowPass) {
  constexpr double kBias = 0.1 * std::numbers::pi / 180, kCycle = 1e-3;
  PlanarCore core = rested_late(kBias);
  const PlanarPose pose = core.pose(), before = core.shown_pose();
  const double corrected = std::hypot(pose.x - before.x, pose.y - before.y);
  EXPECT_GT(corrected, 10);
  EXPECT_NEAR(before.yaw, 240 * kBias, 1e-9) << "as it drove";
  double farthest = 0;
  PlanarPose last = before;
  for (double time = 0; time < 10 * Tuning::kShowTime; time += kCycle) {
    core.show(kCycle);
    const PlanarPose shown = core.shown_pose();
    farthest = std::max(farthest, std::hypot(shown.x - last.x, shown.y - last.y));
    last = shown;
  }
  EXPECT_NEAR(farthest, corrected * kCycle / Tuning::kShowTime, 1e-6);
  EXPECT_NEAR(last.x, pose.x, 1e-3 * corrected);
  EXPECT_NEAR(last.y, pose.y, 1e-3 * corrected);
  EXPECT_NEAR(last.yaw, pose.yaw, 1e-3);
  core.place({1, 2, 3});
  EXPECT_EQ(core.shown_pose().x, 1) << "a pose that is set is shown at once";
}

// A bias of 0.007 °/s is within its walk and the noise of the rest: the path stays, and its deviation holds the rest.
TEST(CoreLateRest, TurnsNoPathWithinItsDeviation) {
  constexpr double kBias = 0.007 * std::numbers::pi / 180;
  const PlanarCore core = rested_late(kBias);
  EXPECT_NEAR(core.pose().yaw, 240 * kBias, 1e-12);
  EXPECT_NEAR(core.bias(), kBias, 0.1 * kBias);
  EXPECT_GT(core.deviation(PlanarCore::kYaw), 240 * kBias);
  EXPECT_LT(core.deviation(PlanarCore::kYaw), 3 * 240 * kBias);
}

TEST(CoreLateRest, TurnsThePathByABiasBeyondIt) {
  constexpr double kBias = 0.1 * std::numbers::pi / 180;
  const PlanarCore core = rested_late(kBias);
  EXPECT_NEAR(core.pose().yaw, 0, 3 * core.deviation(PlanarCore::kYaw));
  EXPECT_LT(core.deviation(PlanarCore::kYaw), 0.05);
}

TEST_F(CoreUpdateTest, ASettledRestLeavesThePose) {
  const PlanarPose before = core_.pose();
  core_.rest(0.003, 1e-6, true);
  EXPECT_EQ(core_.pose().x, before.x);
  EXPECT_EQ(core_.pose().y, before.y);
  EXPECT_EQ(core_.pose().yaw, before.yaw);
  EXPECT_NEAR(core_.bias(), 0.003, 1e-3);
}

// A gyro is off by 0.02 rad/s, and the wheels show that from the first block. Wheels that a turn drags correct nothing,
// but the deviations hold what they show.
TEST_F(CoreUpdateTest, OnlyWheelsThatAreNotDraggedShowABias) {
  constexpr double kBias = 0.02;
  for (const bool drags : {false, true}) {
    PlanarCore core{PlanarCoreParams{.drags_wheels = drags, .ratio_deviation = 0.001}};
    for (int block = 0; block < 20; ++block) {
      core.begin_block(kBias);
      core.turn_by_gyro(kBias * 1.0, 1.0);
      core.roll(0.5 * std::cos(core.pose().yaw), 0.5 * std::sin(core.pose().yaw), kBias);
      core.end_block({.time = 1.0, .left = 0.5, .right = 0.5, .rate = kBias});
      EXPECT_NEAR(core.bias(), drags ? 0 : kBias, 0.01) << drags;
      EXPECT_LT(std::abs(core.pose().yaw), 3 * core.deviation(PlanarCore::kYaw)) << drags << ' ' << block;
    }
    EXPECT_NEAR(core.pose().yaw, drags ? 20 * kBias : 0, 0.05) << drags;
  }
}

// The path of the way before is that of the bias that the rest shows.
TEST_F(CoreUpdateTest, TheFirstRestCorrectsThePath) {
  constexpr double kBias = 0.01;
  PlanarCore core{PlanarCoreParams{}};
  for (int block = 0; block < 30; ++block) {
    core.begin_block(0);
    core.turn_by_gyro(0, 1.0);
    core.roll(0.5, 0, 0);
    core.end_block({.time = 1.0, .left = 0.5, .right = 0.5});
  }
  EXPECT_EQ(core.pose().yaw, 0);
  core.rest(kBias, 1e-12, false);
  EXPECT_NEAR(core.bias(), kBias, 1e-5);
  EXPECT_NEAR(core.pose().yaw, -30 * kBias, 1e-3);
  EXPECT_NEAR(core.pose().y, -kBias * 0.5 * 30 * 31 / 2, 0.01);
}

// The wheels roll straight on. The doubt is the angle between both beyond the usual, once. Agreement takes it away.
TEST_F(CoreUpdateTest, AContradictionWidensOnceAndShrinksWithAgreement) {
  for (const bool drags : {false, true}) {
    PlanarCore core{PlanarCoreParams{.drags_wheels = drags}};
    core.rest(0, 1e-8, false);
    practise(core, 20);
    core.begin_block(0);
    core.turn_by_gyro(0.8, 1.0);
    EXPECT_FALSE(core.end_block({.time = 1.0, .left = 0.4, .right = 0.4}).used);
    EXPECT_TRUE(core.contradicted());
    const double wide = std::sqrt(core.pose_covariance()(PlanarCore::kYaw, PlanarCore::kYaw));
    EXPECT_NEAR(wide, 0.8, 0.1);
    practise(core, 10);
    const double less = std::sqrt(core.pose_covariance()(PlanarCore::kYaw, PlanarCore::kYaw));
    EXPECT_LT(less, 0.75 * wide);
    practise(core, 100);
    EXPECT_FALSE(core.contradicted());
  }
}

// The gyro turned by three quarters of what dragged wheels did, which scrub explains.
TEST_F(CoreUpdateTest, ScrubIsNoContradiction) {
  for (const bool drags : {false, true}) {
    PlanarCore core{PlanarCoreParams{.drags_wheels = drags}};
    core.rest(0, 1e-8, false);
    practise(core, 20);
    core.begin_block(0.4);
    core.turn_by_gyro(0.4, 1.0);
    EXPECT_FALSE(
        core.end_block({.time = 1.0, .left = 0.4 - 0.26 * kBase, .right = 0.4 + 0.26 * kBase, .rate = 0.4}).used);
    EXPECT_EQ(core.contradicted(), !drags);
  }
}

// Wheels that turned by 5 % more for a time, as on a carpet, teach a base that does not predict the floor thereafter.
TEST_F(CoreUpdateTest, ACalibrationThatDoesNotPredictIsDropped) {
  PlanarCore core{rolling_wheels()};
  core.rest(0, 1e-8, false);
  const auto drive = [&](int blocks, double factor) {
    for (int block = 0; block < blocks; ++block) {
      core.begin_block(0.5);
      core.turn_by_gyro(0.5, 1.0);
      core.roll(0.4 * std::cos(core.pose().yaw), 0.4 * std::sin(core.pose().yaw), 0.5);
      const double turn = kBase * factor * 0.5;
      core.end_block({.time = 1.0, .left = 0.4 - turn / 2, .right = 0.4 + turn / 2, .rate = 0.5});
    }
  };
  drive(40, 1.05);
  EXPECT_NEAR(core.base(), 0.05, 0.02);
  EXPECT_LT(core.deviation(PlanarCore::kBase), 0.02);
  double widest = 0;
  for (int block = 0; block < 40; ++block) {
    drive(1, 1.0);
    widest = std::max(widest, core.deviation(PlanarCore::kBase));
  }
  EXPECT_NEAR(widest, 0.03, 0.003) << "its deviation is again that of the start";
  EXPECT_NEAR(core.base(), 0, 0.01);
}

TEST_F(CoreUpdateTest, PlacingForgetsWhatThePoseWasCorrelatedWith) {
  core_.place({1, 2, 3});
  const CoreMatrix p = *core_.covariance();
  for (const int i : {PlanarCore::kX, PlanarCore::kY, PlanarCore::kYaw, PlanarCore::kAnchor}) {
    EXPECT_EQ(p.row(i).norm(), 0) << i;
    EXPECT_EQ(p.col(i).norm(), 0) << i;
  }
  EXPECT_GT(p(PlanarCore::kBias, PlanarCore::kBias), 0);
  EXPECT_EQ(core_.turned(), 0);
}

TEST_F(CoreUpdateTest, ABiasThatIsSetIsCorrelatedWithNothing) {
  core_.set_bias(0.02, 0.003);
  const CoreMatrix p = *core_.covariance();
  EXPECT_EQ(core_.bias(), 0.02);
  EXPECT_NEAR(p(PlanarCore::kBias, PlanarCore::kBias), 9e-6, 1e-18);
  EXPECT_NEAR(p.row(PlanarCore::kBias).norm(), 9e-6, 1e-18);
}

}  // namespace robot_control::tests

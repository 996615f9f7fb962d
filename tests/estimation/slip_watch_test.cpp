// The watch itself, on a filter whose velocity and corrections are set by hand.

#include "estimation/wheels/slip_watch.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "signals/state_frame.h"
#include "support/allocation_guard.h"
#include "support/constants.h"

namespace robot_control {
namespace {

using Filter = ErrorStateFilter;
constexpr double kWheelSpeed = 0.5;

/// A filter that goes at 0.5 m/s on a level floor and is corrected by wheels and contacts, as the estimator does it.
class SlipWatchTest : public testing::Test {
 protected:
  SlipWatchTest() {
    filter_.velocity = {kWheelSpeed, 0, 0};
    for (const int i : {0, 1, 2}) filter_.covariance(Filter::kVelocity + i, Filter::kVelocity + i) = 1e-6;
    for (const int i : {3, 4}) filter_.covariance(i, i) = 1e-4 * 1e-4;
    for (const int i : {11, 12, 13}) filter_.covariance(i, i) = 1e-8;
    for (const int i : {14, 15, 16}) filter_.covariance(i, i) = 1e-6;
    watch_.begin(filter_);
    go(1000);
  }

  /// Cycles in which the treads move at `left`, `right` m/s, and the body at what the accelerometer says.
  void go(int cycles, double left = kWheelSpeed, double right = kWheelSpeed) {
    for (int i = 0; i < cycles; ++i) {
      Filter::Motion motion;
      motion.dt = kPeriod;
      motion.gyro = Eigen::Vector3d::Zero();
      motion.accelerometer = Eigen::Vector3d(0, side_force_, Filter::kGravity + lift_);
      motion.left_speed = left;
      motion.right_speed = right;
      motion.left_travel = left * kPeriod;
      motion.right_travel = right * kPeriod;
      filter_.predict(motion);
      travel_ += Eigen::Vector2d(left, right) * kPeriod;
      for (const int side : {0, 1}) {
        const bool trusted = watch_.trusts(side == 0 ? Contact::kLeft : Contact::kRight);
        if (trusted && !before_[side]) filter_.anchor_travel(side, travel_[side]);
        before_[side] = trusted;
        if (trusted && heard_) filter_.correct_travel(side, travel_[side]);
      }
      if (watch_.trusts(Contact::kLateral)) filter_.correct_lateral(kPeriod);
      if (watch_.trusts(Contact::kVertical)) filter_.correct_vertical(kPeriod);
      constexpr double kSilent = std::numeric_limits<double>::quiet_NaN();
      watch_.step({.dt = kPeriod,
                   .left = heard_ ? left * kPeriod : kSilent,
                   .right = heard_ ? right * kPeriod : kSilent,
                   .inertial = inertial_},
                  filter_);
    }
  }
  bool all_believed() const {
    return watch_.trusts(Contact::kLeft) && watch_.trusts(Contact::kRight) && watch_.trusts(Contact::kLateral) &&
           watch_.trusts(Contact::kVertical);
  }
  double deviation() const { return std::sqrt(filter_.covariance(Filter::kVelocity, Filter::kVelocity)); }

  Filter filter_{{.wheel_base = 0.5, .middle_y = 0, .middle_x = 0, .height = -0.1, .imu_in_base = {0, 0, 0.1}}, {}, {}};
  SlipWatch watch_;
  Eigen::Vector2d travel_{0, 0};
  bool before_[2] = {true, true};
  bool heard_ = true;
  bool inertial_ = true;
  double side_force_ = 0;  // m/s²
  double lift_ = 0;        // m/s²
};

TEST_F(SlipWatchTest, BelievesWheelsThatRoll) {
  EXPECT_TRUE(all_believed());
  EXPECT_EQ(watch_.reasons(), 0u);
  EXPECT_LT(watch_.turn_nis(), 1);
  EXPECT_LT(watch_.travel_nis(), 1);
}

// 1 m/s too fast is 4 cm in the 40 ms in which the shortest window speaks for the first time.
TEST_F(SlipWatchTest, NoticesBothWheelsSpinningWithinAWindow) {
  go(100, 1.5, 1.5);
  EXPECT_FALSE(watch_.trusts(Contact::kLeft));
  EXPECT_FALSE(watch_.trusts(Contact::kRight));
  EXPECT_EQ(watch_.reasons() & (kSlipLeft | kSlipRight | kSlipSpinning | kSlipStalled),
            std::uint64_t{kSlipLeft | kSlipRight | kSlipSpinning});
}

// Had the wheels been believed the velocity would be theirs; it is the inertial one, as well as it says.
TEST_F(SlipWatchTest, TakesBackWhatWasBelieved) {
  int cycles = 0;
  while (watch_.trusts(Contact::kLeft) && cycles++ < 200) go(1, 1.0, 1.0);
  EXPECT_NEAR(filter_.velocity.x(), kWheelSpeed, 3 * deviation());
  EXPECT_GT(deviation(), 1e-3) << "and it says that it has been in doubt";
  go(1000, 1.0, 1.0);
  EXPECT_NEAR(filter_.velocity.x(), kWheelSpeed, 3 * deviation());
}

TEST_F(SlipWatchTest, ALockedWheelStalls) {
  go(200, 0, kWheelSpeed);
  EXPECT_FALSE(watch_.trusts(Contact::kLeft));
  EXPECT_EQ(watch_.reasons() & (kSlipLeft | kSlipSpinning | kSlipStalled), std::uint64_t{kSlipLeft | kSlipStalled});
  go(800, 0, kWheelSpeed);
  EXPECT_TRUE(watch_.trusts(Contact::kRight)) << "it rolls, and is believed again";
  EXPECT_NE(watch_.reasons() & kSlipTurn, 0u);
}

TEST_F(SlipWatchTest, SlidingSidewaysIsTheLateralContactsMatter) {
  side_force_ = 1.0;
  go(500);
  EXPECT_FALSE(watch_.trusts(Contact::kLateral));
  EXPECT_NE(watch_.reasons() & kSlipSideways, 0u);
  EXPECT_NEAR(filter_.velocity.y(), 0.5, 0.1);
}

TEST_F(SlipWatchTest, BeingLiftedIsTheVerticalContactsMatter) {
  lift_ = 1.0;
  go(500);
  EXPECT_FALSE(watch_.trusts(Contact::kVertical));
  EXPECT_NE(watch_.reasons() & kSlipLifted, 0u);
}

TEST_F(SlipWatchTest, CreepIsNotSlip) {
  go(5000, kWheelSpeed * (1 + 0.9 * SlipWatch::kCreep), kWheelSpeed * (1 + 0.9 * SlipWatch::kCreep));
  EXPECT_TRUE(watch_.trusts(Contact::kLeft));
  EXPECT_TRUE(watch_.trusts(Contact::kRight));
}

TEST_F(SlipWatchTest, BelievesAgainWhenTheSpeedsAgree) {
  go(500, 1.5, 1.5);
  ASSERT_FALSE(watch_.trusts(Contact::kLeft));
  go(1000);
  EXPECT_TRUE(all_believed());
  EXPECT_EQ(watch_.reasons(), 0u);
}

// Agreement with a velocity that nobody knows says little: told at once, believed later.
TEST_F(SlipWatchTest, BelievesLaterWhereTheVelocityIsUnknown) {
  go(100, 1.5, 1.5);
  filter_.covariance(Filter::kVelocity, Filter::kVelocity) = 0.05 * 0.05;
  int told = 0;
  int believed = 0;
  for (int i = 1; i <= 1000 && believed == 0; ++i) {
    go(1, filter_.velocity.x(), filter_.velocity.x());
    if (told == 0 && (watch_.reasons() & kSlipLeft) == 0) told = i;
    if (watch_.trusts(Contact::kLeft)) believed = i;
  }
  EXPECT_GT(told, 0);
  EXPECT_LE(told, 200);
  EXPECT_GE(believed, told + 100);
}

// What was believed in vain has told nothing of the velocity.
TEST_F(SlipWatchTest, DoubtedAgainTheVelocityIsKnownNoBetter) {
  go(100, 1.5, 1.5);
  ASSERT_FALSE(watch_.trusts(Contact::kLeft));
  filter_.covariance(Filter::kVelocity, Filter::kVelocity) = 0.3 * 0.3;
  const double speed = filter_.velocity.x();
  for (int i = 0; i < 1000 && !all_believed(); ++i) go(1, speed, speed);
  ASSERT_TRUE(all_believed());
  go(30, speed, speed);
  ASSERT_LT(deviation(), 0.01);
  for (int i = 0; i < 200 && watch_.trusts(Contact::kLeft); ++i) go(1, speed + 1, speed + 1);
  ASSERT_FALSE(watch_.trusts(Contact::kLeft));
  EXPECT_GT(deviation(), 0.2);
}

TEST_F(SlipWatchTest, WithoutInertialSensorsThereIsNothingToCompareWith) {
  go(500, 1.5, 1.5);
  ASSERT_FALSE(all_believed());
  inertial_ = false;
  go(100, 1.5, 1.5);
  EXPECT_TRUE(all_believed());
  EXPECT_EQ(watch_.reasons() & ~std::uint64_t{kSlipTurn}, 0u);
}

TEST_F(SlipWatchTest, WheelsThatAreNotHeardContradictNothing) {
  heard_ = false;
  go(2000);
  EXPECT_TRUE(all_believed());
  EXPECT_TRUE(std::isfinite(watch_.turn_nis()));
  EXPECT_TRUE(std::isfinite(watch_.travel_nis()));
  heard_ = true;
  go(2000);
  EXPECT_TRUE(all_believed());
}

TEST_F(SlipWatchTest, AResetBelievesAll) {
  go(500, 1.5, 1.5);
  watch_.reset();
  EXPECT_TRUE(all_believed());
  EXPECT_EQ(watch_.reasons(), 0u);
}

TEST_F(SlipWatchTest, StepsWithoutAllocating) {
  if (!AllocationGuard::kCounts) GTEST_SKIP() << "the sanitizer owns the allocator";
  const AllocationGuard guard;
  go(500, 1.5, 1.5);
  go(1000);
  EXPECT_EQ(guard.count(), 0u);
}

}  // namespace
}  // namespace robot_control

// A slide names slip and widens; only the path of a blocked robot is corrected. The slide ends.

#include "estimation/wheeled/slip/slip_fixture.h"
#include "signals/state_frame.h"

namespace robot_control::tests {

struct WheelSlideTest : SlipFixture {
  WheelSlideTest() { learn(); }

  WheelSlide::Speeds treads() const { return {body_.speed + body_.left, body_.speed + body_.right}; }
  void add(const WheelSlide::Correction& correction) {
    corrected_ = corrected_ + correction.shift;
    variance_ += correction.variance;
  }
  /// Drives until the slide ends, or for `seconds`.
  double go(double seconds, double ahead = 0, double across = 0) {
    for (double t = 0; t < seconds - SlidingBody::kStep / 2; t += SlidingBody::kStep) {
      if (!body_.step(ahead, across)) continue;
      evaluate(false);
      if (slide_.active()) {
        add(slide_.step(body_.detector, treads()));
        if (!slide_.active()) return t;
      } else if (any_proven()) {
        add(slide_.begin(body_.detector, treads()));
      }
    }
    return seconds;
  }
  /// Makes both treads faster than the ground by `faster` until a slide has begun.
  void spin(double faster) {
    body_.left = body_.right = faster;
    for (int i = 0; i < 200 && !slide_.active(); ++i) go(SlidingBody::kStep);
    ASSERT_TRUE(slide_.active());
  }
  /// m, error of the path by wheels and slide.
  double error() const {
    return std::hypot(body_.wheels().x + corrected_.x - body_.x, body_.wheels().y + corrected_.y - body_.y);
  }
  double wheels_error() const { return std::hypot(body_.wheels().x - body_.x, body_.wheels().y - body_.y); }

  WheelSlide slide_;
  Planar corrected_;
  double variance_ = 0;  ///< m²
};

TEST_F(WheelSlideTest, ASpinIsNamedAndWidens) {
  spin(0.5);
  go(1.0);
  EXPECT_GT(wheels_error(), 0.4);
  EXPECT_EQ(corrected_.norm(), 0);
  EXPECT_LT(error(), 3 * std::sqrt(variance_));
  EXPECT_EQ(slide_.reasons(), kSlipLeft | kSlipRight | kSlipSpinning);
  EXPECT_EQ(slide_.excess_speed(), 0);
}

TEST_F(WheelSlideTest, ASkidIsNamedAndWidens) {
  spin(-0.4);
  go(1.0);
  EXPECT_GT(wheels_error(), 0.3);
  EXPECT_EQ(corrected_.norm(), 0);
  EXPECT_LT(error(), 3 * std::sqrt(variance_));
  EXPECT_EQ(slide_.reasons(), kSlipLeft | kSlipRight | kSlipStalled);
}

TEST_F(WheelSlideTest, ASpinOfOneSideIsNamed) {
  body_.left = 0.5;
  go(10.0);
  EXPECT_TRUE(slide_.active());
  EXPECT_EQ(slide_.reasons(), kSlipLeft | kSlipTurn | kSlipSpinning);
  EXPECT_EQ(corrected_.norm(), 0);
}

// A wall stops it within 0.1 s, and the accelerometer is off by 0.03 m/s².
TEST_F(WheelSlideTest, ABlockedRobotStaysWhereItIsHoweverLongItsWheelsSpin) {
  body_.error = 0.03;
  while (body_.speed > 0) {
    const double brakes = std::min(5.0, body_.speed / SlidingBody::kStep);
    body_.left = body_.right = 0.5 - body_.speed;
    go(SlidingBody::kStep, -brakes);
  }
  body_.left = body_.right = 0.5;
  go(5.0);
  EXPECT_TRUE(slide_.active());
  EXPECT_GT(wheels_error(), 2.4);
  EXPECT_LT(error(), 0.5);
}

class WheelSlideBounds : public WheelSlideTest, public testing::WithParamInterface<double> {};

// The path moves between standstill and the wheels for any reading of the accelerometer in a slide.
TEST_P(WheelSlideBounds, ThePathStaysBetweenRestAndTheWheels) {
  spin(0.7);
  body_.error = GetParam();
  const double began = body_.wheels().x + corrected_.x;
  for (int i = 1; i < 2000 && slide_.active(); ++i) {
    go(SlidingBody::kStep);
    const double time = i * SlidingBody::kStep;
    const double late = body_.wheel_speed() * 2 * Tuning::kPointInterval;
    const double path = body_.wheels().x + corrected_.x - began;
    ASSERT_GT(path, -late) << i;
    ASSERT_LT(path, body_.wheel_speed() * time + late) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Errors, WheelSlideBounds, testing::Values(-30.0, -3.0, -0.3, 0.3, 3.0, 30.0));

TEST_F(WheelSlideTest, EndsWhenTheWheelsAgreeWithTheBody) {
  spin(0.5);
  go(1.0);
  body_.left = body_.right = 0;
  EXPECT_LT(go(2), 0.6);  // two residuals of 0.2 s, and the slope over two points
  EXPECT_FALSE(slide_.active());
}

// A drifting accelerometer would show endless slip, and wheels that grip show no bend.
TEST_F(WheelSlideTest, AWeakSlideEndsWhereTheAccelerometerNoLongerProvesIt) {
  body_.left = body_.right = 0.08;
  for (int i = 0; i < 400 && !slide_.active(); ++i) go(SlidingBody::kStep);
  ASSERT_TRUE(slide_.active());
  EXPECT_LT(go(60), 30);
}

// The accelerometer errs by 0.15 m/s² for 5 s, seven of its slow errors, which leaves a speed that is none.
TEST_F(WheelSlideTest, ADriftIsNotSudden) {
  spin(0.08);
  body_.left = body_.right = 0;
  body_.error = 0.15;
  go(5);
  ASSERT_TRUE(slide_.active());
  body_.error = 0;
  EXPECT_LT(go(60), 10);
}

// It is lifted and tipped: the accelerometer reads gravity, and its wheels stand.
TEST_F(SlipFixture, ARobotThatIsTippedOnStandingWheelsDoesNotMove) {
  drive(0.5, 1.0);
  drive(20);
  drive(0.5, -1.0);
  drive(2);
  WheelSlide slide;
  Planar moved;
  for (int i = 0; i < 600; ++i) {
    body_.error = i < 200 ? 3.0 : -2.0;
    if (!body_.step()) continue;
    evaluate(false);
    if (slide.active()) {
      moved = moved + slide.step(body_.detector, {}).shift;
    } else if (any_proven()) {
      moved = moved + slide.begin(body_.detector, {}).shift;
    }
  }
  EXPECT_LT(std::hypot(moved.x, moved.y), 0.02);
}

// It is known to be blocked a second after it stopped.
TEST_F(WheelSlideTest, NothingFromBeforeThePoseWasSetIsCorrectedOfABlockedRobot) {
  while (body_.speed > 0) {
    const double brakes = std::min(5.0, body_.speed / SlidingBody::kStep);
    body_.left = body_.right = 0.5 - body_.speed;
    go(SlidingBody::kStep, -brakes);
  }
  body_.left = body_.right = 0.5;
  go(0.9 * Tuning::kBlock);
  corrected_ = {};
  body_.detector.begin_path();
  while (corrected_.norm() == 0 && slide_.active()) go(SlidingBody::kStep);
  EXPECT_LE(corrected_.norm(), 0.5 * Tuning::kBlock + 0.5 * 2 * Tuning::kPointInterval);
}

TEST_F(WheelSlideTest, TheEndLeavesNoExcess) {
  spin(0.5);
  slide_.end();
  EXPECT_FALSE(slide_.active());
  EXPECT_EQ(slide_.excess_speed(), 0);
  EXPECT_EQ(slide_.reasons(), 0u);
}

// The path does not move sideways, but it is uncertain.
TEST_F(WheelSlideTest, SlidingSidewaysIsNamedAndWidens) {
  go(0.5, 0, 1.0);
  ASSERT_TRUE(slide_.active());
  EXPECT_NE(slide_.reasons() & kSlipSideways, 0u);
  EXPECT_LT(std::abs(corrected_.y), 0.01);
  EXPECT_LT(wheels_error(), 3 * std::sqrt(variance_));
}

// It is pushed for 0.5 s, slides on at that speed for as long, and stops.
TEST_F(WheelSlideTest, TheEndLeavesNoSlipSideways) {
  go(0.5, 0, 1.0);
  go(0.5);
  EXPECT_TRUE(slide_.sideways());
  go(0.5, 0, -1.0);
  EXPECT_LT(go(5), 2);
  EXPECT_FALSE(slide_.sideways());
  EXPECT_EQ(slide_.reasons(), 0u);
}

}  // namespace robot_control::tests

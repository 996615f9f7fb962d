// The correction of the path while wheels slip, as the estimator applies it: explicit, bounded, and it ends.

#include "estimation/slip_fixture.h"
#include "signals/state_frame.h"

namespace robot_control {
namespace {

class SlipCorrectionTest : public SlipFixture {
 protected:
  SlipCorrectionTest() { learn(); }

  SlipCorrection::Input input() const {
    return {
        .noise = body_.detector.acceleration_noise(1e-6),
        .path_slope_deviation = std::max(path_slope_deviation_, body_.detector.slope_deviation(SlipResidual::kAlong)),
        .turn_slope_deviation = body_.detector.slope_deviation(SlipResidual::kTurn),
        .wheel_speed = body_.wheel_speed(),
        .sensors_as_specified = as_specified_};
  }
  void add(const PathCorrection& correction) {
    corrected_ = corrected_ + correction.shift;
    variance_ += correction.variance;
  }
  /// s until the slide ends, or `seconds`.
  double go(double seconds, double ahead = 0, double across = 0, double turning = 0) {
    for (double t = 0; t < seconds - SlidingBody::kStep / 2; t += SlidingBody::kStep) {
      const bool point = body_.step(ahead, across, turning);
      if (correction_.active()) {
        add(correction_.step(body_.detector.difference(), input()));
        if (!correction_.active()) return t;
      } else if (point) {
        judge(false);
        if (const double span = body_.detector.shortest_proven_span(); span > 0) {
          add(correction_.begin(body_.detector.difference(), span, input()));
        }
      }
    }
    return seconds;
  }
  /// Both treads are `faster` than the ground until a slide has begun.
  void spin(double faster) {
    body_.left = body_.right = faster;
    for (int i = 0; i < 100 && !correction_.active(); ++i) go(SlidingBody::kStep);
    ASSERT_TRUE(correction_.active());
  }
  /// On locked wheels, with an accelerometer that is off by 0.05 m/s².
  void slide_to_a_stand() {
    spin(-body_.speed);
    body_.error = 0.05;
    while (body_.speed > 0) {
      go(SlidingBody::kStep, -1);
      body_.left = body_.right = -body_.speed;
    }
    body_.speed = body_.left = body_.right = 0;
  }
  /// m, of the path by wheels and correction.
  double error() const {
    return std::hypot(body_.wheels().x + corrected_.x - body_.x, body_.wheels().y + corrected_.y - body_.y);
  }
  double wheels_error() const { return std::hypot(body_.wheels().x - body_.x, body_.wheels().y - body_.y); }

  SlipCorrection correction_;
  bool as_specified_ = true;
  double path_slope_deviation_ = 0;  ///< m/s, at least
  Planar corrected_;
  double variance_ = 0;  ///< m²
};

TEST_F(SlipCorrectionTest, TakesASpinOffThePath) {
  spin(0.5);
  go(1.0);
  EXPECT_GT(wheels_error(), 0.4);
  EXPECT_LT(error(), wheels_error() / 20);
  EXPECT_LT(error(), 3 * std::sqrt(variance_) + 0.005);
  EXPECT_EQ(correction_.reasons(), kSlipLeft | kSlipRight | kSlipSpinning);
  EXPECT_NEAR(correction_.excess_speed(), 0.5, 0.03);
}

TEST_F(SlipCorrectionTest, AddsThePathOfASkid) {
  spin(-0.4);
  go(1.0);
  EXPECT_GT(wheels_error(), 0.3);
  EXPECT_LT(error(), wheels_error() / 20);
  EXPECT_EQ(correction_.reasons(), kSlipLeft | kSlipRight | kSlipStalled);
}

// Wheels that stand while the body slides on do not spin.
TEST_F(SlipCorrectionTest, LockedWheelsAreStalled) {
  spin(-body_.speed);
  for (int i = 0; i < 40; ++i) {
    go(SlidingBody::kStep, -1);
    body_.left = body_.right = -body_.speed - 1e-9;
  }
  ASSERT_TRUE(correction_.active());
  EXPECT_EQ(correction_.reasons(), kSlipLeft | kSlipRight | kSlipStalled);
}

TEST_F(SlipCorrectionTest, TheOtherSideGivesThePathOfASpinOfOne) {
  body_.left = 0.5;
  for (int i = 0; i < 100 && !correction_.active(); ++i) go(SlidingBody::kStep);
  go(10.0);
  EXPECT_TRUE(correction_.active()) << "a side that rolls carries it on as long as it takes";
  EXPECT_EQ(correction_.reasons(), kSlipLeft | kSlipTurn | kSlipSpinning);
  EXPECT_GT(wheels_error(), 2);
  EXPECT_LT(error(), wheels_error() / 50);
}

// Where E is compared with a line by a poor slope, slip may pass for rolling: the path is as uncertain as that slope.
TEST_F(SlipCorrectionTest, ASideThatMayRollLeavesThePathInDoubt) {
  constexpr double kPoor = 0.3;  // m/s
  body_.left = 0.05;
  for (int i = 0; i < 100 && !correction_.active(); ++i) go(SlidingBody::kStep);
  ASSERT_TRUE(correction_.active());
  body_.left = 0.55;
  body_.right = 0.45;
  path_slope_deviation_ = kPoor;
  go(1.0);
  ASSERT_GT(error(), 0.3) << "it is taken for rolling";
  EXPECT_LT(error(), 2.5 * std::sqrt(variance_));
}

class SlipBounds : public SlipCorrectionTest, public testing::WithParamInterface<double> {
 protected:
  static constexpr double kSlack = 0.021;  // m/s, of the bounds, and rounding
};

// Whatever the accelerometer reads in a slide: the path is that of a speed between zero, that of before, and the
// wheels'. A renewed line moves it at once, within the same bounds.
TEST_P(SlipBounds, ThePathStaysBetweenRestAndTheWheels) {
  spin(0.7);
  body_.error = GetParam();
  const double began = body_.wheels().x + corrected_.x;
  for (int i = 1; i < 2000 && correction_.active(); ++i) {
    go(SlidingBody::kStep);
    const double time = i * SlidingBody::kStep;
    const double path = body_.wheels().x + corrected_.x - began;
    ASSERT_GT(path, -kSlack * time - 1e-3) << i;
    ASSERT_LT(path, (body_.wheel_speed() + kSlack) * time + 1e-3) << i;
  }
}

// The wheels come to rest with the body, and the line is renewed: what is undone stays within these bounds, too.
TEST_P(SlipBounds, WhatIsUndoneLeavesThePathBetweenRestAndTheWheels) {
  constexpr double kProving = 0.1 * 0.7;  // m: the speed of the end is taken for that of the whole span that proved it
  const double began = body_.wheels().x;
  spin(0.7);
  body_.error = GetParam();
  const double fastest = body_.wheel_speed() + kSlack;
  double time = Tuning::kResidualSpans.back();  // s since it began, at most
  const auto goes = [&](double ahead) {
    time += SlidingBody::kStep;
    go(SlidingBody::kStep, ahead);
    const double path = body_.wheels().x + corrected_.x - began;
    EXPECT_GT(path, -kSlack * time - kProving) << time;
    EXPECT_LT(path, fastest * time + kProving) << time;
  };
  while (time < 4) goes(0);
  while (body_.speed > 0) {
    body_.left = body_.right = body_.left * (1 - 1 / (body_.speed / SlidingBody::kStep));
    goes(-1);
  }
  body_.speed = body_.left = body_.right = body_.error = 0;
  for (int i = 0; i < 200 && correction_.active(); ++i) goes(0);
  EXPECT_FALSE(correction_.active());
}

// What is published as the speed is bounded likewise.
TEST_P(SlipBounds, TheSpeedStaysBetweenRestAndTheWheels) {
  spin(0.7);
  body_.error = GetParam();
  for (int i = 0; i < 600 && correction_.active(); ++i) {
    go(SlidingBody::kStep);
    const double speed = body_.wheel_speed() - correction_.excess_speed();
    ASSERT_GT(speed, -kSlack) << i;
    ASSERT_LT(speed, body_.wheel_speed() + kSlack) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Errors, SlipBounds, testing::Values(-30.0, -3.0, -0.3, 0.3, 3.0, 30.0));

// Two decisions of 0.1 s, and 0.15 s of agreement.
TEST_F(SlipCorrectionTest, EndsWhenTheWheelsAgreeWithTheBody) {
  spin(0.5);
  go(1.0);
  body_.left = body_.right = 0;
  EXPECT_LT(go(2), 0.5);
  EXPECT_FALSE(correction_.active());
  EXPECT_FALSE(correction_.given_up());
  EXPECT_EQ(correction_.reasons(), 0u);
}

// The body has stopped within the slide; then its line is as wrong as the accelerometer made it.
TEST_F(SlipCorrectionTest, EndsWhenTheRobotStands) {
  slide_to_a_stand();
  EXPECT_LT(go(2), 0.6);
  EXPECT_FALSE(correction_.active());
}

// Within the tolerance of the line and yet bent by friction: what is left of the slip would pass for the line.
TEST_F(SlipCorrectionTest, ItLastsWhileFrictionStillBendsE) {
  constexpr double kFriction = 0.5;  // m/s² by which the wheels come back to the ground's speed
  spin(0.5);
  body_.error = 0.02;
  go(2.0);
  while (correction_.active() && body_.left > 0) {
    go(SlidingBody::kStep);
    body_.left = body_.right = body_.left - kFriction * SlidingBody::kStep;
  }
  EXPECT_LE(body_.left, 1e-9) << "m/s of slip were left when it ended";
}

TEST_F(SlipCorrectionTest, AfterAStandTheLineIsThatOfNoSpeed) {
  slide_to_a_stand();
  ASSERT_LT(go(2), 0.6);
  const MotionDifference::Point& now = body_.detector.difference().last();
  EXPECT_NEAR(now.velocity.x + correction_.line_slope().x, 0, 1e-12);
  EXPECT_NEAR(now.velocity.y + correction_.line_slope().y, 0, 1e-12);
}

TEST_F(SlipCorrectionTest, EndsAfterTheLongestTime) {
  spin(0.5);
  EXPECT_NEAR(go(20), Tuning::kLongestSlide, 0.3);
  EXPECT_FALSE(correction_.active());
  EXPECT_TRUE(correction_.given_up());
  EXPECT_GT(std::hypot(corrected_.x, corrected_.y), 1);
}

// Where the accelerometer shakes, a slide of that length is none: the path is that of the wheels again.
TEST_F(SlipCorrectionTest, OnAShakenRobotItUndoesWhatItCorrected) {
  as_specified_ = false;
  spin(0.5);
  EXPECT_NEAR(go(20), Tuning::kLongestShakenSlide, 0.3);
  EXPECT_TRUE(correction_.given_up());
  EXPECT_NEAR(corrected_.x, 0, 1e-12);
  EXPECT_NEAR(corrected_.y, 0, 1e-12);
  EXPECT_GT(std::sqrt(variance_), 0.5) << "it may have been one";
}

TEST_F(SlipCorrectionTest, NothingFromBeforeThePoseWasSetIsUndone) {
  as_specified_ = false;
  spin(0.5);
  go(0.5);
  const Planar before = corrected_;
  ASSERT_GT(std::hypot(before.x, before.y), 0.1);
  body_.detector.begin_path();
  correction_.begin_path(body_.detector.difference());
  go(20);
  ASSERT_TRUE(correction_.given_up());
  EXPECT_NEAR(corrected_.x, before.x, 1e-12);
  EXPECT_NEAR(corrected_.y, before.y, 1e-12);
}

// It is proven 0.1 … 0.8 s after it began.
TEST_F(SlipCorrectionTest, NothingFromBeforeThePoseWasSetIsCorrectedByASlideThatIsProvenLater) {
  body_.left = body_.right = 0.5;
  while (!correction_.active()) {
    corrected_ = {};
    body_.detector.begin_path();
    go(SlidingBody::kStep);
  }
  EXPECT_LE(std::hypot(corrected_.x, corrected_.y), 0.5 * Tuning::kPointInterval * 1.1);
}

// Between two points of the differences.
TEST_F(SlipCorrectionTest, NothingFromBeforeAPoseThatIsSetInASlideIsCorrected) {
  body_.left = body_.right = 0.5;
  go(0.52);
  ASSERT_TRUE(correction_.active());
  corrected_ = {};
  body_.detector.begin_path();
  const double begin = body_.detector.difference().time();
  correction_.begin_path(body_.detector.difference());
  go(Tuning::kPointInterval - SlidingBody::kStep);
  const double since = body_.detector.difference().last().time - begin;
  ASSERT_GT(since, 0.3 * Tuning::kPointInterval);
  EXPECT_NEAR(std::hypot(corrected_.x, corrected_.y), 0.5 * since, 0.05 * since);
}

// One side alone that slips by u moves E by u/2 and W by u.
TEST(SlideContacts, BothSlipWhereOneAloneDoesNotExplainIt) {
  constexpr SlideContacts::Tolerance kTolerance{.path = 0.25, .turn = 0.02, .bend = 1};
  SlideContacts contacts;
  contacts.judge({.along = 0.3, .turn = 0.03}, {}, kTolerance);
  EXPECT_TRUE(contacts.both_slip());
  contacts.judge({.along = 0.3, .turn = 0.6}, {}, kTolerance);
  EXPECT_TRUE(contacts.slips[1] && !contacts.slips[0]);
}

// Friction would have stopped it: the body leans.
TEST_F(SlipCorrectionTest, ADriftOnRollingWheelsWithoutEndIsUndone) {
  go(0.5, 0, 1.0);
  ASSERT_TRUE(correction_.active());
  EXPECT_LT(go(2, 0, 0.3), Tuning::kLongestDrift + 0.1);
  EXPECT_TRUE(correction_.undone());
  EXPECT_NEAR(corrected_.x, 0, 1e-12);
  EXPECT_NEAR(corrected_.y, 0, 1e-12);
  EXPECT_GT(std::sqrt(variance_), 0.1) << "it may have been one";
}

TEST_F(SlipCorrectionTest, TheEndLeavesNoExcess) {
  spin(0.5);
  correction_.end();
  EXPECT_FALSE(correction_.active());
  EXPECT_EQ(correction_.excess_speed(), 0);
}

TEST_F(SlipCorrectionTest, SlidingSidewaysIsCorrectedAcross) {
  go(0.5, 0, 1.0);
  go(0.5);
  ASSERT_TRUE(correction_.active());
  EXPECT_NE(correction_.reasons() & kSlipSideways, 0u);
  EXPECT_NEAR(correction_.lateral_speed(), 0.5, 0.05);
  EXPECT_LT(error(), wheels_error() / 5);
}

}  // namespace
}  // namespace robot_control

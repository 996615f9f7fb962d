#include "control/legged/walk/walking_speed.h"

#include <algorithm>
#include <cmath>

#include "control/legged/ideal_legs.h"
#include "control/legged/walk/swing.h"

namespace robot_control::tests {

constexpr double kFound = 0.015;  // of a speed: it is found by bisection, and at some places of a swing alone

/// Returns the largest share of its speed limit that a joint has while the foot follows `path`, of 0 … 1, for `time` s.
/// It is infinite where the leg is too straight.
template <class Path>
double fastest_joint(const LegModel& robot, std::size_t leg, double time, const Path& path) {
  constexpr int kSteps = 200;
  double fastest = 0;
  LegAngles before;
  for (int k = 0; k <= kSteps; ++k) {
    const LegSolution solution = robot.legs[leg].kinematics.inverse(path(static_cast<double>(k) / kSteps));
    const LegKinematics& leg_at = robot.legs[leg].kinematics;
    if (solution.reach != FootReach::kReached || leg_at.stretch(solution.angles) > kLengthShare * leg_at.length())
      return std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; k > 0 && i < kLegJoints; ++i) {
      const auto axis = static_cast<Eigen::Index>(i);
      const double rate = std::abs(solution.angles[axis] - before[axis]) * kSteps / time;
      fastest = std::max(fastest, rate / robot.joints[kLegJoints * leg + i].velocity_limit);
    }
    before = solution.angles;
  }
  return fastest;
}

struct WalkingSpeedTest : testing::Test {
  /// Returns the velocity of a foot that stands, under a body with this speed on one axis.
  Eigen::Vector3d under(std::size_t leg, std::size_t axis, double speed) const {
    const Eigen::Vector3d& foot = stance.feet[leg];
    if (axis == 2) return -speed * Eigen::Vector3d::UnitZ().cross(foot);
    return -speed * Eigen::Vector3d::Unit(static_cast<Eigen::Index>(axis));
  }

  /// Returns what the joints need in a steady walk, either way.
  double steady(const Gait& gait, std::size_t axis, double speed) const {
    return std::max(steady_ahead(gait, axis, speed), steady_ahead(gait, axis, -speed));
  }

  double steady_ahead(const Gait& gait, std::size_t axis, double speed) const {
    double part = 0;
    for (std::size_t leg = 0; leg < kLegs; ++leg) {
      const Eigen::Vector3d& foot = stance.feet[leg];
      const Eigen::Vector3d moves = under(leg, axis, speed), half = gait.stance_time() / 2 * moves;
      const double swing = gait.swing_time();
      part = std::max(part, fastest_joint(robot, leg, gait.stance_time(), [&](double done) -> Eigen::Vector3d {
                        return foot + (2 * done - 1) * half;
                      }));
      part = std::max(part, fastest_joint(robot, leg, swing, [&](double done) -> Eigen::Vector3d {
                        const Eigen::Vector3d to = foot - half - swing * moves;
                        return swing_point(foot + half, to, foot.z() + gait.lift, done, swing).place +
                               done * swing * moves;
                      }));
    }
    return part;
  }

  /// Returns what they need, either way, at the end of the first stance after a change, where the phase of `last` wraps
  /// and `next` begins.
  double changed(const Gait& last, const Gait& next, std::size_t axis, double speed) const {
    return std::max(changed_ahead(last, next, axis, speed), changed_ahead(last, next, axis, -speed));
  }

  double changed_ahead(const Gait& last, const Gait& next, std::size_t axis, double speed) const {
    constexpr double kEnd = 0.002;  // s
    const double begin = next.begins_after(last);
    double part = 0;
    for (std::size_t leg = 0; leg < kLegs; ++leg) {
      const bool bears = next.bears(leg, begin);
      if (!bears && next.swung(leg, begin) == 0) continue;  // it swings at once; another one waits for its next swing
      const double stood = std::min(last.leg_phase(leg, 0), last.duty) * last.period - last.stance_time() / 2;
      const double stands = next.stance_time() + (bears ? 0 : next.period) - next.leg_phase(leg, begin) * next.period;
      const double until = stood + stands;
      part = std::max(part, fastest_joint(robot, leg, kEnd, [&](double done) -> Eigen::Vector3d {
                        return stance.feet[leg] + (until - kEnd + done * kEnd) * under(leg, axis, speed);
                      }));
    }
    return part;
  }

  LegModel robot = lopsided();
  NominalStance stance = nominal_stance(robot);
  Gaits gaits = [this] {
    Gaits result(kGaits.begin(), kGaits.end());
    for (Gait& gait : result) gait = gait_of(robot, stance, gait);
    return result;
  }();
};

/// m/s, of any gait.
double fastest(const LegModel& robot) {
  return 1.7 * std::sqrt(robot.leg_length() / kReferenceLeg);
}

TEST_F(WalkingSpeedTest, NoJointNeedsMoreThanItsPartAtTheSpeedsOfAGaitAndItsChanges) {
  const Speeds speeds = walking_speeds(robot, stance, gaits);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t gait = 1; gait < gaits.size(); ++gait) {
      const double low = (1 - kFound) * speeds[gait][axis], high = (1 + kFound) * speeds[gait][axis];
      EXPECT_GT(low, 0.1) << gaits[gait].name.data() << axis;
      EXPECT_LE(steady(gaits[gait], axis, low), kSpeedShare) << gaits[gait].name.data() << axis;
      double beyond = steady(gaits[gait], axis, high);
      for (std::size_t other = 1; other < gaits.size(); ++other) {
        if (speeds[other][axis] < speeds[gait][axis]) continue;  // that one bounds the change
        EXPECT_LE(changed(gaits[other], gaits[gait], axis, low), kSpeedShare)
            << gaits[gait].name.data() << axis << other;
        EXPECT_LE(changed(gaits[gait], gaits[other], axis, low), kSpeedShare)
            << gaits[gait].name.data() << axis << other;
        beyond = std::max(
            {beyond, changed(gaits[other], gaits[gait], axis, high), changed(gaits[gait], gaits[other], axis, high)});
      }
      if (axis == 0 && speeds[gait][axis] == fastest(robot)) continue;
      EXPECT_GT(beyond, kSpeedShare) << gaits[gait].name.data() << axis;
    }
    EXPECT_EQ(speeds[kStandGait][axis], kMinSpeed);
  }
}

TEST_F(WalkingSpeedTest, IsTheLargestToATwelveTimesHalvedRange) {
  constexpr double kFinest = 10.0 / (1 << 12);
  const LegUse use(robot, stance);
  for (const char* name : {"walking_trot", "crawl"}) {
    const Gait& gait =
        *std::ranges::find(gaits, std::string_view(name), [](const Gait& row) { return row.name.data(); });
    const WalkingTwist speeds = walking_speeds(robot, stance, {gait})[0];
    for (std::size_t axis = 0; axis < speeds.size(); ++axis) {
      const auto needs = [&](double speed) {
        double part = 0;
        for (const double sense : {1.0, -1.0}) {
          WalkingTwist twist{};
          twist[axis] = sense * speed;
          part = std::max({part, use.steady(gait, twist), use.changing(gait, gait, twist)});
        }
        return part;
      };
      EXPECT_LE(needs(speeds[axis]), kSpeedShare) << name << axis;
      EXPECT_GT(needs(speeds[axis] + kFinest), kSpeedShare) << name << axis;
    }
  }
}

TEST_F(WalkingSpeedTest, NoGaitIsFasterThanATrotKeepsItsBalance) {
  for (const double size : {1.0, 0.25}) {
    LegModel fast = sized(size);
    for (JointModel& joint : fast.joints) joint.velocity_limit = 1000;
    const NominalStance stands = nominal_stance(fast);
    Gait trot = gait_of(fast, stands, kGaits[gait_named("trot")]);
    trot.period /= 2;  // so that the legs reach
    EXPECT_EQ(walking_speeds(fast, stands, {trot})[0][0], fastest(fast));
  }
}

TEST_F(WalkingSpeedTest, AStepInPlaceIsLowerWhereItsJointsAreSlow) {
  const Gait trot = kGaits[gait_named("trot")].scaled(robot.leg_length());
  for (JointModel& joint : robot.joints) joint.velocity_limit = 1000;
  EXPECT_EQ(gait_of(robot, stance, trot).lift, trot.lift);
  const double needs = steady(trot, 0, 0);
  for (JointModel& joint : robot.joints) joint.velocity_limit *= needs / kLiftSpeedShare / 0.8;
  EXPECT_EQ(gait_of(robot, stance, trot).lift, trot.lift) << "0.8 of what is allowed";
  for (JointModel& joint : robot.joints) joint.velocity_limit *= 0.8 / 1.25;
  EXPECT_NEAR(gait_of(robot, stance, trot).lift, 0.8 * trot.lift, 0.01 * trot.lift);
}

TEST_F(WalkingSpeedTest, AnEmergencyEndsAWalkAfterTheSlowestAxisAndAPeriodOfTheCrawl) {
  constexpr double kTick = 0.001;  // s
  for (std::size_t slowest = 0; slowest < 3; ++slowest) {
    LegControllerParameters parameters;
    if (slowest == 0) parameters.max_linear_acceleration = 0.5;
    if (slowest == 1) parameters.max_lateral_acceleration = 0.1;
    if (slowest == 2) parameters.max_angular_acceleration = 0.5;
    const TwistLimiter limiter(twist_limits(parameters));
    TwistLimiter::State state;
    state.axes[0].speed = parameters.max_linear_speed;
    state.axes[1].speed = parameters.max_lateral_speed;
    state.axes[2].speed = parameters.max_angular_speed;
    double time = 0;
    for (WalkingTwist twist{1}; twist != WalkingTwist{}; time += kTick) {
      std::uint64_t reasons = 0;
      twist = limiter.step(state, {}, {100, 100, 100}, true, kTick, reasons);
    }
    for (const double size : {1.0, 0.25}) {
      const LegModel legs = sized(size);
      const double crawl = kGaits[gait_named("crawl")].period * std::sqrt(legs.leg_length() / kReferenceLeg);
      EXPECT_NEAR(walk_ending_time(parameters, legs), time + crawl + kAllDown, 3 * kTick) << slowest;
    }
  }
}

}  // namespace robot_control::tests

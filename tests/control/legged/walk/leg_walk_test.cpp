/// How a walk begins, chooses its gait, carries the body, and ends.

#include <algorithm>
#include <limits>

#include "control/legged/ideal_legs.h"
#include "control/legged/walk/own_gaits.h"

namespace robot_control::tests {

Request twist_of(double ahead, double left = 0, double turning = 0, const Mode& mode = {}) {
  Request request = stance_of(mode);
  request.twist = {.linear = {ahead, left, 0}, .angular = {0, 0, turning}};
  return request;
}

constexpr Mode mode_of(std::uint64_t gait) {
  return {ModeKind::kGait, gait};
}

/// A robot on level ground whose body has the twist and the pose of the last command. A foot that bears stays where it
/// is. A foot in the air is where its joints are commanded.
struct WalkingLegs {
  explicit WalkingLegs(const LegModel& robot = lopsided()) : legs(standing(robot)) {
    legs.has_estimate = true;
    legs.estimate.base.flags = kStateValid;
    height = -legs.foot_in_base(0).z();
    for (std::size_t leg = 0; leg < kLegs; ++leg) feet[leg] = at() * legs.foot_in_base(leg);
  }

  Eigen::Isometry3d at() const {
    const std::array<double, 6>& body = legs.out.legged.body;
    Eigen::Isometry3d pose = Eigen::Translation3d(place) * Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()) *
                             Eigen::AngleAxisd(body[4], Eigen::Vector3d::UnitY()) *
                             Eigen::AngleAxisd(body[3], Eigen::Vector3d::UnitX());
    pose.translation().z() += height + body[2];
    return pose;
  }

  bool walks() const { return legs.out.legged.phase == LegPhase::kWalking; }
  std::uint64_t gait() const { return legs.out.legged.gait; }
  double speed(std::size_t axis) const {
    return axis < 2 ? legs.out.twist_limited.linear[axis] : legs.out.twist_limited.angular[2];
  }

  void step() {
    if (walks()) follow();
    legs.step();
  }
  void step(const Request& wanted) {
    legs.request(wanted);
    step();
  }
  void run(double seconds, const Request& wanted) {
    legs.request(wanted);
    for (double time = 0; time < seconds - kCycle / 2; time += kCycle) step();
  }
  /// Returns after how many s the walk has ended; 5 if it has not.
  double end(const Request& wanted = {}) {
    legs.request(wanted);
    double time = 0;
    for (; time < 5 && walks(); time += kCycle) step();
    return time;
  }

  LegModel& robot() { return legs.robot; }

  IdealLegs legs;
  Eigen::Vector3d place = Eigen::Vector3d::Zero();   // m, of the base, but its height
  double heading = 0, height = 0;                    // rad; m
  std::array<Eigen::Vector3d, kLegs> feet{};         // m
  std::size_t caught = kLegs;                        // a foot that does not leave the ground; kLegs: none
  Eigen::Vector3d slides = Eigen::Vector3d::Zero();  // m/s, what the estimate adds to the twist

 private:
  void follow() {
    for (std::size_t leg = 0; leg < kLegs; ++leg)
      if (legs.out.contact_schedule[leg] == 0 && leg != caught) feet[leg] = at() * legs.foot_in_base(leg);
    const Eigen::Vector3d moves(speed(0), speed(1), 0);
    heading += speed(2) * kCycle;
    const Eigen::Matrix3d turned = Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    place += kCycle * turned * moves;
    const Eigen::Isometry3d pose = at();
    const Eigen::Quaterniond q(pose.rotation());
    BaseState& base = legs.estimate.base;
    base.attitude = {q.x(), q.y(), q.z(), q.w()};
    const Eigen::Matrix3d back = pose.rotation().transpose() * turned;
    Eigen::Map<Eigen::Vector3d>(base.twist_base.linear.data()) = back * (moves + slides);
    Eigen::Map<Eigen::Vector3d>(base.twist_base.angular.data()) = back * Eigen::Vector3d(0, 0, speed(2));
    for (std::size_t leg = 0; leg < kLegs; ++leg) {
      const bool bears = legs.out.contact_schedule[leg] > 0 || leg == caught;
      legs.estimate.contacts[leg].probability = bears ? 1 : 0;
      if (!bears) continue;
      feet[leg].z() = 0;  // the radius of the feet
      const LegAngles angles = robot().legs[leg].kinematics.inverse(pose.inverse() * feet[leg]).angles;
      for (std::size_t i = 0; i < kLegJoints; ++i)
        legs.sensors.joints[kLegJoints * leg + i].position = angles[static_cast<Eigen::Index>(i)];
    }
  }
};

/// Returns a robot that stands.
WalkingLegs ready() {
  static const WalkingLegs legs;
  return legs;
}

Speeds speeds_of(const LegModel& robot) {
  return walking_speeds(robot, nominal_stance(robot), Walker(robot, all_gaits({}), 0.4, kCycle).gaits());
}

TEST(LegWalk, FollowsATwistOnFeetThatAreBelowTheirHipsInTheMiddleOfTheirStance) {
  WalkingLegs legs = ready();
  legs.run(2, twist_of(0.4, 0.1));
  EXPECT_TRUE(legs.walks());
  EXPECT_EQ(legs.legs.out.reasons, 0u);
  EXPECT_NEAR(legs.speed(0), 0.4, 1e-9);
  EXPECT_NEAR(legs.speed(1), 0.1, 1e-9);
  const NominalStance stance = nominal_stance(legs.robot());
  int middles = 0;
  for (int i = 0; i < 200; ++i) {
    const ContactSchedule before = legs.legs.out.contact_schedule;
    legs.step();
    for (std::size_t leg = 0; leg < kLegs; ++leg) {
      if (before[leg] == 0 || before[leg] >= 0.5 || legs.legs.out.contact_schedule[leg] < 0.5) continue;
      ++middles;
      EXPECT_LE((legs.at().inverse() * legs.feet[leg] - stance.feet[leg]).norm(), 0.005) << leg;
    }
  }
  EXPECT_GE(middles, 8);
}

/// Legs of four times the length swing for twice the time, so that they are fast at twice the speed.
TEST(LegWalk, ChoosesATrotForFastFeetAndKeepsItUntilTheyAreSlow) {
  for (const double size : {1.0, 4.0}) {
    const WalkingLegs stands(sized(size));
    const NominalStance stance = nominal_stance(stands.legs.robot);
    double farthest = 0;
    for (const Eigen::Vector3d& foot : stance.feet)
      farthest = std::max(farthest, (foot - stance.equations.centre_of_gravity).head<2>().norm());
    const std::array<WalkingTwist, 4> ways{
        WalkingTwist{1, 0, 0}, {-0.87, 0.48, 0}, {0, 0, 1 / farthest}, {0.5, 0, -0.5 / farthest}};
    for (const WalkingTwist& way : ways) {
      WalkingLegs legs = stands;
      const auto walk = [&](double fast) {
        const double speed = fast * std::sqrt(size * 0.426 / kReferenceLeg);
        legs.run(1.2, twist_of(speed * way[0], speed * way[1], speed * way[2]));
        return legs.legs.state().walk.gait;
      };
      EXPECT_EQ(walk(0.25), gait_named("walking_trot"));
      EXPECT_EQ(walk(0.39), gait_named("walking_trot"));
      EXPECT_EQ(walk(0.41), gait_named("trot"));
      EXPECT_EQ(walk(0.31), gait_named("trot"));
      legs.step(twist_of(0.1 * way[0], 0.1 * way[1], 0.1 * way[2]));
      EXPECT_EQ(legs.legs.state().walk.gait, gait_named("trot")) << "the body is still fast";
      EXPECT_EQ(walk(0.29), gait_named("walking_trot"));
    }
  }
}

TEST(LegWalk, BeginsWithTheRequestedGait) {
  for (const std::uint64_t gait : {gait_named("trot"), gait_named("walking_trot"), gait_named("crawl")}) {
    WalkingLegs legs = ready();
    legs.step(stance_of(mode_of(gait)));
    EXPECT_EQ(legs.gait(), gait) << "in place, too";
    legs.run(1, twist_of(0.1, 0, 0, mode_of(gait)));
    EXPECT_EQ(legs.gait(), gait);
    EXPECT_TRUE(legs.walks());
  }
  for (const Mode& mode : {mode_of(kStandGait), mode_of(kGaits.size())}) {
    WalkingLegs legs = ready();
    legs.step(stance_of(mode));
    EXPECT_FALSE(legs.walks()) << mode.index;
    EXPECT_EQ(legs.legs.out.reasons, std::uint64_t{kReasonPartIgnored});
  }
}

TEST(LegWalk, ChangesToASlowerGaitWhenItsLegsCarryTheBody) {
  WalkingLegs legs = ready();
  const Speeds speeds = speeds_of(legs.robot());
  const double slow = speeds[gait_named("crawl")][0];
  legs.run(2, twist_of(0.9, 0, 0, mode_of(gait_named("trot"))));
  ASSERT_NEAR(legs.speed(0), 0.9, 1e-9);
  legs.step(twist_of(0.9, 0, 0, mode_of(gait_named("crawl"))));
  int cycles = 0;
  for (; legs.gait() == gait_named("trot") && cycles < 400; ++cycles) {
    EXPECT_NE(legs.legs.out.reasons & kReasonLegSpeed, 0u);
    legs.step();
  }
  EXPECT_LE(legs.speed(0), slow + 1e-6);
  legs.run(0.5, twist_of(0.9, 0, 0, mode_of(gait_named("crawl"))));
  EXPECT_NEAR(legs.speed(0), slow, 1e-6);
  legs.step(twist_of(0.9, 0, 0, mode_of(gait_named("trot"))));
  for (; legs.gait() == gait_named("crawl") && cycles < 800; ++cycles) {
    EXPECT_LE(legs.speed(0), slow + 1e-6) << "both gaits bound the speed until then";
    legs.step();
  }
  const double period = Walker(legs.robot(), all_gaits({}), 0.4, kCycle).gaits()[gait_named("trot")].period;
  legs.run(period - kCycle, twist_of(0.9, 0, 0, mode_of(gait_named("trot"))));
  EXPECT_NEAR(legs.speed(0), slow, 1e-6) << "feet still bear that the crawl had set down";
  legs.run(1, twist_of(0.9, 0, 0, mode_of(gait_named("trot"))));
  EXPECT_NEAR(legs.speed(0), 0.9, 1e-9);
}

TEST(LegWalk, EndsAfterAZeroOnFeetThatAreOnTheirPlaces) {
  WalkingLegs legs = ready();
  legs.run(1.5, twist_of(0.3, -0.1, 0.2));
  legs.legs.request({});
  double stood = 0, time = 0;
  for (; legs.walks() && time < 3; time += kCycle) {
    legs.step();
    stood += legs.walks() && legs.gait() == 0 ? kCycle : 0;
  }
  EXPECT_EQ(legs.legs.out.legged.phase, LegPhase::kStanding);
  EXPECT_LT(time, 1.2);
  EXPECT_NEAR(stood, kAllDown, 2 * kCycle) << "all feet stand for this time before";
  const Walker walker(legs.robot(), all_gaits({}), 0.4, kCycle);
  EXPECT_LT(walker.farthest_foot(walker.measure(legs.legs.sensors, legs.legs.estimate)),
            0.1 * legs.robot().leg_length());
  for (std::size_t i = 0; i < kLegsJoints; ++i)
    EXPECT_NEAR(legs.legs.out.joints[i].position, legs.legs.before.joints[i].position, 1e-3) << i;
  EXPECT_NEAR(legs.legs.pose()[2], nominal_height(legs.robot()), 1e-3);
  EXPECT_EQ(legs.legs.out.contact_schedule, (ContactSchedule{0.5, 0.5, 0.5, 0.5}));
  legs.run(1, {});
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(legs.legs.out.legged.body[i], 0, 1e-3) << i;
  EXPECT_EQ(legs.legs.out.reasons, 0u);
  legs.run(0.2, twist_of(0.3));
  EXPECT_TRUE(legs.walks()) << "it walks again";
}

/// Large knees meet the ground while the body sinks: it keeps the same margin before and after.
TEST(LegWalk, LeavesABodyThatSinksAsFarAsBefore) {
  LegModel robot = lopsided();
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const Eigen::Vector3d foot = nominal_stance(robot).feet[leg];
    const LegKinematics& kinematics = robot.legs[leg].kinematics;
    robot.legs[leg].knee_radius = kinematics.knee(kinematics.inverse(foot).angles).z() - foot.z() - 0.03;
  }
  WalkingLegs stood(robot), walked = stood;
  walked.run(1, stance_of(mode_of(gait_named("trot"))));
  ASSERT_TRUE(walked.walks());
  ASSERT_LT(walked.end(), 2);
  Request low;
  low.posture.height = -1;
  for (WalkingLegs* legs : {&stood, &walked}) legs->run(2, low);
  EXPECT_GT(stood.legs.out.legged.body[2], 0.01 - leg_tuning(robot).bob) << "the knees are in the way";
  EXPECT_NEAR(walked.legs.out.legged.body[2], stood.legs.out.legged.body[2], 5e-3) << "feet beside their places";
}

TEST(LegWalk, HoldsTheTiltWithWhichItStands) {
  WalkingLegs legs = ready();
  Request leans = twist_of(0.2);
  leans.posture = {.height = 0.02, .roll = 0.05, .pitch = -0.08};
  legs.run(2, leans);
  leans.twist = {};
  ASSERT_LT(legs.end(leans), 2);
  EXPECT_NEAR(legs.legs.pose()[2], nominal_height(legs.robot()) + 0.02, 1e-3);
  EXPECT_NEAR(legs.legs.pose()[3], 0.05, 1e-3);
  EXPECT_NEAR(legs.legs.pose()[4], -0.08, 1e-3);
  for (std::size_t i = 0; i < kLegsJoints; ++i)
    EXPECT_NEAR(legs.legs.out.joints[i].position, legs.legs.before.joints[i].position, 1e-3) << i;
}

TEST(LegWalk, DoesNotEndWhileTheBodyIsFast) {
  for (const double size : {0.5, 1.0, 2.0}) {
    const WalkingLegs stands(sized(size));
    for (const double speed : {0.29, 0.31}) {
      WalkingLegs legs = stands;
      legs.run(1, twist_of(0.2));
      legs.slides = speed * std::sqrt(size) * Eigen::Vector3d(0.6, -0.8, 0);
      EXPECT_EQ(legs.end() < 5, speed < 0.3) << size;
    }
  }
}

TEST(LegWalk, EndsAfterThreeSecondsWhereverTheFeetAre) {
  WalkingLegs legs = ready();
  legs.run(0.5, twist_of(0.05));
  legs.feet[1] += Eigen::Vector3d(0.02, -0.06, 0);
  legs.caught = 1;
  const double time = legs.end();
  EXPECT_GT(time, 3);
  EXPECT_LT(time, 3.7);
  EXPECT_EQ(legs.legs.out.legged.phase, LegPhase::kStanding);
}

TEST(LegWalk, LiesDownAfterItsEndIfThatIsTheLastRequest) {
  WalkingLegs legs = ready();
  legs.run(1, twist_of(0.3));
  WalkingLegs stays = legs, walks = legs;
  legs.step(stance_of({ModeKind::kLie}));
  EXPECT_LT(legs.end(), 2);
  legs.step();
  legs.step();
  EXPECT_EQ(legs.legs.out.legged.phase, LegPhase::kLowering);

  stays.step(stance_of({ModeKind::kLie}));
  EXPECT_LT(stays.end(stance_of({ModeKind::kStand})), 2);
  stays.run(0.1, {});
  EXPECT_EQ(stays.legs.out.legged.phase, LegPhase::kStanding);

  walks.step(stance_of({ModeKind::kLie}));
  walks.run(0.3, twist_of(0.3));
  EXPECT_LT(walks.end(), 2);
  walks.run(0.1, {});
  EXPECT_EQ(walks.legs.out.legged.phase, LegPhase::kStanding);
}

TEST(LegWalk, LiesDownAmidItsFeet) {
  WalkingLegs legs = ready();
  legs.run(0.5, twist_of(0.05));
  legs.feet[1] += Eigen::Vector3d(0.02, -0.06, 0);
  legs.caught = 1;
  legs.step(stance_of({ModeKind::kLie}));
  EXPECT_LT(legs.end(), 3.7);
  Eigen::Vector2d beside;
  while (legs.legs.out.legged.phase != LegPhase::kLying) {
    beside.setZero();
    for (std::size_t leg = 0; leg < kLegs; ++leg) {
      const Leg& model = legs.robot().legs[leg];
      beside += (legs.legs.foot_in_base(leg) - model.kinematics.position(model.lying)).head<2>() / kLegs;
    }
    legs.step();
  }
  EXPECT_LT(beside.norm(), 2e-3);
}

TEST(LegWalk, KeepsTheSpeedOfThePermitWithoutTurningTheTwist) {
  WalkingLegs legs = ready();
  legs.legs.permit.speed_limit = 0.2;
  legs.run(1.5, twist_of(0.3, -0.4, 0.1));
  EXPECT_NEAR(legs.speed(0), 0.12, 1e-9);
  EXPECT_NEAR(legs.speed(1), -0.16, 1e-9);
  EXPECT_NEAR(legs.speed(2), 0.04, 1e-9);
  EXPECT_EQ(legs.legs.out.reasons, std::uint64_t{kReasonPermitSlow});
  legs.run(1, twist_of(0.12, -0.16, 0.04));
  EXPECT_EQ(legs.legs.out.reasons, 0u);

  WalkingLegs held = ready();
  held.legs.permit.speed_limit = 0;
  held.run(0.5, twist_of(0.3));
  EXPECT_TRUE(held.walks());
  EXPECT_EQ(held.speed(0), 0);
  EXPECT_EQ(held.gait(), gait_named("trot")) << "in place";
}

TEST(LegWalk, TurnsBackSlowlyUntilTheFeetHaveLandedAnew) {
  WalkingLegs legs = ready();
  const double turning = 0.95 * speeds_of(legs.robot())[gait_named("crawl")][2];
  legs.run(3, twist_of(0, 0, -turning, mode_of(gait_named("crawl"))));
  EXPECT_EQ(legs.speed(2), -turning);
  EXPECT_EQ(legs.legs.out.reasons, 0u) << "a steady turn has reach";
  legs.legs.request(twist_of(0, 0, turning, mode_of(gait_named("crawl"))));
  std::uint64_t reasons = 0;
  for (double time = 0; time < 1; time += kCycle) {
    legs.step();
    reasons |= legs.legs.out.reasons;
  }
  EXPECT_NE(reasons & kReasonLegSpeed, 0u);
  legs.run(2, twist_of(0, 0, turning, mode_of(gait_named("crawl"))));
  EXPECT_EQ(legs.speed(2), turning);
  EXPECT_EQ(legs.legs.out.reasons, 0u);
}

TEST(LegWalk, BrakesHarderInAnEmergency) {
  const MotionLimits limits = twist_limits({})[0];
  const auto hardest = [&](const auto& happens) {
    WalkingLegs legs = ready();
    legs.run(1.5, twist_of(0.9));
    happens(legs.legs);
    double deceleration = 0;
    for (int i = 0; i < 400 && legs.speed(0) > 0; ++i) {
      const double before = legs.speed(0);
      legs.step();
      deceleration = std::max(deceleration, (before - legs.speed(0)) / kCycle);
    }
    EXPECT_EQ(legs.speed(0), 0);
    return deceleration;
  };
  Request broken = twist_of(std::nan(""));
  EXPECT_NEAR(hardest([](IdealLegs& legs) { legs.request({}); }), limits.deceleration, 1e-6);
  EXPECT_GT(hardest([&](IdealLegs& legs) { legs.request(broken); }), 0.999 * limits.emergency_deceleration);
  EXPECT_GT(hardest([](IdealLegs& legs) { legs.inbox.many_senders = 1; }), 0.999 * limits.emergency_deceleration);
  EXPECT_GT(hardest([](IdealLegs& legs) { legs.permit.action = PermitAction::kRamp; }),
            0.999 * limits.emergency_deceleration);
}

TEST(LegWalk, NeedsAStateOfThisCycle) {
  const auto lose = [](int what, IdealLegs& legs) {
    if (what == 0) legs.has_estimate = false;
    if (what == 1) legs.estimate.base.flags = kStateSlip;
  };
  for (const int what : {0, 1}) {
    WalkingLegs begins = ready();
    lose(what, begins.legs);
    begins.run(0.1, twist_of(0.3));
    EXPECT_EQ(begins.legs.out.legged.phase, LegPhase::kStanding);
    WalkingLegs legs = ready();
    legs.run(0.5, twist_of(0.3));
    lose(what, legs.legs);
    legs.step();
    EXPECT_EQ(legs.legs.out.reasons, std::uint64_t{kReasonNoState});
    EXPECT_EQ(legs.legs.out.legged.phase, LegPhase::kLying);
    for (std::size_t i = 0; i < kLegsJoints; ++i) EXPECT_EQ(legs.legs.out.joints[i].mode, JointMode::kBrake) << i;
    for (int i = 0; i < 19; ++i) legs.step();
    legs.legs.has_estimate = true;
    legs.legs.estimate.base.flags = kStateValid;
    legs.step();
    EXPECT_EQ(legs.legs.out.legged.phase, LegPhase::kWalking) << "it goes on";
  }
  WalkingLegs legs = ready();
  legs.run(0.5, twist_of(0.3));
  ++legs.legs.sensors.head.cycle;
  CommandFrame out;
  legs.legs.controller.step({.sensors = &legs.legs.sensors,
                             .state = &legs.legs.estimate,
                             .permit = &legs.legs.permit,
                             .request = legs.legs.inbox},
                            out);
  EXPECT_EQ(out.reasons, std::uint64_t{kReasonNoState}) << "it is of another cycle";
}

TEST(LegWalk, CarriesTheBodyWithinHalfOfItsRanges) {
  WalkingLegs legs = ready();
  const LegTuning tuning = leg_tuning(legs.robot());
  Request request = twist_of(0.2);
  request.posture = {.height = -0.01, .roll = 0.1, .pitch = -0.05};
  legs.run(1.5, request);
  EXPECT_EQ(legs.legs.out.reasons, 0u);
  EXPECT_NEAR(legs.legs.out.legged.body[2], -0.01, 1e-4);
  EXPECT_NEAR(legs.legs.out.legged.body[3], 0.1, 1e-4);
  EXPECT_NEAR(legs.legs.out.legged.body[4], -0.05, 1e-4);
  request.posture = {.height = -1, .roll = -1, .pitch = 1};
  legs.run(1.5, request);
  EXPECT_EQ(legs.legs.out.reasons, std::uint64_t{kReasonOutOfReach});
  EXPECT_NEAR(legs.legs.out.legged.body[2], -0.5 * tuning.bob, 1e-4);
  EXPECT_NEAR(legs.legs.out.legged.body[3], -0.5 * tuning.lean / std::sqrt(2), 1e-4);
  EXPECT_NEAR(legs.legs.out.legged.body[4], 0.5 * tuning.lean / std::sqrt(2), 1e-4);
}

/// A raised body stretches the legs, which then carry less speed.
TEST(LegWalk, AsksForNoMoreSpeedThanTheLegsCarryInThePoseInForce) {
  WalkingLegs legs = ready();
  const LegTuning tuning = leg_tuning(legs.robot());
  Request request = twist_of(1.5, 0, 0, mode_of(gait_named("trot")));
  legs.run(2, request);
  EXPECT_NEAR(legs.speed(0), 1.5, 1e-6);
  const LegUse use(legs.robot(), nominal_stance(legs.robot()));
  const Gait trot = gait_of(legs.robot(), nominal_stance(legs.robot()), kGaits[gait_named("trot")]);
  request.posture = {.height = 0.4 * tuning.bob, .pitch = 0.08};
  legs.run(3, request);
  EXPECT_LT(legs.speed(0), 1.45);
  EXPECT_GT(legs.speed(0), 0.3);
  const CarriedBody body{request.posture.height, 0, request.posture.pitch};
  EXPECT_LE(use.steady(trot, {legs.speed(0), 0, 0}, body, 8), kSpeedShare + 1e-9);
  EXPECT_GT(use.steady(trot, {1.06 * legs.speed(0), 0, 0}, body, 8), kSpeedShare);
  EXPECT_EQ(legs.legs.out.reasons & ~std::uint64_t{kReasonAccelerationLimited}, std::uint64_t{kReasonLegSpeed});
  EXPECT_NEAR(legs.legs.out.legged.body[2], body[0], 1e-3);
  EXPECT_NEAR(legs.legs.out.legged.body[4], body[2], 1e-3);
}

/// Joints of half of their speed bound a walk before the legs are too short for it.
TEST(LegWalk, NoJointIsFasterThanItsPartWhileTheBodyLeansAndAfterwards) {
  LegModel slow = lopsided();
  for (JointModel& joint : slow.joints) joint.velocity_limit *= 0.5;
  const NominalStance stance = nominal_stance(slow);
  const LegUse use(slow, stance);
  const Gait trot = gait_of(slow, stance, kGaits[gait_named("trot")]);
  WalkingLegs legs(slow);
  Request request = twist_of(1.5, 0, 0, mode_of(gait_named("trot")));
  legs.run(2, request);
  request.posture = {.height = 0, .roll = -0.1, .pitch = 0.1};
  legs.legs.request(request);
  const auto& [height, roll, pitch] = legs.legs.state().walk.carried;
  for (double time = 0; time < 1; time += kCycle) {
    const double before = roll.value;
    legs.step();
    if (roll.value == before) continue;
    EXPECT_LE(use.steady(trot, {legs.speed(0), 0, 0}, {height.value, roll.value, pitch.value}, 8,
                         {height.speed, roll.speed, pitch.speed}),
              kSpeedShare + 1e-9)
        << time;
  }
  EXPECT_NEAR(roll.value, -0.1, 1e-4);
  EXPECT_NEAR(pitch.value, 0.1, 1e-4);
  const auto used = [&](double speed) { return use.steady(trot, {speed, 0, 0}, {0, -0.1, 0.1}, 8); };
  EXPECT_LE(used(legs.speed(0)), kSpeedShare + 1e-9);
  EXPECT_GT(used(1.06 * legs.speed(0)), kSpeedShare);
  EXPECT_LT(used(1.06 * legs.speed(0)), 1.1 * kSpeedShare) << "the legs are long enough";
}

/// The search among all parts takes longer.
TEST(LegWalk, ThePartOfATwistChangesByAStepPerCycleWhileThePoseAloneMoves) {
  constexpr double kPartStep = 1.0 / 32;
  for (const double from : {0.0, 1.0}) {
    WalkingLegs legs = ready();
    Request request = twist_of(1.5, 0, 0, mode_of(gait_named("trot")));
    legs.run(1.5, request);
    request.posture = {.height = 0.03, .roll = -0.1, .pitch = -0.1};
    legs.run(2 * kCycle, request);
    LegController::State state = legs.legs.state();
    ASSERT_GT(state.walk.carried_twist.part, 4 * kPartStep);
    ASSERT_LT(state.walk.carried_twist.part, 1 - 4 * kPartStep);
    state.walk.carried_twist.part = from;
    legs.legs.controller.set_state(state);
    for (int steps = 1; steps <= 4; ++steps) {
      legs.step();
      EXPECT_EQ(legs.legs.state().walk.carried_twist.part, std::abs(from - steps * kPartStep));
    }
  }
}

/// Two feet bear in a trot and three in a crawl. So weak legs carry less of a pose in a trot.
TEST(LegWalk, TakesOfAPoseWhatTheLegsCarryInTheGaitOfNow) {
  LegModel weak = lopsided();
  for (JointModel& joint : weak.joints) joint.effort_limit *= 0.49;
  for (std::size_t leg = 0; leg < kLegs; ++leg) weak.joints[kLegJoints * leg].effort_limit *= 0.68;
  const NominalStance stance = nominal_stance(weak);
  const LegUse use(weak, stance);
  const auto used = [&](std::uint64_t gait, const WalkingTwist& twist, const CarriedBody& body) {
    return use.steady(gait_of(weak, stance, kGaits[gait]), twist, body, 8) / kSpeedShare;
  };
  const LegTuning tuning = leg_tuning(weak);
  const CarriedBody whole{0.5 * tuning.bob, 0, 0.5 * tuning.lean};
  ASSERT_LT(used(gait_named("crawl"), {}, whole), 0.75);
  ASSERT_GT(used(gait_named("trot"), {}, whole), 0.75);
  WalkingLegs legs(weak);
  Request request = stance_of(mode_of(gait_named("crawl")));
  request.posture = {.height = whole[0], .roll = 0, .pitch = whole[2]};
  legs.run(2, request);
  EXPECT_EQ(legs.legs.out.reasons, 0u);
  request.mode = mode_of(gait_named("trot"));
  legs.run(3, request);
  EXPECT_EQ(legs.gait(), gait_named("trot"));
  EXPECT_EQ(legs.legs.out.reasons, std::uint64_t{kReasonOutOfReach});
  WalkingLegs trots(weak);
  trots.run(1, request);
  EXPECT_EQ(legs.legs.state().walk.lean_target, trots.legs.state().walk.lean_target) << "as without the crawl";
}

TEST(LegWalk, BeginsWithThePoseInWhichItStands) {
  WalkingLegs legs = ready();
  Request pose;
  pose.posture = {.height = -0.02, .roll = 0.04, .pitch = 0.03};
  legs.run(1, pose);
  pose.twist = twist_of(0.2).twist;
  legs.step(pose);
  legs.step();
  ASSERT_TRUE(legs.walks());
  EXPECT_NEAR(legs.legs.out.legged.body[2], -0.02, 1e-3);
  EXPECT_NEAR(legs.legs.out.legged.body[3], 0.04, 1e-3);
  EXPECT_NEAR(legs.legs.out.legged.body[4], 0.03, 1e-3);
}

TEST(LegWalk, StandsWhereItIsAfterFourPlansThatFail) {
  WalkingLegs legs = ready();
  legs.run(0.5, twist_of(0.2));
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  LegController slippery(legs.robot(), {.friction = kNone}, kCycle);  // no force is within this friction
  slippery.set_state(legs.legs.state());
  legs.legs.controller = slippery;
  std::uint64_t failures = 0;
  for (int i = 0; i < 60 && legs.legs.state().phase == LegPhase::kWalking; ++i) {
    legs.step();
    failures = std::max(failures, legs.legs.state().walk.walker.failures);
  }
  EXPECT_EQ(legs.legs.state().phase, LegPhase::kStanding);
  EXPECT_EQ(failures, Walker::kFailures + 1);
  EXPECT_NE(legs.legs.out.reasons & kReasonNoPlan, 0u);
}

TEST(LegWalk, SetsAFootDownFirst) {
  WalkingLegs legs = ready();
  legs.run(2, stance_of({ModeKind::kLift, 1}));
  ASSERT_NE(legs.legs.out.legged.lifted, 0u);
  legs.step(twist_of(0.2));
  int cycles = 0;
  for (; !legs.walks() && cycles < 600; ++cycles) legs.step();
  EXPECT_GT(cycles, 20);
  EXPECT_TRUE(legs.walks());
}

}  // namespace robot_control::tests

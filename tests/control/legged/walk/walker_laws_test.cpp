/// The laws of a walk, each over random states whose sensors and estimate fit each other.

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <random>

#include "control/legged/ideal_legs.h"
#include "control/legged/posture/ground_slope.h"
#include "control/legged/walk/foothold.h"
#include "control/legged/walk/own_gaits.h"
#include "control/legged/walk/swing.h"
#include "control/legged/walk/walker.h"

namespace robot_control::tests {

constexpr double kMillisecond = 0.001;  // s
constexpr double kMu = 0.3;             // other than the default
constexpr double kExact = 1e-9;         // of m, rad and their rates
constexpr double kLimitShare = 0.97;    // of the effort limits
constexpr double kTargetAway = 0.2;     // m, of a leg of kReferenceLeg
constexpr unsigned kRandomStates = 40;

using Vectors = std::array<Eigen::Vector3d, kLegs>;

Eigen::Vector3d vector(const Vector3& array) {
  return Eigen::Map<const Eigen::Vector3d>(array.data());
}

Vector3 array(const Eigen::Vector3d& vector) {
  return {vector.x(), vector.y(), vector.z()};
}

Eigen::Matrix3d about(const Eigen::Vector3d& axis, double angle) {
  return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
}

Eigen::Matrix3d tilt(double roll, double pitch) {
  return about(Eigen::Vector3d::UnitY(), pitch) * about(Eigen::Vector3d::UnitX(), roll);
}

/// Returns a robot without symmetry, whose feet are balls of different radii.
LegModel on_balls() {
  LegModel robot = lopsided();
  for (std::size_t leg = 0; leg < kLegs; ++leg) robot.legs[leg].foot_radius = 0.02 + 0.002 * static_cast<double>(leg);
  return robot;
}

struct WalkerLaws : testing::Test {
  WalkerLaws() {
    sensors.joint_count = kLegsJoints;
    for (ContactState& contact : estimate.contacts) contact.probability = 1;
    put(stance.feet);
    walker.begin(state, sensors, estimate);
  }

  const Gait& gait(std::uint64_t index) const { return walker.gaits()[index]; }
  const Gait& gait() const { return walker.gaits()[state.gait]; }
  double uniform(double range) { return std::uniform_real_distribution<>(-range, range)(random); }
  Eigen::Vector3d around(double range) { return {uniform(range), uniform(range), uniform(range)}; }

  /// Puts the feet to these places in level axes, with the body at this attitude.
  void put(const Vectors& feet, double roll = 0, double pitch = 0, double yaw = 0) {
    turned = tilt(roll, pitch);
    const Eigen::Quaterniond q(about(Eigen::Vector3d::UnitZ(), yaw) * turned);
    estimate.base.attitude = {q.x(), q.y(), q.z(), q.w()};
    for (std::size_t leg = 0; leg < kLegs; ++leg) {
      const LegAngles angles = robot.legs[leg].kinematics.inverse(turned.transpose() * feet[leg]).angles;
      for (std::size_t i = 0; i < kLegJoints; ++i) {
        JointSample& joint = sensors.joints[kLegJoints * leg + i];
        joint = {.position = angles[static_cast<Eigen::Index>(i)], .valid = kValidKinematics};
      }
    }
  }

  /// Walks somewhere amid a phase: no foot begins or ends its swing in the next cycles.
  void choose(unsigned seed) {
    random.seed(seed);
    Vectors feet = stance.feet;
    for (Eigen::Vector3d& foot : feet) foot += around(0.03);
    put(feet, uniform(0.1), uniform(0.1), uniform(3));
    for (std::size_t i = 0; i < kLegsJoints; ++i) sensors.joints[i].velocity = uniform(1);
    estimate.base.twist_base = {array(around(0.4)), array(around(0.4))};
    state = {};
    state.gait = 1 + seed % 3;
    const auto ends_soon = [this](std::size_t leg) {
      const double part = gait().leg_phase(leg, state.phase), margin = 0.02;
      return std::abs(part - gait().duty) < margin || part < margin || part > 1 - margin;
    };
    do {
      state.phase = 0.5 + uniform(0.45);
    } while (ends_soon(0) || ends_soon(1) || ends_soon(2) || ends_soon(3));
    for (std::size_t leg = 0; leg < kLegs; ++leg) {
      state.swings[leg] = gait().bears(leg, state.phase) ? 0 : 1;
      state.bears[leg] = 1 - state.swings[leg];
      state.footprints[leg] = state.departs[leg] = array(feet[leg] + around(0.02));
      estimate.contacts[leg].probability = uniform(1) > 0 ? 0.5 : 0.49;
      if (state.swings[leg] != 0) estimate.contacts[leg].probability = 0;
      state.touch_places[leg] = array(feet[leg] + around(0.001));
      state.forces[leg] = {uniform(10), uniform(10), 40 + uniform(30)};
    }
    for (double& axis : state.target) axis = uniform(0.05);
    for (double& axis : state.follows) axis = uniform(0.4);
    state.ground = {stance.feet[0].z() + uniform(0.01), uniform(0.1), uniform(0.1)};
    input.twist = {uniform(0.5), uniform(0.3), uniform(0.5)};
    input.body[0] = uniform(0.02);
    input.body[1] = uniform(0.1);
    input.body[2] = uniform(0.1);
    input.gait = state.gait;
    before = state;
  }

  /// Legs 1 and 2 have done this part of their swing, without a contact.
  void choose_swing(double part) {
    choose(0);
    state.swings = {0, 1, 1, 0};
    state.bears = {1, 0, 0, 1};
    state.phase = gait().duty + part * (1 - gait().duty) - gait().phase[1];
    estimate.contacts = {};
  }

  bool step() {
    out = {};
    before = state;
    input.sensors = &sensors;
    input.state = &estimate;
    return walker.step(state, input, out);
  }

  WalkingBody body() const { return walker.measure(sensors, estimate); }

  LeggedEquations equations() const {
    LeggedMotion motion{.linear = vector(estimate.base.twist_base.linear),
                        .angular = vector(estimate.base.twist_base.angular),
                        .gravity = turned.transpose() * Eigen::Vector3d(0, 0, -kGravity)};
    for (std::size_t i = 0; i < kLegsJoints; ++i) {
      motion.angles[i] = sensors.joints[i].position;
      motion.rates[i] = sensors.joints[i].velocity;
    }
    LeggedEquations result;
    LegDynamics(robot).step(motion, result);
    return result;
  }

  LegAngles angles(std::size_t leg) const {
    const JointSample* joint = &sensors.joints[kLegJoints * leg];
    return {joint[0].position, joint[1].position, joint[2].position};
  }

  Eigen::Vector3d foot(std::size_t leg) const { return turned * robot.legs[leg].kinematics.position(angles(leg)); }

  /// Returns height and slopes of the ground on which the feet bore last. Feet that are less than a tenth of a leg
  /// apart show no slope: this is least squares with two more rows.
  Eigen::Vector3d ground_of(const std::array<Vector3, kLegs>& bore) const {
    Eigen::Matrix<double, 6, 3> places = Eigen::Matrix<double, 6, 3>::Zero();
    Eigen::Matrix<double, 6, 1> heights = Eigen::Matrix<double, 6, 1>::Zero();
    for (std::size_t leg = 0; leg < kLegs; ++leg) {
      const auto row = static_cast<Eigen::Index>(leg);
      places.row(row) << 1, bore[leg][0], bore[leg][1];
      heights[row] = bore[leg][2] - robot.legs[leg].foot_radius;
    }
    places(4, 1) = places(5, 2) = 0.1 * robot.leg_length();
    return places.colPivHouseholderQr().solve(heights);
  }

  double ground_below(const Eigen::Vector3d& place) const {
    return state.ground[0] + state.ground[1] * place.x() + state.ground[2] * place.y();
  }

  /// Returns the height of the centre of gravity above the ground in the nominal stance.
  double nominal_centre() const {
    double height = stance.equations.centre_of_gravity.z();
    for (std::size_t leg = 0; leg < kLegs; ++leg)
      height -= (stance.feet[leg].z() - robot.legs[leg].foot_radius) / kLegs;
    return height;
  }

  /// Returns the place of a foot's centre where it lands.
  Eigen::Vector3d landing(std::size_t leg) const {
    const Eigen::Vector3d centre = turned * equations().centre_of_gravity;
    const FootholdInput at{.nominal = (stance.feet[leg] - stance.equations.centre_of_gravity).head<2>(),
                           .requested = {input.twist[0], input.twist[1]},
                           .measured = velocity_of_centre().head<2>(),
                           .yaw_rate = input.twist[2],
                           .until_landing = gait().period * (1 - gait().leg_phase(leg, state.phase)),
                           .stance_time = gait().stance_time(),
                           .height = nominal_centre() + input.body[0],
                           .leg_length = robot.leg_length()};
    Eigen::Vector3d place(0, 0, 0);
    place.head<2>() = centre.head<2>() + foothold(at);
    place.z() = ground_below(place) + robot.legs[leg].foot_radius;
    return place;
  }

  Eigen::Vector3d velocity_of_centre() const {
    const Eigen::Vector3d linear = vector(estimate.base.twist_base.linear);
    const Eigen::Vector3d angular = vector(estimate.base.twist_base.angular);
    return turned * (linear + angular.cross(equations().centre_of_gravity));
  }

  LegModel robot = on_balls();
  NominalStance stance = nominal_stance(robot);
  Walker walker{robot, all_gaits({}), kMu, kMillisecond};
  Walker::State state, before;
  WalkInput input;
  SensorFrame sensors;
  StateFrame estimate;
  Eigen::Matrix3d turned = Eigen::Matrix3d::Identity();
  CommandFrame out;
  std::mt19937 random;
};

TEST_F(WalkerLaws, MeasuresTheBodyInLevelAxesOfItsHeading) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    choose(seed);
    const WalkingBody measured = body();
    const LeggedEquations expected = equations();
    const Eigen::Vector3d rate = turned * vector(estimate.base.twist_base.angular);
    EXPECT_LE((measured.turned - turned).norm(), kExact);
    EXPECT_LE((measured.velocity - turned * vector(estimate.base.twist_base.linear)).norm(), kExact);
    EXPECT_LE((measured.rate - rate).norm(), kExact);
    EXPECT_LE((measured.centre - turned * expected.centre_of_gravity).norm(), kExact);
    EXPECT_LE((measured.moves - velocity_of_centre()).norm(), kExact);
    EXPECT_LE((tilt(measured.roll, measured.pitch) - turned).norm(), kExact);
    EXPECT_LE((measured.equations.mass - expected.mass).norm(), kExact);
    EXPECT_LE((measured.equations.bias - expected.bias).norm(), kExact);
    for (std::size_t leg = 0; leg < kLegs; ++leg) {
      Eigen::Vector3d place;
      EXPECT_LE((measured.feet[leg] - foot(leg)).norm(), kExact);
      EXPECT_EQ(measured.jacobians[leg], robot.legs[leg].kinematics.jacobian(angles(leg), place));
    }
    for (std::size_t i = 0; i < kLegsJoints; ++i) EXPECT_EQ(measured.angles[i], sensors.joints[i].position);
  }
}

TEST_F(WalkerLaws, BeginsOnAllFeetAndOnThePlaneThroughThem) {
  choose(1);
  state.failures = state.planned = 1;
  walker.begin(state, sensors, estimate);
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    EXPECT_EQ(state.bears[leg], 1u);
    EXPECT_EQ(state.swings[leg], 0u);
    EXPECT_LE((vector(state.footprints[leg]) - foot(leg)).norm(), kExact);
  }
  EXPECT_LE((vector(state.ground) - ground_of(state.footprints)).norm(), kExact);
  EXPECT_EQ(state.gait, kStandGait);
  EXPECT_EQ(state.phase, 0);
  EXPECT_EQ(state.failures, 0u);
  EXPECT_EQ(state.target, (std::array<double, 3>{}));
  step();
  EXPECT_EQ(state.planned, 0u) << "the first cycle plans";
}

TEST_F(WalkerLaws, WhatIsKeptInLevelAxesMovesAgainstTheBody) {
  for (unsigned seed = 0; seed < kRandomStates; ++seed) {
    choose(seed);
    const WalkingBody now = body();
    step();
    for (std::size_t leg = 0; leg < kLegs; ++leg) {
      const auto moved = [&](const Vector3& place) -> Eigen::Vector3d {
        const Eigen::Vector3d turns = now.rate.z() * Eigen::Vector3d::UnitZ().cross(vector(place));
        return vector(place) - kMillisecond * (now.velocity + turns);
      };
      const bool touches = estimate.contacts[leg].probability >= 0.5, stands = before.bears[leg] != 0 && touches;
      const Eigen::Vector3d bore = stands ? foot(leg) : moved(before.footprints[leg]);
      const Eigen::Vector3d met = touches ? moved(before.touch_places[leg]) : foot(leg);
      EXPECT_LE((vector(state.footprints[leg]) - bore).norm(), kExact) << leg;
      EXPECT_LE((vector(state.touch_places[leg]) - met).norm(), kExact) << leg;
    }
    const double part = kMillisecond / (gait().period / 2);
    const std::array<double, 3> moves{now.velocity.x(), now.velocity.y(), now.rate.z()};
    for (std::size_t i = 0; i < 3; ++i) {
      const double follows = i < 2 ? before.follows[i] + part * (input.twist[i] - before.follows[i]) : input.twist[i];
      EXPECT_NEAR(state.follows[i], follows, kExact) << i;
      EXPECT_NEAR(state.target[i], before.target[i] + kMillisecond * (follows - moves[i]), kExact) << i;
    }
    Eigen::Vector3d ground = vector(before.ground) - Eigen::Vector3d(kMillisecond * now.velocity.z(), 0, 0);
    ground += kMillisecond / 0.05 * (ground_of(state.footprints) - ground);
    EXPECT_LE((vector(state.ground) - ground).norm(), kExact);
  }
}

TEST_F(WalkerLaws, TheTargetStaysNearTheRobot) {
  const double farthest = kTargetAway * robot.leg_length() / kReferenceLeg;
  for (const double sense : {1.0, -1.0}) {
    choose(0);
    estimate.base.twist_base = {};
    input.twist = {5 * sense, -5 * sense, 5 * sense};
    for (int i = 0; i < 300; ++i) step();
    EXPECT_EQ(state.target, (std::array<double, 3>{farthest * sense, -farthest * sense, 0.3 * sense}));
  }
}

/// The model is written from walker.h and force_plan.h.
TEST_F(WalkerLaws, PlansTheForcesOfItsFeetFromWhereItIsToItsTarget) {
  ForcePlanParameters parameters =
      force_plan_parameters(LegDynamics(robot).mass(), stance.inertia(), robot.leg_length());
  parameters.friction = kMu;
  ForcePlan plan(parameters);
  for (unsigned seed = 0; seed < kRandomStates; ++seed) {
    choose(seed);
    state.planned = Walker::plan_cycles(kMillisecond) - 1;
    const std::size_t early = seed % kLegs;  // this foot has met the ground before the end of its swing
    if (state.swings[early] != 0) state.bears[early] = 1;
    step();
    ASSERT_EQ(state.planned, 0u);
    const WalkingBody now = body();
    ForcePlanInput to{.ground = ground_axes(state.ground[1], state.ground[2])};
    to.place << now.roll, now.pitch, 0, 0, 0, now.centre.z() - ground_below(now.centre);
    to.speed << now.rate, now.moves;
    to.target << input.body[1] + std::atan(state.ground[2]), input.body[2] - std::atan(state.ground[1]),
        state.target[2], state.target[0], state.target[1],
        (nominal_centre() + input.body[0]) * std::hypot(1, state.ground[1], state.ground[2]);
    to.target_speed << 0, 0, input.twist[2], input.twist[0], input.twist[1], 0;
    to.steps = gait().duty > 0.7 ? 6 : gait().duty > 0.55 ? 8 : 10;
    const double part = parameters.horizon / static_cast<double>(to.steps);
    for (std::size_t leg = 0; leg < kLegs; ++leg) {
      const bool bears = state.bears[leg] != 0, swings = !gait().bears(leg, state.phase);
      const double lands = gait().period * (1 - gait().leg_phase(leg, state.phase));
      to.feet[leg] = (bears ? foot(leg) : landing(leg)) - now.centre;
      to.feet[leg].z() -= robot.legs[leg].foot_radius;
      to.bears[0][leg] = bears;
      for (std::size_t i = 1; i < to.steps; ++i) {
        const double amid = (static_cast<double>(i) + 0.5) * part;
        to.bears[i][leg] = (bears && swings && amid < lands) || gait().bears(leg, state.phase + amid / gait().period);
      }
    }
    const ForcePlanResult expected = plan.step(to);
    ASSERT_EQ(expected.outcome, QpOutcome::kSolved);
    for (std::size_t leg = 0; leg < kLegs; ++leg)
      EXPECT_LE((vector(state.forces[leg]) - expected.forces[leg]).norm(), 1e-6) << seed << " leg " << leg;
  }
}

TEST_F(WalkerLaws, PlansEveryTenCyclesAndWhereOtherFeetBear) {
  choose(0);
  estimate.contacts = {};
  state.phase =
      gait().duty - gait().phase[1] - 5.5 * kMillisecond / gait().period;  // leg 1 lifts off in the sixth cycle
  std::vector<int> planned;
  state.planned = Walker::plan_cycles(kMillisecond) - 1;
  for (int i = 0; i < 30; ++i) {
    step();
    if (state.planned == 0) planned.push_back(i);
  }
  EXPECT_EQ(planned, (std::vector<int>{0, 5, 15, 25}));
}

TEST_F(WalkerLaws, AStandingRobotWalksAtOnceAndCountsHowLongItStands) {
  input.gait = kStandGait;
  for (int i = 0; i < 3; ++i) step();
  EXPECT_NEAR(state.lasted, 3 * kMillisecond, kExact);
  EXPECT_EQ(state.gait, 0u);
  EXPECT_EQ(out.contact_schedule, (ContactSchedule{0.5, 0.5, 0.5, 0.5}));
  input.gait = gait_named("trot");
  step();
  EXPECT_EQ(out.legged.gait, gait_named("trot"));
  EXPECT_EQ(out.legged.gait_phase, 0);
}

TEST_F(WalkerLaws, ThePhaseGrowsByACycleOfThePeriodAndAnotherGaitBeginsWhereItWraps) {
  for (const std::uint64_t next : {gait_named("trot"), gait_named("walking_trot")}) {
    choose(next == gait_named("trot") ? 1 : 0);
    const auto now = state.gait;
    const double cycle = kMillisecond / gait().period;
    state.lasted = gait().period;
    state.phase = 0.9 - cycle / 2;
    ASSERT_NE(now, static_cast<std::uint64_t>(next));
    input.gait = next;
    int cycles = 0;
    for (; state.gait == now && cycles < 1000; ++cycles) {
      EXPECT_NEAR(state.phase, 0.9 + (cycles - 0.5) * cycle, kExact);
      step();
    }
    EXPECT_EQ(cycles, std::ceil(0.1 / cycle + 0.5));
    EXPECT_LT(state.phase, cycle);
    EXPECT_EQ(state.gait, static_cast<std::uint64_t>(next));
  }
}

TEST_F(WalkerLaws, AGaitLastsForAPeriodBeforeAnotherBegins) {
  choose(0);
  state.gait = gait_named("crawl");
  state.phase = gait().begin;
  state.lasted = 0;
  const auto now = state.gait;
  const double until_wrap = (1 - gait().begin) * gait().period, period = gait().period;
  input.gait = gait_named("trot");
  int cycles = 0;
  for (; state.gait == now && cycles < 3000; ++cycles) step();
  EXPECT_NEAR(cycles * kMillisecond, until_wrap + period, 2 * kMillisecond);
  EXPECT_EQ(state.lasted, 0);
}

/// A foot is near where it left the ground within one and a half cycles of its swing.
TEST_F(WalkerLaws, EndsInTheFirstCycleInWhichNoFootIsFarFromWhereItLeftTheGround) {
  for (unsigned seed = 0; seed < 12; ++seed) {
    choose(seed);
    const auto now = state.gait;
    const Gait& walked = gait();
    const auto farthest = [&](double phase) {
      double swung = 0;
      for (std::size_t leg = 0; leg < kLegs; ++leg) swung = std::max(swung, walked.swung(leg, phase));
      return swung * walked.swing_time();
    };
    input.gait = kStandGait;
    int cycles = 0;
    double phase = state.phase;
    for (; state.gait == now && cycles < 1200; ++cycles) {
      step();
      phase = before.phase + kMillisecond / walked.period;
      if (state.gait == now) {
        EXPECT_GE(farthest(phase), 1.5 * kMillisecond - kExact) << "it could have ended";
      }
    }
    EXPECT_LT(farthest(phase), 1.5 * kMillisecond + kExact);
    EXPECT_EQ(state.gait, kStandGait) << cycles;
    EXPECT_EQ(state.phase, 0);
    EXPECT_EQ(state.lasted, 0);
    EXPECT_EQ(state.target, (std::array<double, 3>{}));
    for (const std::uint64_t bears : state.bears) EXPECT_EQ(bears, 1u);
  }
}

TEST_F(WalkerLaws, AFootSwingsFromWhereItIsWhenItsSwingBeginsUntilItsStance) {
  choose(0);
  const double cycle = kMillisecond / gait().period;
  state.phase = gait().duty - gait().phase[1] - 1.5 * cycle;
  step();
  EXPECT_EQ(state.bears[1], 1u);
  EXPECT_GT(out.contact_schedule[1], 0.99);
  step();
  EXPECT_EQ(state.bears[1], 0u);
  EXPECT_EQ(out.contact_schedule[1], 0);
  EXPECT_LE((vector(state.footprints[1]) - foot(1)).norm(), kExact);
  state.phase = 1 - gait().phase[1] - 1.5 * cycle;
  step();
  EXPECT_EQ(state.bears[1], 0u);
  step();
  EXPECT_EQ(state.bears[1], 1u) << "it bears by the clock, with or without a contact";
  EXPECT_EQ(state.swings[1], 0u);
  EXPECT_NEAR(out.contact_schedule[1], 0.5 * cycle / gait().duty, kExact);
}

TEST_F(WalkerLaws, AFootWhoseSwingWouldHaveBegunBeforeTheGaitStandsUntilItsNextOne) {
  OwnGaits own;
  own[0] = {.name = "late", .period = 0.5, .duty = 0.6, .phases = NumberList<4>{0.8, 0.1, 0.1, 0.1}, .lift = 0.05};
  walker = Walker(robot, all_gaits(own), kMu, kMillisecond);
  walker.begin(state, sensors, estimate);
  input.gait = kGaits.size();
  int cycles = 0;
  for (step(); state.bears[0] != 0 && cycles < 1000; ++cycles) step();
  EXPECT_NEAR(cycles * kMillisecond, 0.8 * gait().period, 2 * kMillisecond);
}

TEST_F(WalkerLaws, AFootThatMeetsTheGroundInTheSecondHalfOfItsSwingBearsFromThenOn) {
  for (const double swung : {0.3, 0.6}) {
    choose_swing(swung);
    estimate.base.twist_base = {};  // each foot stays where it is
    estimate.contacts[1].probability = 0.5;
    for (int i = 0; i < 3; ++i) step();
    estimate.contacts[1].probability = 0.49;  // a load as noisy as this is no contact
    step();
    estimate.contacts[1].probability = 0.5;
    for (int i = 0; i < 4; ++i) step();
    EXPECT_EQ(state.bears[1], 0u);
    for (int i = 0; i < 2; ++i) step();
    EXPECT_EQ(state.bears[1], swung > 0.5 ? 1u : 0u);
    EXPECT_EQ(state.bears[2], 0u) << "it has no contact";
    if (swung < 0.5) continue;
    EXPECT_LE(state.planned, 1u) << "other feet bear";
    EXPECT_EQ(out.contact_schedule[1], kMillisecond) << "its stance has not begun";
    estimate.contacts[1].probability = 0;
    step();
    EXPECT_EQ(state.bears[1], 1u);
  }
}

TEST_F(WalkerLaws, AFootThatMovesOverTheGroundHasNotMetIt) {
  for (const double speed : {0.5, 0.8}) {  // 2.5 and 4 mm within the time for which it has to touch
    choose_swing(0.6);
    estimate.base.twist_base = {.linear = {0, speed, 0}, .angular = {}};
    estimate.contacts[1].probability = 1;
    for (int i = 0; i < 12; ++i) step();
    EXPECT_EQ(state.bears[1], speed < 0.6 ? 1u : 0u);
  }
}

TEST_F(WalkerLaws, ReportsThePartOfTheStanceThatAFootHasDone) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    choose(seed);
    step();
    EXPECT_EQ(out.legged.gait, state.gait);
    EXPECT_EQ(out.legged.gait_phase, state.phase);
    for (std::size_t leg = 0; leg < kLegs; ++leg) {
      const bool bears = gait().bears(leg, state.phase);
      EXPECT_NEAR(out.contact_schedule[leg], bears ? gait().leg_phase(leg, state.phase) / gait().duty : 0, kExact);
    }
  }
}

/// With τ = h − p Jᵀ f, p is the largest part of the force within the limits; 0 if h alone exceeds one. The impedance
/// of a swing turns a joint back that would come nearer than 0.03 rad to an end of its range.
TEST_F(WalkerLaws, AFootThatStandsBearsItsForceUnlessAJointIsTooWeak) {
  int weak = 0, strong = 0, overloaded = 0, turned_back = 0;
  for (const double limit : {1000.0, 6.0, 0.3}) {
    for (JointModel& joint : robot.joints) joint.effort_limit = limit;
    stance = nominal_stance(robot);  // weak knees stand higher
    walker = Walker(robot, all_gaits({}), kMu, kMillisecond);
    const LegTuning tuning = leg_tuning(robot);
    for (unsigned seed = 0; seed < kRandomStates; ++seed) {
      choose(seed);
      step();
      const WalkingBody now = body();
      for (std::size_t leg = 0; leg < kLegs; ++leg) {
        if (state.bears[leg] == 0) continue;
        const Eigen::Vector3d own = equations().bias.segment<3>(static_cast<Eigen::Index>(6 + 3 * leg));
        const Eigen::Vector3d force = turned.transpose() * vector(state.forces[leg]);
        const Eigen::Vector3d load = -now.jacobians[leg].transpose() * force;
        double part = 1;
        for (Eigen::Index i = 0; i < 3; ++i) {
          const double end = load[i] > 0 ? kLimitShare * limit : -kLimitShare * limit;
          part = std::min(part, std::max(0.0, (end - own[i]) / load[i]));
        }
        (part == 1 ? strong : part == 0 ? overloaded : weak)++;
        for (std::size_t i = 0; i < kLegJoints; ++i) {
          const auto axis = static_cast<Eigen::Index>(i);
          const JointCommand& joint = out.joints[kLegJoints * leg + i];
          EXPECT_EQ(joint.mode, JointMode::kImpedance);
          EXPECT_EQ(joint.position, angles(leg)[axis]);
          EXPECT_EQ(joint.velocity, 0);
          EXPECT_EQ(joint.stiffness, 0);
          EXPECT_EQ(joint.damping, 0);
          const JointRange& range = robot.legs[leg].kinematics.range(i);
          const double ahead = angles(leg)[axis] + tuning.damping / tuning.stiffness * now.rates[kLegJoints * leg + i];
          const double stop = tuning.stiffness * (std::clamp(ahead, range.lower + 0.03, range.upper - 0.03) - ahead);
          turned_back += stop != 0 ? 1 : 0;
          const double largest = kLimitShare * limit;
          EXPECT_NEAR(joint.effort, std::clamp(own[axis] + part * load[axis] + stop, -largest, largest), kExact)
              << seed << " leg " << leg << " of " << limit;
        }
      }
    }
  }
  EXPECT_GT(weak, 20);
  EXPECT_GT(strong, 20);
  EXPECT_GT(overloaded, 5);
  EXPECT_GT(turned_back, 20);
}

TEST_F(WalkerLaws, AFootInTheAirFollowsItsPathToTheFoothold) {
  unsigned swinging = 0;
  for (const double limit : {1000.0, 0.3}) {
    for (JointModel& joint : robot.joints) joint.effort_limit = limit;
    stance = nominal_stance(robot);  // weak knees stand higher
    walker = Walker(robot, all_gaits({}), kMu, kMillisecond);
    for (unsigned seed = 0; seed < kRandomStates; ++seed) {
      choose(seed);
      step();
      const LegTuning tuning = leg_tuning(robot);
      const LeggedEquations now = equations();
      const Eigen::Matrix3d back = turned.transpose();
      for (std::size_t leg = 0; leg < kLegs; ++leg) {
        if (state.bears[leg] != 0) continue;
        const Eigen::Vector3d from = vector(state.departs[leg]), to = landing(leg);
        const double top = std::max(from.z(), to.z()) + gait().lift, left = 1 - state.departed[leg];
        const double part = (gait().leg_phase(leg, state.phase) - gait().duty) / (1 - gait().duty);
        const SwingPoint point =
            swing_point(from, to, top, (part - state.departed[leg]) / left, left * gait().swing_time());
        const LegKinematics& kinematics = robot.legs[leg].kinematics;
        const LegSolution solution = kinematics.inverse(back * point.place);
        bool reaches = solution.reach == FootReach::kReached;
        for (std::size_t i = 0; i < kLegJoints; ++i) {
          const JointRange& range = kinematics.range(i);
          const double angle = solution.angles[static_cast<Eigen::Index>(i)];
          reaches = reaches && std::min(angle - range.lower, range.upper - angle) >= kFromEnd;
        }
        if (!reaches) continue;
        ++swinging;
        const JointCommand* joint = &out.joints[kLegJoints * leg];
        const LegAngles commanded(joint[0].position, joint[1].position, joint[2].position);
        Eigen::Vector3d place;
        const Eigen::Matrix3d jacobian = robot.legs[leg].kinematics.jacobian(commanded, place);
        const Eigen::Vector3d rates(joint[0].velocity, joint[1].velocity, joint[2].velocity);
        const Eigen::Vector3d moves = body().velocity + body().rate.cross(point.place);
        const Eigen::Vector3d accelerations = jacobian.inverse() * back * point.acceleration;
        const auto row = static_cast<Eigen::Index>(6 + kLegJoints * leg);
        const Eigen::Vector3d efforts = now.mass.block<3, 3>(row, row) * accelerations + now.bias.segment<3>(row);
        EXPECT_LE((turned * place - point.place).norm(), kExact) << seed << " leg " << leg;
        EXPECT_LE((turned * jacobian * rates + moves - point.velocity).norm(), kExact) << seed << " leg " << leg;
        for (std::size_t i = 0; i < kLegJoints; ++i) {
          const double effort = efforts[static_cast<Eigen::Index>(i)];
          EXPECT_EQ(joint[i].mode, JointMode::kImpedance);
          EXPECT_EQ(joint[i].stiffness, tuning.stiffness);
          EXPECT_EQ(joint[i].damping, tuning.damping);
          EXPECT_NEAR(joint[i].effort, std::clamp(effort, -kLimitShare * limit, kLimitShare * limit), 1e-7);
        }
      }
    }
  }
  EXPECT_GT(swinging, kRandomStates);
}

TEST_F(WalkerLaws, KnowsThePartOfATwistThatKeepsEachFootInReachUntilItsSwing) {
  unsigned shortened = 0;
  for (unsigned seed = 0; seed < kRandomStates; ++seed) {
    choose(seed);
    input.sensors = &sensors;
    const WalkingTwist& twist = input.twist = {uniform(2), uniform(1), uniform(3)};
    const double part = walker.reachable_part(state, input);
    const auto too_long = [&](double of_twist) {
      double farthest = -1;
      for (std::size_t leg = 0; leg < kLegs; ++leg) {
        if (state.bears[leg] == 0) continue;
        const LegKinematics& kinematics = robot.legs[leg].kinematics;
        const double time = gait().period * (gait().duty - gait().leg_phase(leg, state.phase));
        const Eigen::Vector3d place = tilt(input.body[1], input.body[2]) * kinematics.position(angles(leg));
        const Eigen::Vector3d moves(twist[0] - twist[2] * place.y(), twist[1] + twist[2] * place.x(), 0);
        const Eigen::Vector3d ends = place - of_twist * time * moves;
        const LegSolution end = kinematics.inverse(tilt(input.body[1], input.body[2]).transpose() * ends);
        const double longest = std::max(0.95 * kinematics.length(), kinematics.stretch(angles(leg)));
        farthest = std::max(farthest, end.reach == FootReach::kReached ? kinematics.stretch(end.angles) - longest : 1);
      }
      return farthest;
    };
    EXPECT_LE(too_long(part), kExact) << seed;
    if (part == 1) continue;
    EXPECT_GT(too_long(part + 1.0 / 64), 0) << seed;
    ++shortened;
  }
  EXPECT_GT(shortened, kRandomStates / 4);
  EXPECT_LT(shortened, kRandomStates);
  state = {};
  input.twist = {9, 9, 9};
  EXPECT_EQ(walker.reachable_part(state, input), 1) << "before the first swing";
}

TEST_F(WalkerLaws, KnowsTheFootThatIsFarthestFromItsPlace) {
  put(stance.feet);
  EXPECT_NEAR(walker.farthest_foot(body()), 0, 1e-6);
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    WalkingBody moved = body();
    moved.feet[leg] += Eigen::Vector3d(0.03, -0.04, 0.5);
    moved.feet[(leg + 1) % kLegs].x() += 0.02;
    EXPECT_NEAR(walker.farthest_foot(moved), 0.05, 1e-6) << leg;
  }
}

}  // namespace robot_control::tests

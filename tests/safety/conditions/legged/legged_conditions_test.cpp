/// The conditions of robots on legs: a robot that stands, one number of which is wrong.

#include "safety/conditions/legged/legged_conditions.h"

#include <deque>
#include <numbers>
#include <random>

#include "machine/legs/legs_corpus.h"
#include "signals/names.h"

namespace robot_control::tests {

/// Quadbot stands: joints, forces of its feet and its command are those of the healthy case.
struct LeggedConditionsTest : testing::Test {
  LeggedConditionsTest() {
    for (std::size_t leg = 0; leg < kLegs; ++leg) {
      const LegKinematics& kinematics = robot_.legs[leg].kinematics;
      stand_[leg] = kinematics.position(robot_.legs[leg].lying);
      stand_[leg].z() -= 0.15;
      sensors_.contacts[leg] = {.force = {0, 0, robot_.mass * 9.81 / kLegs}, .valid = 1};
    }
    sensors_.joint_count = kLegsJoints;
    sensors_.contact_count = kLegs;
    sensors_.valid = kValidGyro | kValidAccelerometer;
    sensors_.imu.linear_acceleration = {0, 0, 9.81};
    sensors_.gate.verdict = GateVerdict::kPassed;
    set_joints_valid(sensors_, kValidMotion);
    command_.legged.phase = LegPhase::kStanding;
    place(stand_);
    run(0.3);
  }

  void place(const std::array<Eigen::Vector3d, kLegs>& feet) {
    for (std::size_t leg = 0; leg < kLegs; ++leg) {
      const LegAngles angles = robot_.legs[leg].kinematics.inverse(feet[leg]).angles;
      for (std::size_t i = 0; i < kLegJoints; ++i)
        sensors_.joints[kLegJoints * leg + i].position = angles[static_cast<Eigen::Index>(i)];
    }
  }

  /// Returns the time in s after which a cause was active, or `seconds`.
  double run(double seconds, const std::function<void(double)>& change = {}) {
    for (double t = 0; t < seconds; t += kPeriod) {
      if (change) change(t);
      sensors_.imu.angular_velocity = {rate_[0] + 1e-6 * t, rate_[1], rate_[2]};  // every sample is another one
      sensors_.imu.linear_acceleration[0] = 1e-3 * t;
      active_.clear();
      conditions_.step({.sensors = &sensors_, .command = &command_, .state = state_}, 1, 0, active_);
      if (active_.with(Reaction::kBrake) + active_.with(Reaction::kRamp) + active_.with(Reaction::kWarn) != 0) return t;
    }
    return seconds;
  }
  /// As robots/quadruped.cpp sets them.
  static SafetyParameters limits(const LegModel& robot) {
    SafetyParameters safety = legged_limits({}, robot);
    safety.lift.reaction = Reaction::kOff;
    return safety;
  }
  std::string causes(Reaction reaction) const { return names_of(kStopCauseNames, active_.with(reaction)); }
  std::uint64_t joint() const { return active_.measurements()[0].joint; }

  static constexpr double kPeriod = 0.001;  // s
  LegModel robot_ = legged_robot("quadbot");
  LeggedConditions conditions_{limits(robot_), robot_, kPeriod};
  SensorFrame sensors_;
  CommandFrame command_;
  const StateFrame* state_ = nullptr;
  ActiveCauses active_;
  std::array<Eigen::Vector3d, kLegs> stand_;
  Eigen::Vector3d rate_ = Eigen::Vector3d::Zero();  // rad/s, of the gyro
};

TEST_F(LeggedConditionsTest, StandAfterATenthOfASecondAndDoNotMoveBeforeThat) {
  conditions_.enter_run();
  run(0.0995);  // 100 cycles, of which the first one takes the angles
  EXPECT_FALSE(conditions_.standing());
  EXPECT_FALSE(conditions_.moving());
  run(0.0025);
  EXPECT_TRUE(conditions_.standing());
  EXPECT_FALSE(conditions_.sliding());
}

TEST_F(LeggedConditionsTest, AJointThatLeavesItsWindowMovesUntilTheRobotStandsAgain) {
  sensors_.joints[11].position += 0.009;
  run(0.01);
  EXPECT_TRUE(conditions_.standing());
  sensors_.joints[11].position += 0.002;
  run(0.095);
  EXPECT_TRUE(conditions_.moving());
  EXPECT_FALSE(conditions_.standing());
  run(0.01);
  EXPECT_TRUE(conditions_.standing());
  EXPECT_FALSE(conditions_.moving());
}

/// Go2 lies with 0.1 rad on level ground, and with 0.45 rad on a slope of 20°. A robot on its side has 1.57 rad on
/// level ground. While it gathers its legs or moves them one by one, it lies as well.
TEST_F(LeggedConditionsTest, ALyingRobotIsTiltedTooFarHalfWayToItsSide) {
  for (const double limit : {0.42, 0.8, 1.2}) {
    SafetyParameters safety = limits(robot_);
    safety.tilt.limit = limit;
    conditions_ = LeggedConditions(safety, robot_, kPeriod);
    const auto tilted = [&](LegPhase phase, double tilt) {
      conditions_.enter_run();
      command_.legged.phase = phase;
      const double seen = run(0.2, [&](double) {
        sensors_.imu.linear_acceleration[1] = 9.81 * std::sin(tilt);
        sensors_.imu.linear_acceleration[2] = 9.81 * std::cos(tilt);
      });
      return seen < 0.2;
    };
    EXPECT_FALSE(tilted(LegPhase::kStanding, 0.45)) << "it stands on a slope";
    EXPECT_TRUE(tilted(LegPhase::kStanding, std::max(limit, std::numbers::pi / 4) + 0.02)) << limit;
    for (const LegPhase phase : {LegPhase::kLying, LegPhase::kGathering, LegPhase::kJoints}) {
      EXPECT_FALSE(tilted(phase, 0.45));
      EXPECT_TRUE(tilted(phase, std::max(limit, std::numbers::pi / 4) + 0.02)) << limit;
      EXPECT_TRUE(tilted(phase, std::numbers::pi / 2)) << limit;
    }
  }
}

TEST_F(LeggedConditionsTest, AJointWithoutAnAngleMoves) {
  sensors_.joints[11].position = std::numeric_limits<double>::quiet_NaN();
  run(0.002);
  EXPECT_TRUE(conditions_.moving());
}

TEST_F(LeggedConditionsTest, AreNoneWhileItStandsAndMovesItsBody) {
  // Sway, height and turn at 0.5 Hz: the feet move together in the base's axes.
  const double seen = run(4, [&](double t) {
    const double s = std::sin(3.14 * t);
    const Eigen::Matrix3d turn =
        (Eigen::AngleAxisd(0.25 * s, Eigen::Vector3d::UnitX()) * Eigen::AngleAxisd(0.2 * s, Eigen::Vector3d::UnitZ()))
            .toRotationMatrix();
    std::array<Eigen::Vector3d, kLegs> feet;
    for (std::size_t leg = 0; leg < kLegs; ++leg)
      feet[leg] = turn * stand_[leg] + Eigen::Vector3d(0.03, 0.02, 0.02) * s;
    place(feet);
  });
  EXPECT_EQ(seen, 4) << causes(Reaction::kBrake) << causes(Reaction::kRamp) << causes(Reaction::kWarn);
}

TEST_F(LeggedConditionsTest, AJointThatIsTooFastBrakes) {
  sensors_.joints[4].velocity = -1.2 * robot_.joints[4].velocity_limit;
  EXPECT_NEAR(run(1), 0.049, 1e-6);
  EXPECT_EQ(causes(Reaction::kBrake), "joint_speed");
  EXPECT_EQ(joint(), 4u);
  EXPECT_NEAR(active_.measurements()[0].value, 1.2, 1e-9);
}

// Measured speeds come in counts: of twelve joints there is often one that shows a count more than its limit.
TEST_F(LeggedConditionsTest, JointsBeyondTheirLimitsByTurnsAreNoStop) {
  command_.legged.phase = LegPhase::kLying;
  const SensorFrame healthy = sensors_;
  const auto beyond = [&](double t, std::size_t joints) {
    sensors_ = healthy;
    const std::size_t i = static_cast<std::size_t>(std::lround(t / kPeriod)) % joints;
    sensors_.joints[i].velocity = 1.2 * robot_.joints[i].velocity_limit;
    sensors_.joints[i].effort = 0.95 * robot_.joints[i].effort_limit;
  };
  EXPECT_EQ(run(2, [&](double t) { beyond(t, 2); }), 2) << causes(Reaction::kBrake) << causes(Reaction::kRamp);
  conditions_.enter_run();
  EXPECT_NEAR(run(2, [&](double t) { beyond(t, 1); }), 0.049, 1e-6);
  // Two hips are beyond their end stops by turns, where a hand turns them to and fro.
  sensors_ = healthy;
  const double upper = robot_.joints[0].range->upper;
  EXPECT_EQ(run(2,
                [&](double t) {
                  const double s = 0.015 * std::sin(80 * t);
                  sensors_.joints[0].position = upper + 0.1 + s;
                  sensors_.joints[3].position = upper + 0.1 - s;
                  if (t == 0) conditions_.enter_run();
                }),
            2)
      << causes(Reaction::kBrake);
}

// A body that a late loop let down for some cycles meets the ground. Nothing else hit it.
TEST_F(LeggedConditionsTest, TheBlowOfItsOwnFoldIsNoImpact) {
  const auto shaken = [&](double braked, double hit) {
    conditions_.enter_run();
    sensors_.imu.linear_acceleration[1] = 0;
    run(0.8);
    return run(1, [&, braked, hit](double t) {
      sensors_.gate.verdict = t < braked ? GateVerdict::kBrake : GateVerdict::kPassed;
      const bool now = t > hit && t < hit + 0.02;
      sensors_.imu.linear_acceleration[1] = now ? 100 : 0;
    });
  };
  EXPECT_NEAR(shaken(0.0005, 0.2), 0.21, 0.005) << "a body that brakes for a cycle does not fold";
  EXPECT_EQ(shaken(0.011, 0.2), 1) << causes(Reaction::kBrake);
  EXPECT_NEAR(shaken(0.011, 0.6), 0.61, 0.005);
  EXPECT_EQ(causes(Reaction::kBrake), "impact");
  EXPECT_NEAR(shaken(-1, 0.2), 0.21, 0.005);
}

TEST_F(LeggedConditionsTest, ANumberThatIsMissingIsNotEvaluated) {
  command_.joints[3] = {.mode = JointMode::kImpedance, .position = sensors_.joints[3].position};
  sensors_.joints[3] = {.position = 100, .velocity = 1000, .effort = 1000};
  EXPECT_EQ(run(2), 2);
}

TEST_F(LeggedConditionsTest, AJointThatIsNoneOfTheLegsIsNotEvaluated) {
  sensors_.joint_count = kLegsJoints + 1;
  JointSample& held = sensors_.joints[kLegsJoints];
  held.position = held.velocity = held.effort = 1e9;
  EXPECT_EQ(run(1), 1);
}

TEST_F(LeggedConditionsTest, AContactThatIsNoFootIsNotEvaluated) {
  sensors_.contact_count = kLegs + 1;
  sensors_.contacts[kLegs] = {.force = {}, .valid = 1};
  EXPECT_EQ(run(1), 1);
}

TEST_F(LeggedConditionsTest, ANewRunBeginsEachPersistenceAgain) {
  const auto restarted = [&](double persistence) {
    run(0.8 * persistence);
    conditions_.enter_run();
    return run(1);
  };
  sensors_.joints[4].velocity = 1.2 * robot_.joints[4].velocity_limit;
  EXPECT_NEAR(restarted(0.05), 0.049, 1e-6);
  sensors_.joints[4].velocity = 0;
  sensors_.contacts[1].force = {};
  EXPECT_NEAR(restarted(0.5), 0.499, 1e-6);
}

TEST_F(LeggedConditionsTest, AJointThatGivesItsTorqueForLongLetsItLieDown) {
  sensors_.joints[5].effort = 0.95 * robot_.joints[5].effort_limit;
  EXPECT_EQ(run(0.9), 0.9);
  sensors_.joints[5].effort = 0;
  EXPECT_EQ(run(0.1), 0.1);
  sensors_.joints[5].effort = -0.95 * robot_.joints[5].effort_limit;
  EXPECT_NEAR(run(2), 0.999, 1e-6);
  EXPECT_EQ(causes(Reaction::kRamp), "joint_effort");
  EXPECT_EQ(joint(), 5u);
  EXPECT_NEAR(active_.measurements()[0].value, 0.95, 1e-9);
}

TEST_F(LeggedConditionsTest, AJointBeyondItsEndStopBrakes) {
  command_.legged.phase = LegPhase::kLying;
  sensors_.joints[0].position = robot_.joints[0].range->upper + 0.09;
  conditions_.enter_run();  // the joint did not turn there at once
  EXPECT_EQ(run(0.2), 0.2);
  sensors_.joints[0].position = robot_.joints[0].range->upper + 0.11;
  EXPECT_NEAR(run(1), 0.049, 1e-6);
  EXPECT_EQ(causes(Reaction::kBrake), "joint_range");
  EXPECT_EQ(joint(), 0u);
  EXPECT_NEAR(active_.measurements()[0].value, 0.11, 1e-9);
  sensors_.joints[0].position = robot_.joints[0].range->lower - 0.12;
  run(0.001);
  EXPECT_NEAR(active_.measurements()[0].value, 0.12, 1e-9);
}

TEST_F(LeggedConditionsTest, AJointThatDoesNotFollowItsCommandBrakesWhileTheRobotStands) {
  for (std::size_t i = 0; i < kLegsJoints; ++i)
    command_.joints[i] = {.mode = JointMode::kImpedance, .position = sensors_.joints[i].position};
  command_.joints[7].position -= 0.24;
  EXPECT_EQ(run(0.5), 0.5);
  command_.joints[7].position -= 0.02;
  command_.legged.phase = LegPhase::kRising;
  EXPECT_EQ(run(0.5), 0.5);
  command_.legged.phase = LegPhase::kStanding;
  EXPECT_NEAR(run(1), 0.199, 1e-6);
  EXPECT_EQ(causes(Reaction::kBrake), "joint_following");
  EXPECT_EQ(joint(), 7u);
  EXPECT_NEAR(active_.measurements()[0].value, 0.26, 1e-9);
  command_.joints[7].mode = JointMode::kVelocity;
  EXPECT_EQ(run(0.3), 0.3);
}

TEST_F(LeggedConditionsTest, AJointFarFromItsCommandBrakesBeforeItThrowsTheRobotOver) {
  for (std::size_t i = 0; i < kLegsJoints; ++i)
    command_.joints[i] = {.mode = JointMode::kImpedance, .position = sensors_.joints[i].position};
  const double angle = sensors_.joints[7].position;
  const auto count = [&](double t) {
    sensors_.joints[7].position = angle + (std::lround(t / kPeriod) % 2 == 0 ? 0 : 1e-4);  // it is not stuck
  };
  for (const LegPhase phase : {LegPhase::kGathering, LegPhase::kRising, LegPhase::kLowering, LegPhase::kStanding}) {
    command_.legged.phase = phase;
    command_.joints[7].position = angle - (phase == LegPhase::kStanding ? 0.24 : 0.74);
    EXPECT_EQ(run(0.5, count), 0.5);
    command_.joints[7].position = angle - 2;  // eight times the limit
    EXPECT_NEAR(run(1, count), 0.024, 1e-6);
    EXPECT_EQ(causes(Reaction::kBrake), "joint_following");
    EXPECT_EQ(joint(), 7u);
  }
}

TEST_F(LeggedConditionsTest, AnEncoderThatJumpsBrakes) {
  command_.legged.phase = LegPhase::kLying;
  const double reach = 1.1 * robot_.joints[7].velocity_limit * kPeriod;
  sensors_.joints[7].position += 0.1 + 0.99 * reach;
  EXPECT_EQ(run(0.3), 0.3);
  // It is beyond its reach in each of five cycles.
  sensors_.joints[7].position -= 0.1 + 5.01 * reach;
  EXPECT_NEAR(run(1), 0.004, 1e-6);
  EXPECT_EQ(causes(Reaction::kBrake), "encoder_jump");
  EXPECT_EQ(joint(), 7u);
}

TEST_F(LeggedConditionsTest, AnEncoderThatReportsRandomAnglesBrakesBeforeTheFeetAreJudged) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> turn(-6, 6);
  EXPECT_LE(run(1, [&](double) { sensors_.joints[4].position = turn(random); }), 0.02);
  EXPECT_EQ(causes(Reaction::kBrake), "encoder_jump");
  EXPECT_EQ(joint(), 4u);
}

TEST_F(LeggedConditionsTest, OneAngleThatIsWrongIsNoStop) {
  EXPECT_EQ(run(0.3,
                [&, right = sensors_.joints[7].position](double t) {
                  sensors_.joints[7].position = right + (t > 0.0995 && t < 0.1035 ? 1.0 : 0.0);  // four cycles
                }),
            0.3);
}

TEST_F(LeggedConditionsTest, AnEncoderThatRepeatsOneAngleWhileItsCommandMovesBrakes) {
  for (std::size_t i = 0; i < kLegsJoints; ++i)
    command_.joints[i] = {.mode = JointMode::kImpedance, .position = sensors_.joints[i].position};
  const std::array<JointCommand, kMaxJoints> before = command_.joints;
  const std::array<JointSample, kMaxJoints> there = sensors_.joints;
  for (const LegPhase phase : {LegPhase::kRising, LegPhase::kStanding, LegPhase::kLowering, LegPhase::kGathering}) {
    command_.legged.phase = LegPhase::kLying;
    command_.joints = before;
    sensors_.joints = there;
    run(0.1);
    command_.legged.phase = phase;
    // It changes by one count while the command moves by 0.04 rad, when that has moved by 0.02 rad.
    const double seen = run(0.2, [&](double t) {
      command_.joints[7].position = before[7].position + 0.2 * t;
      sensors_.joints[7].position = there[7].position + 0.0015 * std::floor(10 * t);
    });
    EXPECT_EQ(seen, 0.2);
    const double stuck =
        run(0.4, [&](double t) { command_.joints[7].position = before[7].position + 0.2 * (t + 0.2); });
    if (phase == LegPhase::kGathering) {
      EXPECT_EQ(stuck, 0.4) << "the ground may block a leg of a robot that lies";
      continue;
    }
    EXPECT_NEAR(stuck, phase == LegPhase::kRising ? 0.352 : 0.152, 0.002);  // two cycles after the command
    EXPECT_EQ(causes(Reaction::kBrake), "encoder_stuck");
    EXPECT_EQ(joint(), 7u);
  }
}

TEST_F(LeggedConditionsTest, AFootThatSlipsBrakes) {
  const auto slide = [&](std::size_t foot, double speed) {
    return [this, foot, speed](double t) {
      std::array<Eigen::Vector3d, kLegs> feet = stand_;
      feet[foot].y() += std::copysign(speed * t, feet[foot].y());
      place(feet);
    };
  };
  const double limit = robot_.leg_length();
  EXPECT_EQ(run(0.3, slide(3, 0.9 * limit)), 0.3);
  for (const std::size_t foot : {0, 1, 2, 3}) {
    for (const bool new_run : {false, true}) {
      place(stand_);
      conditions_.enter_run();
      run(0.3);
      if (new_run) {
        conditions_.enter_run();
      } else {
        command_.legged.phase = LegPhase::kRising;
        run(0.1);
        command_.legged.phase = LegPhase::kStanding;
      }
      EXPECT_NEAR(run(0.3, slide(foot, 1.5 * limit)), 0.149, 1e-6) << "it slips for a window, and 0.05 s more";
      EXPECT_EQ(joint(), 3 * foot + 2);
    }
  }
  place(stand_);
  conditions_.enter_run();
  run(0.3);
  // The window of 0.1 s has its mean beyond the limit after 0.1/1.5 s, in steps of 10 ms, then 0.05 s of persistence.
  EXPECT_NEAR(run(0.3, slide(3, 1.5 * limit)), 0.12, 0.012);
  EXPECT_EQ(causes(Reaction::kBrake), "foot_slip");
  // It leaves the foot beside it, along the line of both.
  EXPECT_NEAR(active_.measurements()[0].value, 1.5 * limit, 1e-3 * limit);
}

TEST_F(LeggedConditionsTest, AFootInTheAirMayMoveAndCarryNothing) {
  for (const std::size_t lifted : {0, 3}) {
    command_.legged.lifted = lifted + 1;
    for (ContactSample& contact : sensors_.contacts) contact.force[2] = robot_.mass * 9.81 / 3;
    sensors_.contacts[lifted].force = {};
    EXPECT_EQ(run(0.6,
                  [&](double t) {
                    std::array<Eigen::Vector3d, kLegs> feet = stand_;
                    feet[lifted].x() += std::min({t, 0.1, 0.6 - t});
                    place(feet);
                  }),
              0.6);
    // It counts from where it is set down.
    command_.legged.lifted = 0;
    for (ContactSample& contact : sensors_.contacts) contact.force[2] = robot_.mass * 9.81 / kLegs;
    EXPECT_EQ(run(0.3), 0.3);
  }
}

TEST_F(LeggedConditionsTest, AFootThatCarriesNothingIsAWarning) {
  sensors_.contacts[1].force = {0, 0, 2};
  EXPECT_NEAR(run(1), 0.499, 1e-6);
  EXPECT_EQ(causes(Reaction::kWarn), "foot_load");
  EXPECT_EQ(joint(), 5u);
  EXPECT_NEAR(active_.measurements()[0].value, 2 / (robot_.mass * 9.81 / kLegs), 1e-6);
  // With a foot in the air three share the weight.
  command_.legged.lifted = 4;
  run(0.001);
  EXPECT_NEAR(active_.measurements()[0].value, 2 / (robot_.mass * 9.81 / 3), 1e-6);
  for (ContactSample& contact : sensors_.contacts) contact.valid = 0;
  EXPECT_EQ(run(1), 1) << "a load that is not measured is not judged";
}

/// A motor that damps a motion of 5 rad/s, 6 Hz. Its samples arrive every `every` s, and `part` of its torque acts.
double wrong_share(double every, double part) {
  constexpr double kPeriod = 0.001, kLimit = 20;
  MotorTorque torque;
  double largest = 0;
  for (int k = 0; k < 2000; ++k) {
    const double t = kPeriod * k, seen = every * std::floor(t / every + 1e-6);
    const JointCommand command{.mode = JointMode::kImpedance, .damping = 3};
    const JointSample sample{.position = 5 / 37.7 * std::sin(37.7 * seen),
                             .velocity = 5 * std::cos(37.7 * seen),
                             .effort = -part * command.damping * 5 * std::cos(37.7 * t)};
    torque.step(sample, command, kLimit, kPeriod);
    largest = std::max(largest, torque.wrong());
  }
  return largest;
}

TEST(MotorTorqueTest, SamplesThatAreLateAreNoMotorThatFails) {
  for (const double every : {0.001, 0.002, 0.01}) {
    EXPECT_LT(wrong_share(every, 1), JointMismatch::kWrongTorqueShare / 2) << every;
    EXPECT_GT(wrong_share(every, 0), 0.8) << every;
  }
}

/// Quadbot trots on the spot: each pair of feet bears for 0.2 s, and lifts its knees by 0.3 rad in its swing.
struct WalkingConditionsTest : LeggedConditionsTest {
  WalkingConditionsTest() { command_.legged.phase = LegPhase::kWalking; }

  /// Returns as `run`. `change` is called after the joints and their commands of this cycle are set.
  double walk(double seconds, const std::function<void(double)>& change = {}) {
    return run(seconds, [&](double t) {
      place(stand_);
      for (std::size_t leg = 0; leg < kLegs; ++leg) {
        const double part = std::fmod(t / 0.4 + (leg == 0 || leg == 3 ? 0.5 : 0), 1.0) * 2;
        const bool bears = part < 1;
        command_.contact_schedule[leg] = bears ? std::max(part, 1e-3) : 0;
        sensors_.contacts[leg].force[2] = bears ? robot_.mass * 9.81 / 2 : 0;
        const double lift = bears ? 0 : 0.3 * std::pow(std::sin(3.1416 * (part - 1)), 2);
        JointSample* joint = &sensors_.joints[kLegJoints * leg];
        joint[1].position += lift / 2;
        joint[2].position -= lift;
        for (std::size_t i = 0; i < kLegJoints; ++i)
          command_.joints[kLegJoints * leg + i] = {
              .mode = JointMode::kImpedance, .position = joint[i].position, .stiffness = bears ? 0.0 : 20.0};
      }
      if (change) change(t);
      for (std::size_t i = 0; i < kLegsJoints && motors_obey_; ++i)
        sensors_.joints[i].effort =
            command_.joints[i].stiffness * (command_.joints[i].position - sensors_.joints[i].position);
    });
  }

  /// The commands demand the measured angles.
  void follow() {
    for (std::size_t i = 0; i < kLegsJoints; ++i) command_.joints[i].position = sensors_.joints[i].position;
  }

  /// Turns the body by `angle` rad about `axis`, above feet that stand.
  void turn_body(const Eigen::Vector3d& axis, double angle) {
    std::array<Eigen::Vector3d, kLegs> feet = stand_;
    for (Eigen::Vector3d& foot : feet) foot = Eigen::AngleAxisd(-angle, axis) * foot;
    place(feet);
    follow();
  }

  bool motors_obey_ = true;
};

TEST_F(WalkingConditionsTest, AreNoneWhileItTrots) {
  EXPECT_EQ(walk(4), 4) << causes(Reaction::kBrake) << causes(Reaction::kRamp) << causes(Reaction::kWarn);
}

TEST_F(WalkingConditionsTest, AreNoneWhileEachFootLeavesTheGroundALittleEarly) {
  const double seen = walk(2, [&](double) {
    for (std::size_t leg = 0; leg < kLegs; ++leg)
      if (command_.contact_schedule[leg] > 0.85) sensors_.contacts[leg].force = {};
  });
  EXPECT_EQ(seen, 2) << causes(Reaction::kWarn);
}

TEST_F(WalkingConditionsTest, AFootThatSlipsInItsStanceBrakes) {
  const double seen = walk(2, [&](double t) {
    std::array<Eigen::Vector3d, kLegs> feet = stand_;
    const double since = std::fmod(t + 0.2, 0.4);  // since the rear right foot's stance began
    feet[3].x() -= 0.8 * robot_.leg_length() * std::min(since, 0.4 - since);
    if (t > 0.6) place(feet);
    follow();
  });
  EXPECT_LT(seen, 1.2);
  EXPECT_EQ(causes(Reaction::kBrake), "foot_slip");
}

// The rear right foot moves by 0.04 m in 20 ms of each of its stances: 1.7 times the limit within the window.
TEST_F(WalkingConditionsTest, AFootThatMovesOnceInItsStanceAndThenRestsIsNone) {
  const double seen = walk(4, [&](double t) {
    std::array<Eigen::Vector3d, kLegs> feet = stand_;
    const double since = std::fmod(t + 0.2, 0.4);
    feet[3].x() -= 0.04 * std::clamp(std::min((since - 0.08) / 0.02, (0.4 - since) / 0.1), 0.0, 1.0);
    if (t > 0.6) place(feet);
    follow();
  });
  EXPECT_EQ(seen, 4) << causes(Reaction::kBrake);
}

TEST_F(WalkingConditionsTest, AFootThatSlidesAndABodyThatTurnsWhileAPushLastsAreNone) {
  const auto slide = [&](double force, double since_push) {
    return [&, force, since_push](double t) {
      std::array<Eigen::Vector3d, kLegs> feet = stand_;
      const double since = std::fmod(t + 0.2, 0.4);
      feet[3].x() -= 0.8 * robot_.leg_length() * std::min(since, 0.4 - since);
      sensors_.imu.linear_acceleration[1] = t > since_push && t < since_push + 0.1 ? force : 0;
      if (t > since_push) place(feet);
      follow();
    };
  };
  walk(0.6);
  const double held = walk(2, slide(9, 0.2));
  EXPECT_EQ(causes(Reaction::kBrake), "foot_slip") << "feet on a floor of friction 1 push so hard";
  conditions_.enter_run();
  place(stand_);
  walk(0.6);
  const double pushed = walk(2, slide(15, 0.2));
  EXPECT_EQ(causes(Reaction::kBrake), "foot_slip") << "it goes on after the push";
  EXPECT_GT(pushed, 0.2 + 0.1 + BodyMotion::kPushed);
  EXPECT_LT(held, 0.5);
}

TEST_F(WalkingConditionsTest, AFootThatBearsInNoneOfItsStepsIsAWarning) {
  const double seen = walk(2, [&](double) { sensors_.contacts[1].force = {}; });
  EXPECT_GT(seen, 0.5) << "one step without load is none";
  EXPECT_LT(seen, 1.0);
  EXPECT_EQ(causes(Reaction::kWarn), "foot_load");
  EXPECT_EQ(joint(), 5u);
}

// Its angle runs away in its swing, as behind an encoder that counts backwards: 1 rad is four times the limit.
TEST_F(WalkingConditionsTest, AJointThatRunsAwayInItsSwingBrakesInThisSwing) {
  const double seen = walk(2, [&](double) {
    if (command_.joints[8].stiffness > 0) command_.joints[8].position += 1.0;
  });
  EXPECT_NEAR(seen, 0.2 + 0.049, 0.002);
  EXPECT_EQ(causes(Reaction::kBrake), "joint_following");
  EXPECT_EQ(joint(), 8u);
}

// The knee has turned by 0.2 rad after 61 ms of its swing.
TEST_F(WalkingConditionsTest, AnEncoderThatCountsBackwardsBrakesInItsSwing) {
  const double first = sensors_.joints[8].position;
  for (const double sign : {1.0, -1.0}) {
    conditions_.enter_run();
    const double seen =
        walk(2, [&](double) { sensors_.joints[8].position = first + sign * (command_.joints[8].position - first); });
    EXPECT_NEAR(seen, sign > 0 ? 2 : 0.2 + 0.066, 0.006) << causes(Reaction::kBrake);
  }
  EXPECT_EQ(causes(Reaction::kBrake), "joint_following");
  EXPECT_EQ(joint(), 8u);
}

TEST_F(WalkingConditionsTest, AJointThatDoesNotFollowItsSwingsBrakes) {
  const auto away = [&](double angle) {
    return [&, angle](double) {
      if (command_.joints[8].stiffness > 0) command_.joints[8].position += angle;
    };
  };
  EXPECT_EQ(walk(4, away(0.24)), 4) << "less than the limit of 0.25 rad is not noticed";
  EXPECT_LT(walk(4, away(0.3)), 1.2);
  EXPECT_EQ(causes(Reaction::kBrake), "joint_following");
  EXPECT_EQ(joint(), 8u);
}

TEST_F(WalkingConditionsTest, AnEncoderThatRepeatsOneAngleInItsSwingBrakes) {
  const double seen = walk(2, [&, held = sensors_.joints[8].position](double t) {
    if (t > 0.6) sensors_.joints[8].position = held;
  });
  EXPECT_LT(seen, 1.1);
  EXPECT_EQ(causes(Reaction::kBrake), "encoder_stuck");
  EXPECT_EQ(joint(), 8u);
}

TEST_F(WalkingConditionsTest, AMotorThatGivesNoTorqueWhileItsFootBearsBrakes) {
  motors_obey_ = false;
  const auto loaded = [&](double part) {
    return [&, part](double) {
      for (std::size_t i = 0; i < kLegsJoints; ++i) {
        JointCommand& command = command_.joints[i];
        command.effort = command.stiffness > 0 ? 0 : 0.3 * robot_.joints[i].effort_limit;
        sensors_.joints[i].effort = (i == 8 ? part : 1) * command.effort;
      }
    };
  };
  EXPECT_EQ(walk(1, loaded(0.7)), 1) << "it is weak";
  EXPECT_LT(walk(1, loaded(0)), 0.3);
  EXPECT_EQ(causes(Reaction::kBrake), "joint_following");
  EXPECT_EQ(joint(), 8u);
}

TEST_F(WalkingConditionsTest, AMotorThatGivesNoTorqueHalfOfTheTimeBrakes) {
  motors_obey_ = false;
  const auto failing = [&](int missing, int cycles) {
    return [&, missing, cycles, cycle = 0](double) mutable {
      ++cycle;
      for (std::size_t i = 0; i < kLegsJoints; ++i) {
        JointCommand& command = command_.joints[i];
        command.effort = command.stiffness > 0 ? 0 : 0.2 * robot_.joints[i].effort_limit;
        sensors_.joints[i].effort = i == 8 && cycle % cycles < missing ? 0 : command.effort;
      }
    };
  };
  EXPECT_EQ(walk(2, failing(1, 5)), 2);
  EXPECT_LT(walk(1, failing(25, 50)), 0.4);
  EXPECT_EQ(causes(Reaction::kBrake), "joint_following");
  EXPECT_EQ(joint(), 8u);
}

/// A motor of a knee in its swings, with 20 N·m/rad, 0.5 N·m·s/rad, and a torque that changes its sign every 50 ms.
struct SwingingMotorTest : WalkingConditionsTest {
  SwingingMotorTest() { motors_obey_ = false; }

  /// Returns as `walk`. The motor gives `part` of what the command of `late` cycles before demands. The encoder reports
  /// every `interval` cycles. The command at `infinite` s is not finite.
  double swing(double part, std::size_t late, std::uint64_t interval = 1, double infinite = -1) {
    conditions_.enter_run();
    std::deque<JointCommand> commands(late + 1, JointCommand{});
    double last = sensors_.joints[8].position;
    JointSample reported = sensors_.joints[8];
    return walk(1, [=, this, k = std::uint64_t{0}](double t) mutable {
      JointSample& joint = sensors_.joints[8];
      JointCommand& command = command_.joints[8];
      const double angle = joint.position, speed = (angle - last) / 0.001;
      last = angle;
      if (command.stiffness > 0) {
        command.effort = (std::fmod(t, 0.1) < 0.05 ? 0.3 : -0.3) * robot_.joints[8].effort_limit;
        command.damping = 0.5;
        command.velocity = speed;
      }
      const JointCommand& law = commands.front();
      const double demand = law.effort + law.stiffness * (law.position - angle) + law.damping * (law.velocity - speed);
      if (k++ % interval == 0) reported.position = angle, reported.velocity = speed;
      joint.position = reported.position;
      joint.velocity = reported.velocity;
      joint.effort = part * demand;
      commands.pop_front();
      commands.push_back(command);
      if (std::abs(t - infinite) < 5e-4) command.effort = std::numeric_limits<double>::quiet_NaN();
    });
  }
};

TEST_F(SwingingMotorTest, MayBeWeakOrLateOrHaveALateEncoder) {
  EXPECT_EQ(swing(0.55, 0), 1) << causes(Reaction::kBrake);
  for (const std::size_t late : {0, 5, 10}) EXPECT_EQ(swing(1, late), 1) << late << causes(Reaction::kBrake);
  EXPECT_EQ(swing(1, 0, 10), 1) << causes(Reaction::kBrake);
}

TEST_F(SwingingMotorTest, BrakesInItsFirstSwingsIfItsTorqueIsAnother) {
  const auto expect_stop = [this](double seen, double until) {
    EXPECT_LT(seen, until);
    EXPECT_EQ(causes(Reaction::kBrake), "joint_following");
    EXPECT_EQ(joint(), 8u);
  };
  expect_stop(swing(0, 0), 0.23);
  expect_stop(swing(-1, 0), 0.23);
  expect_stop(swing(1, 40), 0.3);
  expect_stop(swing(0, 0, 1, 0.1), 0.23);
}

TEST_F(SwingingMotorTest, IsNotJudgedWhileTheDriverBrakesOrTheGateClamps) {
  sensors_.gate.verdict = GateVerdict::kBrake;
  EXPECT_EQ(swing(0, 0), 1) << causes(Reaction::kBrake);
  sensors_.gate.verdict = GateVerdict::kClamped;
  sensors_.gate.reasons = kGateSpeedClamped;
  EXPECT_EQ(swing(0, 0), 1) << causes(Reaction::kBrake);
  sensors_.gate.reasons = kGateEffortClamped;
  EXPECT_LT(swing(0, 0), 0.3);
}

/// A knee turns by 0.14 rad while 30 samples are lost. The limit is 0.09 rad.
TEST_F(WalkingConditionsTest, ASampleThatIsRepeatedIsNoStuckEncoder) {
  std::array<JointSample, kMaxJoints> sampled{};
  const double seen = walk(2, [&, lost = 30](double) mutable {
    lost = lost == 30 ? 0 : lost + 1;
    if (lost == 0) sampled = sensors_.joints;
    for (JointSample& joint : sampled) joint.age_ns = lost * std::llround(1.0e9 * kPeriod);
    sensors_.joints = sampled;
  });
  EXPECT_EQ(seen, 2) << causes(Reaction::kBrake);
}

TEST_F(WalkingConditionsTest, AStuckEncoderIsNamedInItsSwingWhereEverySecondSampleIsLost) {
  const double seen = walk(2, [&, held = sensors_.joints[8].position, lost = false](double t) mutable {
    if (t > 0.6) sensors_.joints[8].position = held;
    sensors_.joints[8].age_ns = lost ? std::llround(1.0e9 * kPeriod) : 0;
    lost = !lost;
  });
  EXPECT_LT(seen, 0.8) << "before the end of the swing";
  EXPECT_EQ(causes(Reaction::kBrake), "encoder_stuck");
}

/// A driver of CAN adds the velocity times the age. The code of the velocity has no zero, and the age is 0 … 2 ms.
TEST_F(WalkingConditionsTest, AStuckEncoderIsNamedInItsSwingWhereItsDriverExtrapolates) {
  std::uniform_real_distribution<double> age(0, 0.002);
  const double seen = walk(2, [&, random = std::mt19937(1), held = sensors_.joints[8].position](double t) mutable {
    if (t > 0.6) sensors_.joints[8].position = held + 50.0 / 4095 * age(random);
  });
  EXPECT_LT(seen, 0.8) << "before the end of the swing";
  EXPECT_EQ(causes(Reaction::kBrake), "encoder_stuck");
}

/// The state of a noisy gyro moves where a foot is to land.
TEST_F(WalkingConditionsTest, ACommandThatJumpsInEachCycleIsNoStuckEncoder) {
  bool aside = false;
  const double seen = walk(2, [&](double) {
    aside = !aside;
    if (command_.joints[8].stiffness > 0) command_.joints[8].position += aside ? 0.1 : -0.1;
    sensors_.joints[8].position += aside ? 0 : 0.001;
  });
  EXPECT_EQ(seen, 2) << causes(Reaction::kBrake);
}

TEST_F(WalkingConditionsTest, ABodyThatSinksBrakes) {
  const double limit = 0.13 * robot_.leg_length();
  double depth = 0;
  const auto sinks = [&](double to) {
    return [&, to](double) {
      depth += std::clamp(to - depth, -3e-4, 3e-4);
      std::array<Eigen::Vector3d, kLegs> feet = stand_;
      for (Eigen::Vector3d& foot : feet) foot.z() += depth;
      place(feet);
      follow();
    };
  };
  EXPECT_EQ(walk(1, sinks(0.9 * limit)), 1);
  command_.legged.body[2] = -0.2 * limit;
  EXPECT_EQ(walk(1, sinks(1.1 * limit)), 1) << "it is asked to be lower";
  EXPECT_LT(walk(1, sinks(1.3 * limit)), 0.15);
  EXPECT_EQ(causes(Reaction::kBrake), "sinking");
}

// The feet know the slope on which they stand, and what falls is tilted against it.
TEST_F(WalkingConditionsTest, ABodyThatWalksOnASlopeIsNotTiltedAndOneThatFallsThereIs) {
  conditions_.enter_run();
  const auto on_slope = [&](double) {
    sensors_.imu.linear_acceleration[1] = 9.81 * std::sin(0.38);
    sensors_.imu.linear_acceleration[2] = 9.81 * std::cos(0.38);
  };
  EXPECT_EQ(walk(2, on_slope), 2) << causes(Reaction::kBrake);
  const double seen = walk(1, [&](double t) {
    rate_ = 1.2 * Eigen::Vector3d::UnitY();
    turn_body(Eigen::Vector3d::UnitY(), 1.2 * t);
  });
  EXPECT_NEAR(seen, 0.42 / 1.2 + 0.05, 0.02);
  EXPECT_EQ(causes(Reaction::kBrake), "tilt");
}

// Front left swings for 0.2 s, and then bears for 0.2 s.
TEST_F(WalkingConditionsTest, ABodyRisesOntoAStepAfterItsFeet) {
  const double step = 0.1, depth = 1.3 * 0.13 * robot_.leg_length();
  for (const bool lands : {true, false}) {
    conditions_.enter_run();
    command_.legged.phase = LegPhase::kStanding;
    place(stand_);
    run(0.3);
    command_.legged.phase = LegPhase::kWalking;
    walk(0.8);
    const double seen = walk(0.4, [&](double t) {
      std::array<Eigen::Vector3d, kLegs> feet = stand_;
      for (Eigen::Vector3d& foot : feet) foot.z() += depth * std::clamp(t / 0.15 - 1, 0.0, 1.0);
      if (lands) feet[0].z() += step * std::min(1.0, t / 0.2);
      place(feet);
      follow();
    });
    EXPECT_EQ(seen == 0.4, lands) << seen << causes(Reaction::kBrake);
  }
}

TEST_F(WalkingConditionsTest, AFootThatStillGoesDownHasNotLanded) {
  for (const double speed : {0.6, 0.35}) {
    conditions_.enter_run();
    const double seen = walk(2, [&](double t) {
      const double since = std::fmod(t, 0.4), last = std::max(0.0, 0.05 - 0.2 * speed);
      std::array<Eigen::Vector3d, kLegs> feet = stand_;
      feet[0].z() += since < 0.2 ? last + (0.05 - last) * since / 0.2 : std::max(0.0, 0.05 - speed * (since - 0.2));
      place(feet);
      follow();
    });
    EXPECT_EQ(seen == 2, speed > 0.5) << seen;
    EXPECT_EQ(causes(Reaction::kBrake), speed > 0.5 ? "" : "body_turn");
  }
}

// It turns to and fro by up to 1.8 rad/s about a slanting axis, above feet that stand. The IMU's x axis points left.
TEST_F(WalkingConditionsTest, AGyroThatContradictsTheFeetBrakes) {
  const Eigen::Quaterniond mounting(Eigen::AngleAxisd(1.5708, Eigen::Vector3d::UnitZ()));
  robot_.imu_in_base.orientation = {mounting.x(), mounting.y(), mounting.z(), mounting.w()};
  conditions_ = LeggedConditions(limits(robot_), robot_, kPeriod);
  const Eigen::Vector3d axis = Eigen::Vector3d(1, 2, 3).normalized();
  const auto turns = [&](double of_gyro) {
    return [&, of_gyro](double t) {
      turn_body(axis, 0.15 * std::sin(12 * t));
      rate_ = of_gyro * 1.8 * std::cos(12 * t) * (mounting.inverse() * axis);
    };
  };
  for (const double healthy : {1.0, 0.9, 1.1}) EXPECT_EQ(walk(1, turns(healthy)), 1) << causes(Reaction::kBrake);
  for (const double wrong : {0.0, -1.0}) {
    conditions_.enter_run();
    EXPECT_LT(walk(1, turns(wrong)), 0.3) << "within half a turn to and fro";
    EXPECT_EQ(causes(Reaction::kBrake), "body_turn");
  }
  conditions_.enter_run();
  const auto brakes = [&](double t) {
    turns(0)(t);
    sensors_.gate.verdict = std::lround(t * 1000) % 90 == 0 ? GateVerdict::kBrake : GateVerdict::kPassed;
  };
  EXPECT_EQ(walk(0.3, brakes), 0.3) << "its legs have just folded";
  conditions_.enter_run();
  sensors_.valid = kValidAccelerometer;
  EXPECT_EQ(walk(0.3, turns(0)), 0.3) << "a gyro that is missing is imu_lost";
}

// Feet creep where a robot turns round. A body that tips is known from any two feet.
TEST_F(WalkingConditionsTest, AGyroThatMissesASlowTipBrakes) {
  const auto turns = [&](const Eigen::Vector3d& axis, double rate) {
    return [&, axis, rate](double t) { turn_body(axis, rate * t); };
  };
  EXPECT_EQ(walk(0.5, turns(Eigen::Vector3d::UnitZ(), 0.35)), 0.5);
  EXPECT_EQ(walk(0.5, turns(Eigen::Vector3d::UnitY(), 0.15)), 0.5) << "more than any gyro's bias";
  EXPECT_LT(walk(0.5, turns(Eigen::Vector3d::UnitY(), 0.3)), 0.25);
  EXPECT_EQ(causes(Reaction::kBrake), "body_turn");
}

TEST_F(WalkingConditionsTest, OneWrongAngleIsNoBodyTurn) {
  for (int wrong = 0; wrong < 40; ++wrong) {
    conditions_.enter_run();
    const double seen = walk(0.6, [&](double t) {
      const bool now = std::lround(t * 1000) == 500 + wrong;
      for (const std::size_t hip : {0, 9}) sensors_.joints[hip].position += now ? 0.05 : 0;
      follow();
    });
    EXPECT_EQ(seen, 0.6) << wrong << causes(Reaction::kBrake);
  }
}

TEST_F(LeggedConditionsTest, AnAccelerometerThatShowsTheBodyPulledDownBrakes) {
  const auto shows = [&](double force, double from) {
    return [&, force, from](double t) { sensors_.imu.linear_acceleration[2] = t < from ? 9.81 : force; };
  };
  for (const LegPhase phase : {LegPhase::kRising, LegPhase::kStanding, LegPhase::kWalking}) {
    conditions_.enter_run();
    command_.legged.phase = phase;
    EXPECT_EQ(run(0.2, shows(0, 0.1)), 0.2) << "it falls";
    const auto rings = [&](double t) {
      sensors_.imu.linear_acceleration[2] = std::lround(t * 1000) == 100 ? -150 : 9.81;
    };
    EXPECT_EQ(run(0.2, rings), 0.2) << "one sample is none";
    const auto is_silent = [&](double t) {
      sensors_.imu.linear_acceleration[2] = t < 0.1 ? 9.81 : -9.81;
      sensors_.valid = t < 0.101 ? kValidGyro | kValidAccelerometer : kValidGyro;
    };
    EXPECT_EQ(run(0.15, is_silent), 0.15) << "a missing sample is none";
    sensors_.valid = kValidGyro | kValidAccelerometer;
    const auto folds = [&](double t) {
      command_.legged.phase = t > 0.1 && t < 0.12 ? LegPhase::kLying : phase;
      sensors_.imu.linear_acceleration[2] = t > 0.1 && t < 0.125 ? -6 : 9.81;
    };
    EXPECT_EQ(run(0.2, folds), 0.2) << "its legs fold while the controller is silent";
    conditions_.enter_run();
    EXPECT_NEAR(run(0.3, shows(-9.81, 0.1)), 0.121, 0.002);
    EXPECT_EQ(causes(Reaction::kBrake), "imu_reversed");
  }
  for (const LegPhase phase : {LegPhase::kLying, LegPhase::kGathering}) {
    command_.legged.phase = phase;
    conditions_.enter_run();
    EXPECT_EQ(run(0.3, shows(-9.81, 0.1)), 0.3) << "one that lies may be shaken";
  }
}

TEST_F(LeggedConditionsTest, AStateThatContradictsTheGyroOfItsCycleBrakes) {
  StateFrame state;
  state_ = &state;
  Eigen::Vector3d before = Eigen::Vector3d::Zero();
  const auto turns = [&](double of_gyro, double off) {
    return [&, of_gyro, off](double t) {
      Eigen::Map<Eigen::Vector3d>(state.base.twist_base.angular.data()) = of_gyro * before;
      state.base.twist_base.angular[1] += off;
      before = rate_ = Eigen::Vector3d(0.1, 0.6, -0.2) * std::sin(30 * t);
    };
  };
  EXPECT_EQ(run(0.5, turns(1, 0.4)), 0.5) << "a gyro has a bias";
  EXPECT_EQ(run(0.004, turns(1, 2)), 0.004) << "a few samples";
  conditions_.enter_run();
  EXPECT_LT(run(0.5, turns(-1, 0)), 0.03);
  EXPECT_EQ(causes(Reaction::kBrake), "wrong_state");
  conditions_.enter_run();
  sensors_.valid = kValidAccelerometer;
  EXPECT_EQ(run(0.05, turns(1, 2)), 0.05) << "a gyro that is missing is imu_lost";
}

TEST_F(LeggedConditionsTest, FeetAreJudgedOnlyWhileItStands) {
  for (ContactSample& contact : sensors_.contacts) contact.force = {};
  for (const LegPhase phase : {LegPhase::kLying, LegPhase::kGathering, LegPhase::kRising, LegPhase::kJoints}) {
    command_.legged.phase = phase;
    EXPECT_EQ(run(0.6,
                  [&](double t) {
                    std::array<Eigen::Vector3d, kLegs> feet = stand_;
                    feet[0].x() += 0.1 * std::sin(10 * t);
                    place(feet);
                  }),
              0.6);
  }
}

}  // namespace robot_control::tests

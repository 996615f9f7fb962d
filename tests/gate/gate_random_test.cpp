/// Tests properties that hold for any input of the gate. The failing seed is printed.

#include <algorithm>
#include <cmath>
#include <random>

#include "gate/gate_fixture.h"
#include "gate/joint_clamp.h"

namespace robot_control::tests {

constexpr JointLimits kArm{
    .effort = kLimit, .effort_rate = 900, .velocity = 20, .lower = -1, .upper = 3, .soft_zone = 0.1};
constexpr double kRounding = 1e-12;  // of torques up to 10⁴ N·m

/// A word that is often nearly right, so that the fuzz passes the first question.
std::uint64_t word(std::mt19937_64& random, std::uint64_t near) {
  switch (random() % 12) {
    case 0:
      return random();
    case 1:
      return near - random() % 6;
    case 2:
      return near + random() % 3;
    default:
      return near;
  }
}

double number(std::mt19937_64& random) {
  const std::uint64_t bits = random();
  double value = 0;
  std::memcpy(&value, &bits, sizeof value);
  return random() % 64 == 0 ? value : static_cast<double>(static_cast<std::int64_t>(bits)) * 1e-18;
}

struct GateGarbage : GateFixture {
  GateGarbage() : GateFixture(kArm) {}
};

TEST_F(GateGarbage, NeverMovesAJointBeyondItsLimitsOrWithoutAPermit) {
  const Lookup lookups[] = {Lookup::kMissing, Lookup::kFrame, Lookup::kFrame,
                            Lookup::kFrame,   Lookup::kToken, Lookup::kCorrupt};
  std::uint64_t moved = 0;
  for (unsigned seed = 0; seed < 50000; ++seed) {
    std::mt19937_64 random(seed);
    gate_.enter_run();
    input_.cycle = word(random, 100);
    input_.permit_found = lookups[random() % 6];
    input_.command_found = lookups[random() % 6];
    permit_.head.run = word(random, kRun);
    permit_.head.cycle = word(random, 99);
    permit_.expiry = word(random, 103);
    permit_.ramp_until = word(random, 100);
    permit_.action = static_cast<PermitAction>(word(random, 2));
    command_.head.run = word(random, kRun);
    command_.head.cycle = word(random, 99);
    command_.joint_count = word(random, 2);
    command_.stop_profile = word(random, 0);
    sensors_.joint_count = word(random, 2);
    for (JointSample& sample : sensors_.joints) {
      sample = {.position = number(random), .velocity = number(random), .effort = number(random)};
      sample.valid = static_cast<std::uint32_t>(word(random, kValidMotion));
    }
    for (JointCommand& joint : command_.joints) {
      joint = {static_cast<JointMode>(word(random, 2)),
               number(random),
               number(random),
               number(random),
               number(random),
               number(random)};
    }
    step();
    ASSERT_EQ(joints_.size(), 2u);
    for (const JointCommand& joint : joints_) {
      ASSERT_TRUE(finite(joint)) << "seed " << seed;
      ASSERT_LE(std::abs(joint.effort), kLimit) << "seed " << seed;
      ASSERT_LE(joint.mode, JointMode::kDriveVelocity) << "seed " << seed;
    }
    if (verdict() == GateVerdict::kBrake) {
      ASSERT_TRUE(braked()) << "seed " << seed;
      ASSERT_NE(reasons(), 0u) << "seed " << seed;
      continue;
    }
    ++moved;
    ASSERT_TRUE(input_.permit_found == Lookup::kFrame && permit_.head.run == kRun) << "seed " << seed;
    ASSERT_LT(permit_.head.cycle, input_.cycle) << "seed " << seed;
    ASSERT_LE(input_.cycle, permit_.expiry) << "seed " << seed;
    ASSERT_NE(permit_.action, PermitAction::kBrake) << "seed " << seed;
    ASSERT_LE(input_.cycle - command_.head.cycle, kCommandLife) << "seed " << seed;
  }
  EXPECT_GT(moved, 100u);  // else the fuzz proved nothing
}

/// Random joints move on random paths with random commands, tick after tick.
struct GateRandomDrive : GateFixture {
  GateRandomDrive() : GateFixture(kArm) {}

  void begin(unsigned seed) {
    random_.seed(seed);
    gate_.enter_run();
    tick_at(1);
    for (std::size_t i = 0; i < 2; ++i) {
      position_[i] = within(-1.2, 3.2);
      velocity_[i] = 0;
    }
  }
  double within(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }

  /// A joint speeds up and slows down at random, up to 1.5 times its limit.
  void move() {
    for (std::size_t i = 0; i < 2; ++i) {
      if (random_() % 50 == 0) velocity_[i] = within(-30, 30);
      position_[i] += velocity_[i] * kPeriod;
      if (position_[i] > 3.2 || position_[i] < -1.2) velocity_[i] = -velocity_[i];
      sensors_.joints[i] = {
          .position = position_[i], .velocity = velocity_[i], .effort = within(-8, 8), .valid = kValidMotion};
    }
  }
  void request() {
    for (JointCommand& joint : command_.joints) {
      joint = {.mode = static_cast<JointMode>(random_() % 4),
               .position = within(-4, 6),
               .velocity = within(-40, 40),
               .stiffness = within(-5, 50),
               .damping = within(-5, 50),
               .effort = within(-10, 10)};
    }
  }

  /// The torque of the driver's law, without the driver's own clamp.
  static double torque(const JointCommand& joint, double position, double velocity) {
    double torque = joint.effort;
    if (joint.mode == JointMode::kImpedance) torque += joint.stiffness * (joint.position - position);
    if (joint.mode != JointMode::kEffort) torque += joint.damping * (joint.velocity - velocity);
    return torque;
  }

  std::mt19937_64 random_;
  double position_[2] = {};
  double velocity_[2] = {};
};

TEST_F(GateRandomDrive, NeitherSpeedsUpBeyondTheLimitNorDrivesIntoAnEndStopNorJumps) {
  std::uint64_t fast = 0, at_stop = 0, rated = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    begin(seed);
    JointSpeed speed[2] = {JointSpeed(kPeriod), JointSpeed(kPeriod)};
    double last[2] = {};
    bool driven_before[2] = {};
    for (int tick = 0; tick < 500; ++tick) {
      move();
      request();
      const std::uint64_t cycle = input_.cycle;
      next();
      for (std::size_t i = 0; i < 2; ++i) {
        const JointCommand& joint = joints_[i];
        const JointSample& sample = sensors_.joints[i];
        speed[i].step(sample.position, cycle);
        ASSERT_TRUE(finite(joint)) << "seed " << seed << ", tick " << tick;
        ASSERT_LE(std::abs(joint.effort), kLimit) << "seed " << seed << ", tick " << tick;
        if (joint.mode == JointMode::kBrake) {
          driven_before[i] = false;
          continue;
        }
        const double turns = speed[i].value();
        const double driven = torque(joint, sample.position, turns);
        if (std::abs(turns) >= kArm.velocity) {
          ++fast;
          ASSERT_LE(driven * std::copysign(1.0, turns), kRounding) << "seed " << seed << ", tick " << tick;
        }
        for (const double end : {1.0, -1.0}) {
          const double left = end > 0 ? kArm.upper - sample.position : sample.position - kArm.lower;
          if (left > 0) continue;
          ++at_stop;
          // At the end stop the law at rest does not push on. (Damping pulls back a joint that moves away.)
          ASSERT_LE(torque(joint, sample.position, 0) * end, kRounding) << "seed " << seed << ", tick " << tick;
        }
        // The later clamps only reduce: beyond the rate lies at most a smaller torque of the same sign.
        const double step = kArm.effort_rate * kPeriod;
        if (driven_before[i] && std::abs(joint.effort - last[i]) > step + kRounding) {
          ASSERT_NE(reasons() & (kGateSpeedClamped | kGatePositionClamped), 0u) << "seed " << seed << ", tick " << tick;
          ASSERT_LT(std::abs(joint.effort), std::abs(last[i])) << "seed " << seed << ", tick " << tick;
          ASSERT_GE(joint.effort * last[i], 0) << "seed " << seed << ", tick " << tick;
        }
        rated += (reasons() & kGateRateClamped) != 0;
        driven_before[i] = true;
        last[i] = joint.effort;
      }
    }
  }
  EXPECT_GT(fast, 1000u);  // else the drives proved nothing
  EXPECT_GT(at_stop, 1000u);
  EXPECT_GT(rated, 1000u);
}

}  // namespace robot_control::tests

#include <Eigen/Geometry>
#include <random>

#include "bench/programs/legs/loop_rows.h"
#include "control/legged/walk/gait_table.h"

namespace robot_control::bench {
namespace {

/// Draws what the robot does next.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : random_(seed) {}
  double within(double least, double largest) {
    return std::uniform_real_distribution<double>(least, largest)(random_);
  }
  std::uint64_t below(std::uint64_t count) { return random_() % count; }
  /// A pose of the body within what is promised.
  Posture pose(double length) {
    return {.height = within(-0.15, 0.15) * length,
            .roll = within(-0.25, 0.25),
            .pitch = within(-0.25, 0.25),
            .x = within(-0.1, 0.1) * length,
            .y = within(-0.1, 0.1) * length,
            .yaw = within(-0.25, 0.25)};
  }

 private:
  std::mt19937_64 random_;
};

using Place = Eigen::Isometry2d;

/// Returns position and heading on the ground.
Place place_of(const Pose& pose) {
  const Quaternion& q = pose.orientation;
  const double yaw = std::atan2(2 * (q[3] * q[2] + q[0] * q[1]), 1 - 2 * (q[1] * q[1] + q[2] * q[2]));
  return Eigen::Translation2d(pose.position[0], pose.position[1]) * Eigen::Rotation2Dd(yaw);
}

/// Disturbs a robot for some seconds, and computes its run again from its rows.
void replay(const LegModel& model, std::uint64_t seed, bool walks, WorstValues& worst) {
  constexpr double kSeconds = 8;
  QuadrupedLoop robot(model, seed, ErrorLevel::kField);
  robot.record = true;
  Draw draw(seed);
  const double length = model.leg_length();
  const char* const nodes[] = {"estimator", "controller", "monitor"};
  const char* const kinds[] = {"off", "stuck", "delayed", "garbage", "wrong"};
  robot.wait(0.3);
  robot.run(2.5, stance({ModeKind::kStand}));
  for (double begun = robot.loop.time(); robot.loop.time() - begun < kSeconds;) {
    switch (draw.below(walks ? 7 : 5)) {
      case 0: {
        const char* const node = nodes[draw.below(3)];
        robot.loop.inject_fault(node, kinds[draw.below(5)]);
        robot.wait(draw.within(0.005, 0.1));
        robot.loop.inject_fault(node, "ok");
        break;
      }
      case 1:
        robot.loop.e_stop();
        break;
      case 2:
        robot.run(1.5, {});
        robot.loop.e_stop_reset();
        robot.run(0.1, {});
        robot.run(2.0, stance({ModeKind::kStand}));
        break;
      case 3:
        robot.run(0.5, {.twist = {}, .posture = draw.pose(length)});
        break;
      case 4:
        robot.run(0.7, stance({ModeKind::kLift, draw.below(kLegs)}));
        break;
      default: {
        Request walk = stance({ModeKind::kGait, 1 + draw.below(kGaits.size() - 1)});
        walk.twist.linear[0] = draw.within(-0.5, 0.5);
        walk.twist.angular[2] = draw.within(-0.5, 0.5);
        robot.run(draw.within(0.2, 1.0), walk);
      }
    }
  }
  const ReplayReport report = robot.recording.replay(robot.loop.robot(), robot.period());
  worst.add("replay that is not exact", report.exact() ? 0 : 1, "runs");
  if (!report.exact())
    std::fprintf(stderr, "%s, seed %llu: %s", model.name.c_str(), static_cast<unsigned long long>(seed),
                 text_of(report).c_str());
}

}  // namespace

void hour(const LegModel& model, std::uint64_t seed, WorstValues& worst) {
  constexpr double kHour = 3600;  // s
  QuadrupedLoop robot(model, seed, ErrorLevel::kField);
  Draw draw(seed);
  const double length = model.leg_length(), lift = leg_tuning(model).lift;
  double warned = 0;
  const auto run = [&](double seconds, const Request& request) {
    for (double t = 0; t < seconds; t += 0.02) {
      robot.run(0.02, request);
      if (robot.permit().warnings != 0) warned += 0.02;
    }
  };
  run(0.3, {});
  while (robot.loop.time() < kHour && robot.permit().causes == 0) {
    run(2.5, stance({ModeKind::kStand}));
    for (int act = 0; act < 10; ++act) {
      if (draw.below(3) == 0) {
        Request foot = stance({ModeKind::kLift, draw.below(kLegs)});
        foot.posture = {.height = lift, .x = draw.within(-0.1, 0.1) * length, .y = draw.within(-0.1, 0.1) * length};
        run(draw.within(2, 5), foot);
        run(2.5, {});
      } else {
        run(draw.within(1, 5), {.twist = {}, .posture = draw.pose(length)});
      }
    }
    run(2, {});
    run(5, stance({ModeKind::kLie}));
  }
  worst.add("stops in an hour", robot.permit().causes == 0 ? 0 : 1, "runs");
  worst.add("time with a warning in an hour", warned, "s");
  if (robot.permit().causes != 0)
    std::fprintf(stderr, "%s, seed %llu: stopped after %.1f s by %s\n", model.name.c_str(),
                 static_cast<unsigned long long>(seed), robot.loop.time(), robot.causes().c_str());
}

void walking_hours(const LegModel& model, std::uint64_t seed, WorstValues& worst) {
  constexpr double kTime = 600, kStretch = 60;  // s
  QuadrupedLoop robot(model, walking_parameters(seed));
  Draw draw(seed);
  double warned = 0, walked = 0;
  robot.run(5, stance({ModeKind::kStand}));
  Place before = place_of(robot.truth().pose_world), truth = before, estimate = place_of(robot.state().base.pose_odom);
  double next = robot.loop.time() + kStretch;
  while (robot.loop.time() < kTime && robot.permit().causes == 0) {
    const std::uint64_t gait = draw.below(kGaits.size());
    const Gait& row = kGaits[gait == kStandGait ? kFastGait : gait];
    const double fastest = row.crawls() ? 0.2 : row.duty > 0.5 ? 0.5 : 0.6;  // m/s
    Request walk = stance(gait == kStandGait ? Mode{} : Mode{ModeKind::kGait, gait});
    walk.twist.linear[0] = draw.within(-0.5, 1) * fastest;
    walk.twist.linear[1] = draw.within(-0.1, 0.1);
    walk.twist.angular[2] = draw.within(-0.4, 0.4);
    for (double left = draw.within(2, 6); left > 0 && robot.permit().causes == 0; left -= 0.02) {
      robot.run(0.02, walk);
      if (robot.permit().warnings != 0) warned += 0.02;
      const Place now = place_of(robot.truth().pose_world);
      walked += (now.translation() - before.translation()).norm();
      before = now;
    }
    if (robot.loop.time() < next) continue;
    const Place measured = place_of(robot.state().base.pose_odom);
    const Eigen::Vector2d off =
        (estimate.inverse() * measured).translation() - (truth.inverse() * before).translation();
    worst.add("error of the way between two resets", 100 * off.norm() / walked, "%");
    worst.average("mean error of the way between two resets", 100 * off.norm() / walked, "%");
    truth = before, estimate = measured, walked = 0, next += kStretch;
  }
  worst.add("stops in ten minutes", robot.permit().causes == 0 ? 0 : 1, "runs");
  worst.add("time with a warning in ten minutes", warned, "s");
  if (robot.permit().causes != 0)
    std::fprintf(stderr, "%s, seed %llu: stopped after %.1f s by %s\n", model.name.c_str(),
                 static_cast<unsigned long long>(seed), robot.loop.time(), robot.causes().c_str());
}

void replayed(const LegModel& model, std::uint64_t seed, WorstValues& worst) {
  replay(model, seed, false, worst);
}

void walking_replayed(const LegModel& model, std::uint64_t seed, WorstValues& worst) {
  replay(model, seed, true, worst);
}

}  // namespace robot_control::bench


#include "bench/programs/legs/loop_rows.h"

namespace robot_control::bench {
namespace {

constexpr double kPush = 0.02;  // s

void sway(QuadrupedLoop& robot, double size, std::uint64_t cycle) {
  Request request;
  request.posture.y =
      size * robot.robot().leg_length() * std::sin(2 * kPi * kSway * robot.period() * static_cast<double>(cycle));
  robot.loop.request(request);
  robot.step();
}

void push_once(const LegModel& model, double speed, int direction, WorstValues& worst) {
  Parameters parameters = QuadrupedLoop::parameters(0, ErrorLevel::kIdeal);
  const double angle = direction * kPi / 4, force = model.mass * speed / kPush;
  parameters.plant.push_x = force * std::cos(angle);
  parameters.plant.push_y = force * std::sin(angle);
  parameters.plant.push_start = 3.4;
  parameters.plant.push_duration = kPush;
  QuadrupedLoop robot(model, parameters);
  stand_up(robot);
  while (robot.loop.time() < parameters.plant.push_start) robot.step();
  const Vector3 begin = robot.truth().pose_world.position;
  robot.wait(kPush);
  const double reached = robot.speed();
  robot.fold();
  const Vector3& end = robot.truth().pose_world.position;
  const std::string name = (speed == 0.5 ? "0.5" : speed == 1.0 ? "1.0" : "1.5") + std::string(" m/s, ");
  worst.add(name + "turned over", robot.tilt_now() > kTurnedOver ? 1 : 0, "runs");
  worst.add(name + "speed that is missing", speed - reached, "m/s");
  worst.add(name + "tilt", robot.tilt, "rad");
  worst.add(name + "blow", robot.shock, "m/s^2");
  worst.add(name + "way", std::hypot(end[0] - begin[0], end[1] - begin[1]), "m");
}

}  // namespace

void stop(const LegModel& model, std::uint64_t seed, WorstValues& worst) {
  for (const std::string situation : {"standing", "swaying", "one foot up"}) {
    QuadrupedLoop robot(model, seed);
    stand_up(robot);
    if (situation == "swaying") {
      for (std::uint64_t k = 0; k < robot.cycles(1.25); ++k) sway(robot, 0.1, k);
    } else if (situation == "one foot up") {
      Request up = stance({ModeKind::kLift, seed % kLegs});
      up.posture.height = leg_tuning(model).lift;
      robot.run(2.0, up);
    }
    const double tilted = robot.tilt_now();
    const auto [cycles, rest_at] = robot.fold();
    worst.add("cycles to the brake, " + situation, cycles, "cycles");
    worst.add("rest, " + situation, rest_at, "s");
    worst.add("acceleration, " + situation, robot.shock, "m/s^2");
    worst.add("tilt, " + situation, std::max(robot.tilt, tilted), "rad");
  }
}

void push(const LegModel& model, std::uint64_t /*seed*/, WorstValues& worst) {
  for (const double speed : {0.5, 1.0, 1.5})
    for (int direction = 0; direction < 8; ++direction) push_once(model, speed, direction, worst);
}

void rest(const LegModel& model, std::uint64_t seed, WorstValues& worst) {
  QuadrupedLoop robot(model, seed);
  stand_up(robot);
  robot.loop.e_stop();
  robot.wait(3);
  const Vector3 before = robot.truth().pose_world.position;
  for (const JointGroup& group : model.groups) robot.loop.inject_fault(group.name + "_motor", "off");
  robot.clear();
  robot.wait(600);
  const Vector3& after = robot.truth().pose_world.position;
  worst.add("tilt in 10 min without power", robot.tilt, "rad");
  worst.add("way of the body in 10 min without power",
            std::hypot(after[0] - before[0], after[1] - before[1], after[2] - before[2]), "m");
  worst.add("speed after 10 min without power", robot.speed(), "m/s");
}

void silent(const LegModel& model, std::uint64_t seed, WorstValues& worst) {
  std::vector<Vector3> undisturbed;
  for (std::uint64_t cycles = 0; cycles < 20; cycles += cycles == 0 ? 5 : 1) {
    QuadrupedLoop robot(model, seed);
    stand_up(robot);
    double moved = 0;
    const std::uint64_t half = robot.cycles(0.5);
    for (std::uint64_t k = 0; k < 2 * half; ++k) {
      if (k == half && cycles > 0) robot.loop.inject_fault("controller", "off");
      if (k == half + cycles) robot.loop.inject_fault("controller", "ok");
      sway(robot, 0.05, k);
      const Vector3& place = robot.truth().pose_world.position;
      if (cycles == 0) {
        undisturbed.push_back(place);
        continue;
      }
      const Vector3& other = undisturbed[k];
      moved = std::max(moved, std::hypot(place[0] - other[0], place[1] - other[1], place[2] - other[2]));
    }
    worst.add("way of the body by 5 ... 19 silent cycles", moved, "m");
    worst.add("stops", robot.permit().causes == 0 ? 0 : 1, "runs");
  }
}

}  // namespace robot_control::bench

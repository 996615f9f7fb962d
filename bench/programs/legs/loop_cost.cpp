#include "bench/programs/kernel.h"
#include "bench/programs/legs/loop_rows.h"
#include "drivers/mujoco/model/mujoco_model.h"
#include "gate/gate.h"
#include "loop/gate_setup.h"
#include "rt/clock.h"
#include "support/allocation_guard.h"

namespace robot_control::bench {
namespace {

constexpr std::size_t kCycles = 2000;  // of a block
constexpr int kBlocks = 51;
constexpr int kSpeedBlocks = 7;

/// The frames of a robot that stands up, and sways or walks in the end.
struct Frames {
  std::vector<SensorFrame> sensors;
  std::vector<StateFrame> states;
  std::vector<CommandFrame> commands;
  std::vector<Permit> permits;
  std::size_t begin = 0;  ///< number of the first one of a block
};

Request swaying(const LegModel& model, std::size_t cycle) {
  Request request;
  request.posture.y = 0.1 * model.leg_length() * std::sin(2 * kPi * kSway * static_cast<double>(cycle) * 0.001);
  return request;
}

Request walking(const LegModel&, std::size_t) {
  Request request;
  request.twist.linear[0] = 0.5;
  return request;
}

using Requests = Request (*)(const LegModel&, std::size_t cycle);

/// The robot follows `requests` for `begins` cycles before the block.
Frames record(const LegModel& model, Requests requests, std::size_t begins) {
  QuadrupedLoop robot(model, 0, ErrorLevel::kField);
  Frames frames;
  const auto step = [&](const Request& request) {
    robot.loop.request(request);
    robot.step();
    frames.sensors.push_back(robot.loop.row().driver->sensors);
    frames.states.push_back(robot.state());
    frames.commands.push_back(robot.command());
    frames.permits.push_back(robot.permit());
  };
  for (int k = 0; k < 300; ++k) step({});
  for (int k = 0; k < 2500; ++k) step(stance({ModeKind::kStand}));
  for (std::size_t k = 0; k < begins; ++k) step(requests(model, k));
  frames.begin = frames.sensors.size();
  for (std::size_t k = 0; k <= kCycles; ++k) step(requests(model, begins + k));
  return frames;
}

/// Adds the time of one step, the fastest of all blocks, and the allocations of the last one. `step` computes the cycle
/// of a frame's number; `begin` prepares a block. All frames before are computed first.
template <class Begin, class Step>
void measure(const std::string& name, const Frames& frames, Begin begin, Step step, WorstValues& worst) {
  double fastest = std::numeric_limits<double>::infinity();
  std::uint64_t allocations = 0;
  for (int block = 0; block < kBlocks; ++block) {
    begin();
    const AllocationGuard guard;
    const std::int64_t start = monotonic_ns();
    for (std::size_t k = 0; k < kCycles; ++k) step(frames.begin + k);
    fastest = std::min(fastest, static_cast<double>(monotonic_ns() - start) / kCycles);
    allocations = guard.count();
  }
  worst.add(name, fastest / 1000, "us");
  worst.add("allocations", static_cast<double>(allocations), "calls");
}

/// Measures a law that can be saved, from its state at the beginning of the block.
template <class Law, class Step>
void measure_law(const std::string& name, const Frames& frames, Law& law, Step step, WorstValues& worst) {
  for (std::size_t k = 1; k < frames.begin; ++k) step(k);
  LawSnapshot begin;
  law.save(begin);
  measure(
      name, frames, [&] { law.restore(begin); }, step, worst);
}

/// Returns the time of one bare mj_step in ns, while the joints hold the standing posture of these frames.
class BareSteps {
 public:
  BareSteps(const LegModel& model, const Frames& frames)
      : simulated_(compile_model(model, QuadrupedLoop::parameters(0, ErrorLevel::kIdeal).plant, 0.001)),
        data_(set_down(simulated_)),
        held_(frames.commands[frames.begin - 1].joints) {
    for (std::size_t i = 0; i < kLegsJoints; ++i) begin_[i] = data_->qpos[simulated_.joint_position[i]];
    for (int k = 0; k < 2500; ++k) step(std::min(1.0, k / 1300.0));
  }

  double nanoseconds() {
    const std::int64_t start = monotonic_ns();
    for (std::size_t k = 0; k < kCycles; ++k) step(1);
    return static_cast<double>(monotonic_ns() - start) / kCycles;
  }
  double height() const { return data_->qpos[simulated_.base_position + 2]; }

 private:
  void step(double part) {
    for (std::size_t i = 0; i < kLegsJoints; ++i) {
      const double angle = data_->qpos[simulated_.joint_position[i]], rate = data_->qvel[simulated_.joint_velocity[i]];
      const double wanted = begin_[i] + part * (held_[i].position - begin_[i]);
      data_->qfrc_applied[simulated_.joint_velocity[i]] =
          part * held_[i].effort + held_[i].stiffness * (wanted - angle) - held_[i].damping * rate;
    }
    mj_step(simulated_.model.get(), data_.get());
  }

  MujocoModel simulated_;
  MujocoData data_;
  std::array<JointCommand, kMaxJoints> held_;
  std::array<double, kLegsJoints> begin_{};
};

/// `standing` are the frames of a robot that sways.
void measure_speed(const LegModel& model, const Frames& standing, Requests requests, const std::string& motion,
                   WorstValues& worst) {
  BareSteps bare(model, standing);
  QuadrupedLoop robot(model, 0, ErrorLevel::kField);
  stand_up(robot);
  robot.run(1.0, requests(model, 0));
  const double below = robot.truth().pose_world.position[2];
  std::vector<double> bare_ns, loop_ns;
  for (int block = 0; block < kSpeedBlocks; ++block) {
    bare_ns.push_back(bare.nanoseconds());
    const std::int64_t start = monotonic_ns();
    for (std::size_t k = 0; k < kCycles; ++k) {
      if (k % 20 == 0) robot.loop.request(requests(model, k));
      robot.loop.step();
    }
    loop_ns.push_back(static_cast<double>(monotonic_ns() - start) / kCycles);
  }
  worst.add("bare mj_step", median(bare_ns) / 1000, "us");
  worst.add("cycle of ClosedLoop" + motion + ", of a bare mj_step", median_ratio(loop_ns, bare_ns), "");
  if (bare.height() < 0.5 * below) std::fprintf(stderr, "%s does not stand in the bare loop\n", model.name.c_str());
}

}  // namespace

void cost(const LegModel& model, std::uint64_t /*seed*/, WorstValues& worst) {
  const Frames frames = record(model, swaying, 0);
  const Parameters parameters = QuadrupedLoop::parameters(0, ErrorLevel::kField);
  const Quadruped robot(parameters, model);
  const double period = parameters.loop.period();
  double kernel = std::numeric_limits<double>::infinity();
  for (int block = 0; block < kBlocks; ++block) kernel = std::min(kernel, kernel_block(kCycles));
  worst.add("kernel of 64 multiply-adds", kernel / 1000, "us");

  const std::unique_ptr<EstimatorLaw> estimator = robot.make_estimator();
  StateFrame state;
  measure_law(
      "estimator", frames, *estimator, [&](std::size_t k) { estimator->step(frames.sensors[k], state); }, worst);

  const std::unique_ptr<ControllerLaw> controller = robot.make_controller();
  controller->enter_run({}, true);
  CommandFrame command;
  measure_law(
      "controller", frames, *controller,
      [&](std::size_t k) {
        controller->step({.sensors = &frames.sensors[k],
                          .state = &frames.states[k],
                          .permit = &frames.permits[k - 1],
                          .request = {.content = frames.commands[k].requested, .count = k}},
                         command);
      },
      worst);
  worst.add("controller that does not stand", command.legged.phase == LegPhase::kStanding ? 0 : 1, "runs");

  Gate gate(joint_limits(model), robot.gate(), period);
  measure(
      "gate", frames, [&] { gate.enter_run(); },
      [&](std::size_t k) {
        gate.step({.run = frames.sensors[k].head.run,
                   .cycle = frames.sensors[k].head.cycle,
                   .permit_found = Lookup::kFrame,
                   .permit = &frames.permits[k - 1],
                   .command_found = Lookup::kFrame,
                   .command = &frames.commands[k - 1],
                   .sensors = &frames.sensors[k]});
      },
      worst);
  worst.add("gate that brakes", gate.report().verdict == GateVerdict::kBrake ? 1 : 0, "runs");

  const std::unique_ptr<MonitorLaw> monitor = robot.make_monitor();
  Permit permit;
  measure_law(
      "monitor", frames, *monitor,
      [&](std::size_t k) {
        monitor->step(
            {.sensors = &frames.sensors[k], .command = &frames.commands[k - 1], .state = &frames.states[k - 1]},
            permit);
      },
      worst);
  worst.add("monitor that stops", permit.causes == 0 ? 0 : 1, "runs");
  measure_speed(model, frames, swaying, "", worst);
}

void walking_cost(const LegModel& model, std::uint64_t /*seed*/, WorstValues& worst) {
  const Frames frames = record(model, walking, 2000);
  const Parameters parameters = QuadrupedLoop::parameters(0, ErrorLevel::kField);
  const Quadruped robot(parameters, model);
  const double period = parameters.loop.period();
  const std::unique_ptr<EstimatorLaw> estimator = robot.make_estimator();
  StateFrame state;
  measure_law(
      "estimator, walking", frames, *estimator, [&](std::size_t k) { estimator->step(frames.sensors[k], state); },
      worst);

  LegController controller(model, parameters.leg_control, period);
  controller.enter_run({}, true);
  CommandFrame command;
  const auto step = [&](std::size_t k) {
    controller.step({.sensors = &frames.sensors[k],
                     .state = &frames.states[k],
                     .permit = &frames.permits[k - 1],
                     .request = {.content = frames.commands[k].requested, .count = k}},
                    command);
  };
  for (std::size_t k = 1; k < frames.begin; ++k) step(k);
  const LegController::State begin = controller.state();
  std::vector<double> fastest(kCycles, std::numeric_limits<double>::infinity()), planned;
  std::uint64_t allocations = 0;
  for (int block = 0; block < kBlocks; ++block) {
    controller.set_state(begin);
    const AllocationGuard guard;
    for (std::size_t k = 0; k < kCycles; ++k) {
      const std::int64_t start = monotonic_ns();
      step(frames.begin + k);
      fastest[k] = std::min(fastest[k], static_cast<double>(monotonic_ns() - start));
    }
    allocations = guard.count();
  }
  controller.set_state(begin);
  for (std::size_t k = 0; k < kCycles; ++k) {
    step(frames.begin + k);
    if (controller.state().walk.walker.planned == 0) planned.push_back(fastest[k]);
  }
  worst.add("allocations", static_cast<double>(allocations), "calls");
  worst.add("controller that does not walk", command.legged.phase == LegPhase::kWalking ? 0 : 1, "runs");
  worst.add("controller with a plan, median", median(planned) / 1000, "us");
  std::sort(fastest.begin(), fastest.end());
  worst.add("controller, walking, median", fastest[kCycles / 2] / 1000, "us");
  worst.add("controller, walking, 99 %", fastest[kCycles * 99 / 100] / 1000, "us");
  measure_speed(model, record(model, swaying, 0), walking, ", walking", worst);
}

}  // namespace robot_control::bench

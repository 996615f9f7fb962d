/// bench_plant PARAMS.yaml: measures the driver's cost beyond the physics.
///
/// Each round runs four loops, one after the other, on a curve of 0.5 m/s and 0.4 rad/s. MujocoPlant::write runs with
/// exact and with erring sensors. The bare loop has mj_step1, tyre forces and mj_step2 of the same model. The last one
/// is mj_step of the model with native friction. The figures are cycles per second, median over the rounds, and the
/// ratio to the bare loop of the same round.

#include <string>
#include <vector>

#include "bench/programs/rows.h"
#include "configuration/parameters.h"
#include "drivers/mujoco/mujoco_plant.h"
#include "machine/wheeled/drive_train.h"
#include "rt/clock.h"

namespace robot_control::bench {

constexpr int kRounds = 41;
constexpr int kSteps = 5000;
constexpr double kForward = 0.5;  // m/s
constexpr double kTurn = 0.4;     // rad/s

double wheel_speed(const DriveTrain& robot, const WheelModel& wheel) {
  const double sideways = (wheel.side == Side::kLeft ? -1 : 1) * robot.effective_wheel_base() / 2;
  return wheel.sign * (kForward + kTurn * sideways) / wheel.radius;
}

/// damping · dt / J = 0.4 on the lifted wheel.
double wheel_damping(const WheelModel& wheel, double step) {
  return 0.4 * wheel.inertia / step;
}

template <class Step>
double rate(Step step) {
  const std::int64_t start = monotonic_ns();
  for (int k = 0; k < kSteps; ++k) step();
  return kSteps * 1e9 / static_cast<double>(monotonic_ns() - start);
}

/// The model alone, with the functions that a loop needs to drive it.
class Bare {
 public:
  Bare(const DriveTrain& robot, const MujocoPlantParameters& parameters, double period)
      : robot_(robot),
        model_(compile_model(robot, parameters, period)),
        wheels_(model_, parameters),
        data_(set_down(model_)) {
    mj_step1(model_.model.get(), data_.get());
    wheels_.observe(*data_);
  }

  void drive() {
    mju_zero(data_->qfrc_applied, model_.model->nv);
    for (const WheelModel& wheel : robot_.wheels) {
      const int dof = model_.joint_velocity[wheel.joint];
      data_->qfrc_applied[dof] =
          wheel_damping(wheel, model_.model->opt.timestep) * (wheel_speed(robot_, wheel) - data_->qvel[dof]);
    }
  }
  void step_with_tyres() {
    for (int i = 0; i < model_.substeps; ++i) {
      drive();
      wheels_.apply(*data_);
      mj_step2(model_.model.get(), data_.get());
      wheels_.weigh(*data_);
      mj_step1(model_.model.get(), data_.get());
      wheels_.observe(*data_);
    }
  }
  void step_native() {
    for (int i = 0; i < model_.substeps; ++i) {
      drive();
      mj_step(model_.model.get(), data_.get());
    }
  }

 private:
  DriveTrain robot_;
  MujocoModel model_;
  WheelContacts wheels_;
  MujocoData data_;
};

void run(const std::string& path) {
  const Parameters parameters = read_parameters(path);
  const double period = parameters.loop.period();
  const DriveTrain robot = read_drive_train(load_description(parameters.urdf), parameters.robot);

  MujocoPlantParameters brush = parameters.plant, native = parameters.plant;
  brush.tyre = TyreModel::kBrush;
  native.tyre = TyreModel::kNative;
  brush.sensor_errors = ErrorLevel::kDataSheet;
  MujocoPlant erring(robot, brush, period);
  erring.start();
  brush.sensor_errors = ErrorLevel::kIdeal;
  MujocoPlant plant(robot, brush, period);
  plant.start();
  std::vector<JointCommand> commands(robot.joints.size());
  for (const WheelModel& wheel : robot.wheels) {
    commands[wheel.joint] = {.mode = JointMode::kVelocity,
                             .velocity = wheel_speed(robot, wheel),
                             .damping = wheel_damping(wheel, plant.model().model->opt.timestep)};
  }
  Bare with_tyres(robot, brush, period);
  Bare alone(robot, native, period);

  std::vector<double> plants, errings, bares, natives;
  for (int round = 0; round < kRounds; ++round) {
    plants.push_back(rate([&] { plant.write(commands); }));
    errings.push_back(rate([&] { erring.write(commands); }));
    bares.push_back(rate([&] { with_tyres.step_with_tyres(); }));
    natives.push_back(rate([&] { alone.step_native(); }));
  }
  const std::string unit = "cycles per s";
  const std::string reference = "mj_step1 + tyres + mj_step2";
  print("plant", {{reference, median(bares), unit, median(bares), "itself", 1},
                  {"plant", median(plants), unit, median(bares), reference, median_ratio(plants, bares)},
                  {"plant, sensors err", median(errings), unit, median(bares), reference, median_ratio(errings, bares)},
                  {"native mj_step", median(natives), unit, median(bares), reference, median_ratio(natives, bares)}});
}

}  // namespace robot_control::bench

int main(int argc, char** argv) {
  return robot_control::bench::run_with_parameters(argc, argv, robot_control::bench::run);
}

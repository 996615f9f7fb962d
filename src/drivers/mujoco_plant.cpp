#include "drivers/mujoco_plant.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "drivers/mujoco_errors.h"

namespace robot_control {
namespace {

constexpr double kRestSpeed = 1e-6;  // rad/s, m/s: 60 µm a minute
constexpr int kRestSteps = 100;      // so long at rest, not just at a turning point
constexpr int kSettleSteps = 20000;

}  // namespace

MujocoPlant::MujocoPlant(const RobotModel& robot, const MujocoPlantParameters& parameters, double period)
    : model_(compile_model(robot, parameters, period)), scene_(parameters.scene) {
  for (const WheelModel* wheel : {&robot.left, &robot.right}) {
    check_brake(parameters, robot.joints[wheel->joint].name, wheel->inertia, model_.model->opt.timestep);
  }
  for (const JointModel& joint : robot.joints) laws_.emplace_back(parameters, joint.effort_limit);
  brakes_.resize(robot.joints.size());
}

void MujocoPlant::start() {
  if (faults_ & kFaultSimulationError) {
    throw DriverError("mujoco_plant: MuJoCo raised an error (" + std::string(fault_message()) +
                      "). Start the process anew.");
  }
  data_ = set_down(model_);
  for (JointLaw& law : laws_) law.reset();
  state_ = DriverState::kRunning;
  faults_ = 0;
  fault_message_ = {};
  stopped_ = false;
  joints_ = {};
  imu_ = {};
  truth_ = {};
  settle();
}

void MujocoPlant::settle() {
  mj_step1(model_.model.get(), data_.get());
  std::copy_n(data_->qpos + model_.base_position, 7, origin_.begin());
  int steps_at_rest = 0;
  for (int step = 0; step < kSettleSteps && steps_at_rest < kRestSteps; step += model_.substeps) {
    write(brakes_);
    if (state_ == DriverState::kFault) {
      throw DriverError(scene_ + ": the simulation fails while the robot settles: " + fault_message());
    }
    steps_at_rest = at_rest() ? steps_at_rest + model_.substeps : 0;
  }
  if (steps_at_rest < kRestSteps) {
    throw DriverError(scene_ +
                      ": with its brakes on the robot does not come to rest at the site \"start\". Put the site "
                      "on a plane, z upwards from it, less steep than brakes and friction can hold.");
  }
  data_->time = 0;
  std::copy_n(data_->qpos + model_.base_position, 7, origin_.begin());
  collect();
}

bool MujocoPlant::at_rest() const noexcept {
  const auto slow = [](double speed) { return std::abs(speed) < kRestSpeed; };
  const mjtNum* base = data_->qvel + model_.base_velocity;
  return std::all_of(base, base + 6, slow) && std::all_of(model_.joint_velocity.begin(), model_.joint_velocity.end(),
                                                          [&](int joint) { return slow(data_->qvel[joint]); });
}

void MujocoPlant::read(SensorFrame& sensors) noexcept {
  const bool good = state_ == DriverState::kRunning;
  sensors.driver_state = state_;
  sensors.faults = faults_;
  sensors.valid = good ? kValidJoints | kValidGyro | kValidAccelerometer : 0;
  sensors.joint_count = laws_.size();
  sensors.joints = joints_;
  sensors.imu = imu_;
  sensors.contact_forces = {};
  sensors.digital_inputs = 0;
  sensors.battery_voltage = 0;
  sensors.battery_current = 0;
}

void MujocoPlant::write(std::span<const JointCommand> commands) noexcept {
  if (state_ != DriverState::kRunning) return;
  if (stopped_ || commands.size() != laws_.size()) commands = brakes_;
  effort_sum_ = {};
  normal_force_sum_ = {};
  acceleration_sum_ = {};
  for (int i = 0; i < model_.substeps; ++i) {
    if (!advance(commands)) return;
  }
  if (!finite()) {
    fail(kFaultNotFinite, "NaN or infinity in the state");
    return;
  }
  collect();
}

void MujocoPlant::stop() noexcept {
  stopped_ = true;
}

bool MujocoPlant::truth(TruthFrame& truth) noexcept {
  const FrameHead head = truth.head;
  truth = truth_;
  truth.head = head;
  return true;
}

void MujocoPlant::substep(void* plant) {
  auto& self = *static_cast<MujocoPlant*>(plant);
  mj_step2(self.model_.model.get(), self.data_.get());
  self.add_normal_forces();  // mj_step1 finds the contacts of the new state and leaves their forces behind
  mj_step1(self.model_.model.get(), self.data_.get());
}

bool MujocoPlant::advance(std::span<const JointCommand> commands) noexcept {
  for (std::size_t joint = 0; joint < laws_.size(); ++joint) {
    const int dof = model_.joint_velocity[joint];
    const double effort =
        laws_[joint].step(commands[joint], data_->qpos[model_.joint_position[joint]], data_->qvel[dof]);
    data_->qfrc_applied[dof] = effort;
    effort_sum_[joint] += effort;
  }
  if (!run_guarded(&MujocoPlant::substep, this)) {
    fail(kFaultSimulationError, last_mujoco_message());
    return false;
  }
  for (const mjWarningStat& warning : data_->warning) {
    if (warning.number == 0) continue;
    fail(kFaultSimulationDiverged, last_mujoco_message());
    return false;
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    acceleration_sum_[axis] += data_->sensordata[static_cast<std::size_t>(model_.accelerometer) + axis];
  }
  return true;
}

void MujocoPlant::add_normal_forces() noexcept {
  for (int i = 0; i < data_->ncon; ++i) {
    const mjContact& contact = data_->contact[i];
    for (std::size_t wheel = 0; wheel < 2; ++wheel) {
      const int shape = model_.wheel_shape[wheel];
      if (contact.geom1 != shape && contact.geom2 != shape) continue;
      mjtNum force[6];
      mj_contactForce(model_.model.get(), data_.get(), i, force);
      normal_force_sum_[wheel] += force[0];
    }
  }
}

void MujocoPlant::collect() noexcept {
  for (std::size_t joint = 0; joint < laws_.size(); ++joint) {
    joints_[joint].position = data_->qpos[model_.joint_position[joint]];
    joints_[joint].velocity = data_->qvel[model_.joint_velocity[joint]];
    joints_[joint].effort = effort_sum_[joint] / model_.substeps;
  }
  std::copy_n(data_->sensordata + model_.gyro, 3, imu_.angular_velocity.begin());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    imu_.linear_acceleration[axis] = acceleration_sum_[axis] / model_.substeps;
  }
  collect_truth();
}

void MujocoPlant::collect_truth() noexcept {
  const mjtNum* pose = data_->qpos + model_.base_position;
  const mjtNum* velocity = data_->qvel + model_.base_velocity;
  mjtNum undo[4];
  mju_negQuat(undo, origin_.data() + 3);
  mjtNum moved[3];
  mju_sub3(moved, pose, origin_.data());
  mju_rotVecQuat(truth_.pose_world.position.data(), moved, undo);
  mjtNum turned[4];
  mju_mulQuat(turned, undo, pose + 3);
  truth_.pose_world.orientation = {turned[1], turned[2], turned[3], turned[0]};

  mjtNum to_base[4];
  mju_negQuat(to_base, pose + 3);
  mju_rotVecQuat(truth_.twist_base.linear.data(), velocity, to_base);
  std::copy_n(velocity + 3, 3, truth_.twist_base.angular.begin());

  truth_.joints = joints_;
  for (std::size_t wheel = 0; wheel < 2; ++wheel) {
    truth_.normal_force[wheel] = normal_force_sum_[wheel] / model_.substeps;
    truth_.slip[wheel] = wheel_slip(model_.wheel_shape[wheel]);
  }
}

double MujocoPlant::wheel_slip(int shape) const noexcept {
  const auto velocity_at = [this](int geom, const mjtNum* point, mjtNum* result) {
    mjtNum motion[6];
    mj_objectVelocity(model_.model.get(), data_.get(), mjOBJ_GEOM, geom, motion, 0);
    mjtNum lever[3];
    mju_sub3(lever, point, data_->geom_xpos + 3 * geom);
    mju_cross(result, motion, lever);
    mju_addTo3(result, motion + 3);
  };
  double slip = 0;
  for (int i = 0; i < data_->ncon; ++i) {
    const mjContact& contact = data_->contact[i];
    if (contact.geom1 != shape && contact.geom2 != shape) continue;
    mjtNum first[3], second[3];
    velocity_at(contact.geom1, contact.pos, first);
    velocity_at(contact.geom2, contact.pos, second);
    mju_subFrom3(first, second);
    mju_addToScl3(first, contact.frame, -mju_dot3(first, contact.frame));
    slip = std::max(slip, mju_norm3(first));
  }
  return slip;
}

bool MujocoPlant::finite() const noexcept {
  const auto is_finite = [](double value) { return std::isfinite(value); };
  return std::all_of(data_->qpos, data_->qpos + model_.model->nq, is_finite) &&
         std::all_of(data_->qvel, data_->qvel + model_.model->nv, is_finite) &&
         std::all_of(data_->sensordata, data_->sensordata + model_.model->nsensordata, is_finite) &&
         std::all_of(acceleration_sum_.begin(), acceleration_sum_.end(), is_finite) &&
         std::all_of(normal_force_sum_.begin(), normal_force_sum_.end(), is_finite);
}

void MujocoPlant::fail(std::uint64_t fault, const char* message) noexcept {
  state_ = DriverState::kFault;
  faults_ |= fault;
  std::strncpy(fault_message_.data(), message, fault_message_.size() - 1);
}

}  // namespace robot_control

#include "drivers/mujoco/mujoco_plant.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "drivers/mujoco/contact/rest.h"
#include "drivers/mujoco/motors/brake_limits.h"
#include "drivers/mujoco/motors/velocity_drives.h"
#include "drivers/mujoco/mujoco_errors.h"
#include "machine/description/wording.h"
#include "machine/suspicions.h"

namespace robot_control {
namespace {

constexpr double kRestSpeed = 1e-6;       // m/s and rad/s of the base: 60 µm per minute
constexpr double kLastRestSpeed = 3e-5;   // 1 mm in 30 s
constexpr double kJointRestSpeed = 1e-3;  // m/s and rad/s
constexpr double kLastJointSpeed = std::numeric_limits<double>::infinity();  // a caster in the air may keep swinging
constexpr double kRestTime = 0.1;   // s; excludes a turning point of an oscillation
constexpr double kSettleTime = 20;  // s

/// Refuses a battery that cannot feed the electronics even without the motors.
void check_battery(double voltage, double resistance) {
  const double max_resistance = voltage / (2 * kIdleCurrent);
  if (voltage <= 0 || resistance <= max_resistance) return;
  throw DriverError("mujoco_plant: battery_resistance is " + number(resistance) + " ohm; a battery of " +
                    number(voltage) + " V (battery_voltage) with more than " + number(max_resistance) +
                    " ohm cannot feed the robot's electronics. Set less.");
}

std::vector<Rim> rims_of(const TrueRobot& robot) {
  std::vector<Rim> rims;
  for (std::size_t i = 0; i < robot.drive_wheels; ++i)
    rims.push_back({robot.wheels[i].joint, robot.wheels[i].shape.radius});
  return rims;
}

}  // namespace

MujocoPlant::MujocoPlant(const MachineModel& robot, const MujocoPlantParameters& parameters, double period)
    : model_(compile_model(robot, parameters, period)),
      paths_(*model_.model),
      wheels_(model_, parameters),
      bodies_(model_),
      parameters_(parameters),
      specific_force_(model_),
      sensor_errors_(model_.robot, rims_of(model_.robot), parameters, period),
      sensor_faults_(model_.robot, parameters.seed),
      period_(period),
      contacts_(std::min(model_.robot.drive_wheels > 0 ? wheels_.count() : bodies_.count(), kMaxContacts)),
      actuator_delay_(checked_delay("actuator_delay", parameters.actuator_delay)) {
  const double step = model_.model->opt.timestep;
  for (const std::size_t joint : model_.actuated) {
    const JointModel& model = model_.robot.joints[joint];
    laws_.emplace_back(brake_of(model_.robot, joint, parameters, step), model.effort_limit);
    motors_.emplace_back(model.effort_limit, model.role == JointRole::kDriven ? parameters.no_load_speed : 0,
                         parameters.gear_ratio);
    motor_faults_.add(joint, inertia_of(model_.robot, joint, parameters), model.effort_limit, parameters.seed, step);
  }
  drives_ = velocity_drives(model_.robot, parameters, step);
  brakes_.resize(robot.joints.size());
  check_battery(parameters.battery_voltage, parameters.battery_resistance);
}

std::unique_ptr<Simulator> MujocoPlant::clone() const {
  std::unique_ptr<MujocoPlant> copy(new MujocoPlant(*this));
  if (data_) copy->data_ = MujocoData(mj_copyData(nullptr, model_.model.get(), data_.get()));
  if (laser_) copy->laser_ = std::make_shared<Laser>(copy->model_, parameters_, origin_, period_);
  return copy;
}

void MujocoPlant::start() {
  if (faults_ & kFaultSimulationError) {
    throw DriverError("mujoco_plant: MuJoCo raised an error (" + std::string(fault_message()) +
                      "). Restart the process.");
  }
  data_ = set_down(model_);
  paths_.place(0, *data_);
  wheels_.reset();
  bodies_.reset();
  for (JointLaw& law : laws_) law.reset();
  for (VelocityDrive& drive : drives_) drive.reset();
  state_ = DriverState::kStarting;
  faults_ = 0;
  fault_message_ = {};
  stopped_ = false;
  exact_ = {};
  truth_ = {};
  injected_ = {};
  motor_faults_.reset();
  sensor_errors_.reset();
  sensor_faults_.reset();
  actuator_delay_.fill({});
  settled_ = false;
  settle();
  // The origin is the same after every start. The laser is made once, because another thread uses it.
  if (parameters_.laser.rate > 0 && !laser_) laser_ = std::make_shared<Laser>(model_, parameters_, origin_, period_);
  state_ = DriverState::kRunning;
  cycle_ = 0;
  measure();
}

/// Sets the origin of truth: the position of the base and its heading in the ground plane. Its tilt against the plane
/// is part of its pose.
void MujocoPlant::set_origin() {
  const mjtNum* base = data_->qpos + model_.base_position;
  const Eigen::Vector3d up(model_.up[0], model_.up[1], model_.up[2]);
  const Eigen::Vector3d forward = Eigen::Quaterniond(base[3], base[4], base[5], base[6]) * Eigen::Vector3d::UnitX();
  Eigen::Matrix3d axes;
  axes.col(2) = up;
  axes.col(0) = (forward - forward.dot(up) * up).normalized();
  axes.col(1) = up.cross(axes.col(0));
  const Eigen::Quaterniond orientation(axes);
  origin_ = {base[0], base[1], base[2], orientation.w(), orientation.x(), orientation.y(), orientation.z()};
}

void MujocoPlant::settle() {
  std::string where = model_.robot.source + " in scene " + parameters_.scene;
  if (parameters_.payload > 0) where.append(" with a payload of ").append(number(parameters_.payload)).append(" kg");
  where += ": ";
  const auto refuse = [&](const std::string& text) {
    const std::string suspicions = suspicions_of(model_.robot);
    throw DriverError(where + text + (suspicions.empty() ? "" : " " + suspicions));
  };
  const double step = model_.model->opt.timestep;
  mj_step1(model_.model.get(), data_.get());
  wheels_.observe(*data_);
  specific_force_.reset(*data_);
  set_origin();
  double rested = 0;
  for (double time = 0; time < kSettleTime && rested < kRestTime; time += model_.substeps * step) {
    simulate(brakes_);
    if (state_ == DriverState::kFault) {
      refuse(std::string("the simulation fails while the robot settles: ").append(fault_message()).append("."));
    }
    if (fallen(model_, *data_)) {
      refuse(
          "the robot falls over at its start. Check its centre of gravity, its support, and the ground around the site "
          "\"start\".");
    }
    rested = at_rest(model_, *data_, kRestSpeed, kJointRestSpeed) ? rested + model_.substeps * step : 0;
  }
  const std::string side = unloaded_side(model_, wheels_);
  const std::string standing = links_on_ground(model_, *data_);
  if (!side.empty() && !standing.empty()) {
    refuse("its " + side + " wheels carry no load; on the ground is " + standing +
           ". Check how low the wheels reach, and the other <collision> shapes.");
  }
  if (rested < kRestTime && !at_rest(model_, *data_, kLastRestSpeed, kLastJointSpeed)) {
    const std::vector<std::string> moving = moving_joints(model_, *data_, kJointRestSpeed);
    refuse("with its brakes on the robot does not come to rest at the site \"start\". " +
           (moving.empty() ? ""
                           : "These joints move, give them a <limit effort> that holds them: " + list(moving) + ". ") +
           "Put the site on a plane, z upwards from it, less steep than brakes and friction can hold" +
           (model_.robot.drive_wheels == 0
                ? "."
                : "; where the centre of gravity lies over the only axle, put it where casters "
                  "carry a part of it."));
  }
  // The text is the same after every start and is set only once, because other threads read it.
  if (!has_rested_) {
    unloaded_ = unloaded_wheels(model_, wheels_);
    if (!unloaded_.empty()) {
      unloaded_ += unloaded_.find(", ") == std::string::npos ? " bears" : " bear";
      unloaded_ +=
          " no load at rest, on the ground " + (standing.empty() ? "are the other wheels" : "stand " + standing);
    }
    has_rested_ = true;
  }
  data_->time = 0;
  set_origin();
  const double push[3] = {parameters_.push_x, parameters_.push_y, parameters_.push_z};
  mju_rotVecQuat(push_.data(), push, data_->qpos + model_.base_position + 3);
  settled_ = true;
  collect();
}

void MujocoPlant::read(SensorFrame& sensors) noexcept {
  const bool good = state_ == DriverState::kRunning;
  sensors.driver_state = state_;
  sensors.faults = faults_;
  if (!read_) {
    copy_readings(brakes_.size(), contacts_, measured_, handed_out_);
    lost_ = sensor_faults_.step(injected_, cycle_, handed_out_);
    read_ = true;
  }
  sensors.valid = good ? equipped() & ~lost_ : 0;
  sensors.joint_count = brakes_.size();
  copy_first(brakes_.size(), handed_out_.joints, sensors.joints);
  sensors.imu = handed_out_.imu;
  sensors.contact_count = parameters_.contact_sensors ? contacts_ : 0;
  copy_first(contacts_, handed_out_.contacts, sensors.contacts);
  if (!good) {
    set_joints_valid(sensors, 0);
    for (ContactSample& contact : sensors.contacts) contact.valid = 0;
  }
  sensors.digital_inputs = handed_out_.digital_inputs;
  sensors.battery_voltage = handed_out_.battery.voltage;
  sensors.battery_current = handed_out_.battery.current;
  sensors.injected = injected_;
}

std::uint64_t MujocoPlant::equipped() const noexcept {
  std::uint64_t devices = kValidGyro | kValidAccelerometer;
  if (parameters_.battery_voltage > 0) devices |= kValidBattery;
  return devices;
}

void MujocoPlant::write(std::span<const JointCommand> commands) noexcept {
  if (state_ != DriverState::kRunning) return;
  if (commands.size() != brakes_.size()) commands = brakes_;
  commands = received(commands);
  simulate(motor_faults_.receive(injected_, cycle_, stopped_ ? brakes_ : commands));
  if (state_ != DriverState::kRunning) return;
  ++cycle_;
  measure();
}

std::span<const JointCommand> MujocoPlant::received(std::span<const JointCommand> commands) noexcept {
  if (actuator_delay_.delay() == 0) return commands;
  std::copy(commands.begin(), commands.end(), received_.begin());
  actuator_delay_.step(received_);
  return {received_.data(), commands.size()};
}

void MujocoPlant::simulate(std::span<const JointCommand> commands) noexcept {
  effort_sum_ = {};
  normal_force_sum_ = {};
  specific_force_sum_.setZero();
  if (parameters_.contact_sensors) force_sum_.fill(Eigen::Vector3d::Zero());
  power_sum_ = 0;
  for (int i = 0; i < model_.substeps; ++i) {
    if (!advance(commands)) return;
  }
  if (!finite()) {
    fail(kFaultNotFinite, "NaN or infinity in the state");
    return;
  }
  collect();
}

void MujocoPlant::truth(TruthFrame& truth) noexcept {
  truth.pose_world = truth_.pose_world;
  truth.twist_base = truth_.twist_base;
  copy_first(brakes_.size(), truth_.joints, truth.joints);
  truth.contact_count = truth_.contact_count;
  copy_first(contacts_, truth_.normal_force, truth.normal_force);
  copy_first(contacts_, truth_.slip, truth.slip);
}

std::uint64_t MujocoPlant::scan_cycles() const noexcept {
  const double rate = parameters_.laser.rate;
  return rate > 0 ? static_cast<std::uint64_t>(std::max(1.0, std::round(1 / (rate * period_)))) : 0;
}

void MujocoPlant::substep(void* plant) {
  auto& self = *static_cast<MujocoPlant*>(plant);
  mj_step2(self.model_.model.get(), self.data_.get());
  self.wheels_.weigh(*self.data_);
  self.bodies_.weigh(*self.data_);  // before mj_step1, which finds the new contacts without their forces
  if (self.settled_) self.paths_.place(self.data_->time, *self.data_);
  mj_step1(self.model_.model.get(), self.data_.get());
}

bool MujocoPlant::advance(std::span<const JointCommand> commands) noexcept {
  std::fill_n(data_->qfrc_applied, model_.model->nv, 0.0);
  for (std::size_t drive = 0; drive < laws_.size(); ++drive) {
    const std::size_t joint = model_.actuated[drive];
    const int dof = model_.joint_velocity[joint];
    const double position = data_->qpos[model_.joint_position[joint]];
    const double velocity = data_->qvel[dof], measured = position + sensor_errors_.zero_error(drive);
    const double asked = joint < drives_.size() ? drives_[joint].step(commands[joint], velocity)
                                                : laws_[drive].step(commands[joint], measured, velocity);
    const double wanted = motors_[drive].limited(asked, velocity);
    const double effort = motor_faults_.effort(drive, commands[joint].mode, wanted, position, velocity);
    data_->qfrc_applied[dof] = effort;
    effort_sum_[joint] += effort;
    power_sum_ += effort * velocity;
  }
  wheels_.apply(*data_);
  if (settled_ && parameters_.push_duration > 0) push();
  if (!run_guarded(&MujocoPlant::substep, this)) {
    fail(kFaultSimulationError, last_mujoco_message());
    return false;
  }
  for (const mjWarningStat& warning : data_->warning) {
    if (warning.number == 0) continue;
    fail(kFaultSimulationDiverged, last_mujoco_message());
    return false;
  }
  wheels_.observe(*data_);
  specific_force_sum_ += specific_force_.step(*data_);
  const bool on_wheels = model_.robot.drive_wheels > 0;
  for (std::size_t i = 0; i < contacts_; ++i) {
    normal_force_sum_[i] += on_wheels ? wheels_.normal_force(i) : bodies_.normal_force(i);
    if (parameters_.contact_sensors) force_sum_[i] += on_wheels ? wheels_.force(i) : bodies_.force(i);
  }
  return true;
}

// The time is shifted by half a step, so that its rounding does not change the first step of the push.
void MujocoPlant::push() noexcept {
  const double since = data_->time - parameters_.push_start + model_.model->opt.timestep / 2;
  const bool acts = since >= 0 && since < parameters_.push_duration;
  const int body = model_.base_body;
  mjtNum* applied = data_->xfrc_applied + 6 * body;
  mjtNum lever[3];
  mju_sub3(lever, data_->xpos + 3 * body, data_->xipos + 3 * body);
  mju_scl3(applied, push_.data(), acts ? 1 : 0);
  mju_cross(applied + 3, lever, applied);
}

void MujocoPlant::collect() noexcept {
  for (std::size_t joint = 0; joint < brakes_.size(); ++joint) {
    JointSample& sample = exact_.joints[joint];
    sample.position = data_->qpos[model_.joint_position[joint]];
    sample.velocity = data_->qvel[model_.joint_velocity[joint]];
    sample.effort = effort_sum_[joint] / model_.substeps;
    sample.valid = kValidMotion;
  }
  std::copy_n(data_->sensordata + model_.gyro, 3, exact_.imu.angular_velocity.begin());
  Eigen::Map<Eigen::Vector3d>(exact_.imu.linear_acceleration.data()) = specific_force_sum_ / model_.substeps;
  if (parameters_.contact_sensors) {
    for (std::size_t i = 0; i < contacts_; ++i) {
      Eigen::Map<Eigen::Vector3d>(exact_.contacts[i].force.data()) = force_sum_[i] / model_.substeps;
      exact_.contacts[i].valid = 1;
    }
  }
  if (parameters_.battery_voltage > 0) {
    exact_.battery =
        battery_under_load(parameters_.battery_voltage, parameters_.battery_resistance, power_sum_ / model_.substeps);
  }
  collect_truth();
}

void MujocoPlant::measure() noexcept {
  copy_readings(brakes_.size(), contacts_, exact_, measured_);
  sensor_errors_.step(measured_);
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    measured_.joints[i].effort = std::numeric_limits<double>::quiet_NaN();
    measured_.joints[i].valid &= ~std::uint32_t{kValidEffort};
    if (parameters_.drive_feed_forward) measured_.joints[i].valid |= kTakesEffort;
  }
  read_ = false;
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

  copy_first(brakes_.size(), exact_.joints, truth_.joints);
  truth_.contact_count = contacts_;
  for (std::size_t i = 0; i < contacts_; ++i) {
    truth_.normal_force[i] = normal_force_sum_[i] / model_.substeps;
    truth_.slip[i] = model_.robot.drive_wheels > 0 ? wheels_.slip(i) : bodies_.slip(i);
  }
}

/// MuJoCo checks positions and velocities: a bad one is a warning.
bool MujocoPlant::finite() const noexcept {
  double zero = 0;  // NaN as soon as one number is NaN or infinite
  const auto add = [&zero](const double* values, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) zero += 0 * values[i];
  };
  add(data_->sensordata, static_cast<std::size_t>(model_.model->nsensordata));
  add(specific_force_sum_.data(), 3);
  add(normal_force_sum_.data(), contacts_);
  return zero == 0;
}

void MujocoPlant::fail(std::uint64_t fault, const char* message) noexcept {
  state_ = DriverState::kFault;
  faults_ |= fault;
  fault_message_ = {};
  std::string_view(message).copy(fault_message_.data(), fault_message_.size() - 1);
}

}  // namespace robot_control

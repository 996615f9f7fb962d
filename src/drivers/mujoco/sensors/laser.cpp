#include "drivers/mujoco/sensors/laser.h"

#include <cmath>
#include <limits>

#include "drivers/driver.h"
#include "drivers/mujoco/model/mjcf.h"
#include "drivers/mujoco/sensors/normal_stream.h"
#include "machine/bodies/added_laser.h"
#include "machine/bodies/rigid_bodies.h"

namespace robot_control {
namespace {

constexpr float kNothing = std::numeric_limits<float>::infinity();

void check(const LaserParameters& laser) {
  if (laser.angle_max <= laser.angle_min)
    throw DriverError("mujoco_plant.laser: angle_max must be greater than angle_min. Rays turn from x towards y.");
  if (laser.range_max <= laser.range_min)
    throw DriverError("mujoco_plant.laser: range_max must be greater than range_min.");
}

}  // namespace

Laser::Laser(const MujocoModel& model, const MujocoPlantParameters& parameters, const std::array<double, 7>& origin,
             double period)
    : model_(model),
      laser_(parameters.laser),
      seed_(parameters.seed),
      origin_(origin),
      period_(period),
      paths_(*model.model),
      data_(mj_makeData(model.model.get())) {
  check(laser_);
  const RigidBodies& robot = *model.robot.bodies;
  const auto place = robot.links.find(laser_.link);
  if (place == robot.links.end()) {
    throw DriverError(robot.source + ": there is no link \"" + laser_.link +
                      "\" for the laser. Add one, name another link of the URDF (mujoco_plant.laser.link), or set " +
                      "robot.simulated_laser: true, which adds " + kLaserLink + ".");
  }
  in_body_ = place->second.in_body;
  body_ = mj_name2id(model.model.get(), mjOBJ_BODY, mjcf_body_name(robot.bodies[place->second.body].name).c_str());
}

void Laser::place(const TruthFrame& truth) {
  mjtNum* const base = data_->qpos + model_.base_position;
  mju_rotVecQuat(base, truth.pose_world.position.data(), origin_.data() + 3);
  mju_addTo3(base, origin_.data());
  const Quaternion& q = truth.pose_world.orientation;
  const mjtNum turn[4] = {q[3], q[0], q[1], q[2]};
  mju_mulQuat(base + 3, origin_.data() + 3, turn);
  for (std::size_t joint = 0; joint < model_.joint_position.size(); ++joint)
    data_->qpos[model_.joint_position[joint]] = truth.joints[joint].position;
  paths_.place(static_cast<double>(truth.head.cycle) * period_, *data_);
  mj_kinematics(model_.model.get(), data_.get());
}

LaserScan Laser::scan(const TruthFrame& truth) {
  constexpr mjtByte kSeen[mjNGROUP] = {1, 0, 1, 1, 1, 0};
  static_assert(kGlassGroup == 1 && kRobotGroup == 5);
  place(truth);
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> axes(data_->xmat + 9 * body_);
  const Eigen::Vector3d eye = Eigen::Map<Eigen::Vector3d>(data_->xpos + 3 * body_) + axes * in_body_.translation();
  NormalStream random;
  random.seed(seed_, kLaserStream + truth.head.cycle);
  LaserScan scan{.head = truth.head,
                 .link = laser_.link,
                 .angle_min = laser_.angle_min,
                 .angle_increment = (laser_.angle_max - laser_.angle_min) / static_cast<double>(laser_.rays),
                 .range_min = laser_.range_min,
                 .range_max = laser_.range_max,
                 .ranges = {}};
  for (std::uint64_t ray = 0; ray < laser_.rays; ++ray) {
    const double angle = scan.angle_min + static_cast<double>(ray) * scan.angle_increment;
    const Eigen::Vector3d along = axes * (in_body_.linear() * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0));
    int shape = -1;
    const double distance = mj_ray(model_.model.get(), data_.get(), eye.data(), along.data(), kSeen, 1, -1, &shape);
    const bool dropped = random.uniform() < 2 * laser_.drop_outs - 1;
    const double range = distance + laser_.noise * random.next();
    const bool back = shape >= 0 && model_.model->geom_group[shape] != kBlackGroup && range <= laser_.range_max;
    scan.ranges.push_back(!back || dropped           ? kNothing
                          : range < laser_.range_min ? -kNothing
                                                     : static_cast<float>(range));
  }
  return scan;
}

}  // namespace robot_control

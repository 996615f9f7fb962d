#include "robot/drive_wheels.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "description/urdf_document.h"
#include "description/wording.h"
#include "robot/named_wheels.h"
#include "robot/wheel.h"
#include "robot/wheel_pairs.h"

namespace robot_control {
namespace {

constexpr double kUpright = 0.8;  // |z| of a swivel's axis: within 37° of the vertical
constexpr int kBisections = 60;   // to the last bit

double lowest_point(const WheelModel& wheel) {
  return wheel.centre_base[2] - wheel.radius;
}

const RigidBody* swivel_of(const RigidBodies& robot, std::size_t body) {
  for (std::size_t i = robot.bodies[body].parent; i != 0; i = robot.bodies[i].parent) {
    const RigidBody& ancestor = robot.bodies[i];
    const bool turns = ancestor.joint.type != JointType::kPrismatic;
    if (turns && std::abs((ancestor.in_root.linear() * ancestor.joint.axis).z()) > kUpright) return &ancestor;
  }
  return nullptr;
}

double trail(const RigidBody& swivel, const RollingMeasure& wheel) {
  const Eigen::Vector3d axis = swivel.in_root.linear() * swivel.joint.axis;
  const Eigen::Vector3d rolling = wheel.axle_in_root.cross(axis).normalized();
  const Eigen::Vector3d centre(wheel.wheel.centre_base[0], wheel.wheel.centre_base[1], wheel.wheel.centre_base[2]);
  return std::abs((centre - swivel.in_root.translation()).dot(rolling));
}

double suspension_travel(const RigidBodies& robot, std::size_t body) {
  double travel = 0;
  for (std::size_t i = robot.bodies[body].parent; i != 0; i = robot.bodies[i].parent) {
    const BodyJoint& joint = robot.bodies[i].joint;
    if (joint.type == JointType::kPrismatic) travel += std::max(std::abs(joint.lower), std::abs(joint.upper));
  }
  return travel;
}

bool looks_like_a_wheel(const RigidBodies& robot, const std::string& joint) {
  return lower_case(joint).find("wheel") != std::string::npos || robot.driven_joints.contains(joint);
}

class Search {
 public:
  explicit Search(const RigidBodies& robot) : robot_(robot) {
    for (const auto& [name, type] : robot.joints) {
      if (type == JointType::kFixed && looks_like_a_wheel(robot, name))
        reject(name, "it is fixed, a wheel has to turn");
    }
    for (std::size_t i = 1; i < robot.bodies.size(); ++i) consider(i);
    rolling_ = candidates_.size();
    drop_those_above_the_floor();
    drop_those_on_the_middle_line();
  }

  std::vector<RollingBody> drive_wheels() const {
    if (candidates_.empty()) {
      refuse(robot_.source, "<robot>", "no drive wheels found: " + (rejected_.empty() ? "no joint turns" : rejected_),
             remedy());
    }
    std::vector<RollingBody> driven;
    for (const RollingBody& candidate : candidates_) {
      if (robot_.bodies[candidate.body].joint.driven) driven.push_back(candidate);
    }
    if (driven.empty() && rolling_ > kMaxWheels) {
      refuse(robot_.source, "<robot>",
             std::to_string(rolling_) + " wheels roll, and nothing says which of them drive: tracks are not supported",
             remedy());
    }
    std::string objection;
    for (std::vector<RollingBody> pairs : {driven, candidates_}) {
      if (pairs.empty()) continue;
      objection = sort_into_pairs(robot_, pairs);
      if (objection.empty() && driven.empty()) objection = hanging_objection(pairs);
      if (objection.empty()) return pairs;
    }
    std::string text = "which wheels drive is not clear: " + objection + ". Candidates: ";
    for (const RollingBody& candidate : candidates_) {
      text += (&candidate == &candidates_.front() ? "" : "; ") + described(robot_, candidate);
    }
    if (!rejected_.empty()) text += ". Not: " + rejected_;
    refuse(robot_.source, "<robot>", text, remedy());
  }

 private:
  static std::string remedy() {
    return "Name the wheels' joints by robot/left_wheel_joints: […] and robot/right_wheel_joints: […]; they must "
           "turn about the lateral (y) axis and have a round <collision> shape";
  }

  void reject(const std::string& joint, const std::string& reason) {
    rejected_ += (rejected_.empty() ? "" : "; ") + joint + ": " + reason;
    if (robot_.unsaid_axes.contains(joint)) rejected_ += " (and no <axis xyz=\"…\"> is given)";
  }

  void consider(std::size_t index) {
    const RigidBody& body = robot_.bodies[index];
    const std::string& joint = body.joint.name;
    const bool named = looks_like_a_wheel(robot_, joint);
    if (body.joint.type == JointType::kPrismatic && !named) return;
    const RollingMeasure measure = measure_wheel(body);
    const bool turns = body.joint.type != JointType::kPrismatic;
    if (turns && axle_tilt(measure) > kAxleTolerance) {
      return reject(joint, "its axis is " + number(axle_tilt(measure) * 180 / M_PI) + "° off the lateral (y) axis of " +
                               robot_.bodies[0].name + ", 0.2° are allowed");
    }
    if (!measure.objection.empty()) return reject(joint, measure.objection);
    if (swivel_of(robot_, index) != nullptr) return reject(joint, "it stands behind a swivel");
    if (!body.joint.mimicked.empty()) return reject(joint, "it follows " + body.joint.mimicked);
    candidates_.push_back({index, measure.wheel});
  }

  void drop_those_above_the_floor() {
    double floor = std::numeric_limits<double>::infinity();
    for (const RollingBody& candidate : candidates_) floor = std::min(floor, lowest_point(candidate.wheel));
    std::erase_if(candidates_, [&](const RollingBody& candidate) {
      const double gap = lowest_point(candidate.wheel) - floor;
      if (gap <= kFloorTolerance + suspension_travel(robot_, candidate.body)) return false;
      reject(robot_.bodies[candidate.body].joint.name, "it ends " + number(gap) + " m above the lowest wheel");
      hanging_.push_back(candidate);
      return true;
    });
  }

  /// Smaller wheels whose hubs are level with those of the drive wheels.
  std::string hanging_objection(const std::vector<RollingBody>& wheels) const {
    for (const RollingBody& hanging : hanging_) {
      for (const RollingBody& wheel : wheels) {
        if (std::abs(hanging.wheel.centre_base[2] - wheel.wheel.centre_base[2]) > kFloorTolerance) continue;
        return "their radii differ by more than 1 %: " + described(robot_, hanging) + " and " +
               described(robot_, wheel);
      }
    }
    return "";
  }

  void drop_those_on_the_middle_line() {
    if (candidates_.empty()) return;
    double middle = 0;
    if (candidates_.size() > 1) {
      const auto by_y = [](const RollingBody& a, const RollingBody& b) {
        return a.wheel.centre_base[1] < b.wheel.centre_base[1];
      };
      const auto [right, left] = std::minmax_element(candidates_.begin(), candidates_.end(), by_y);
      middle = (right->wheel.centre_base[1] + left->wheel.centre_base[1]) / 2;
    }
    std::erase_if(candidates_, [&](const RollingBody& candidate) {
      const double away = std::abs(candidate.wheel.centre_base[1] - middle);
      if (away > std::max(kFloorTolerance, 0.1 * candidate.wheel.radius)) return false;
      reject(robot_.bodies[candidate.body].joint.name,
             "it stands on the middle line, y " + number(middle) + " m, halfway between the outermost wheels");
      return true;
    });
  }

  const RigidBodies& robot_;
  std::vector<RollingBody> candidates_;
  std::vector<RollingBody> hanging_;  // above the floor
  std::size_t rolling_ = 0;           // candidates at any height
  std::string rejected_;
};

void note_lying_names(const RigidBodies& robot, const RollingBody& wheel, std::vector<RobotNote>& notes) {
  const RigidBody& body = robot.bodies[wheel.body];
  const std::string names = body.joint.name + " " + body.name;
  const bool left = wheel.wheel.side == Side::kLeft;
  if (left ? says_left(names) || !says_right(names) : says_right(names) || !says_left(names)) return;
  notes.push_back({RobotNote::Kind::kSuspicious, joint_element(body.joint.name),
                   std::string("its name says ") + (left ? "right" : "left") + ", but it is the " +
                       (left ? "left" : "right") + " wheel: y is " + number(wheel.wheel.centre_base[1]) + " m"});
}

/// Whether it rolls, sets `omni`.
bool judge_swivel(const RigidBodies& robot, std::size_t body, RollingMeasure& measure, std::vector<RobotNote>& notes) {
  const RigidBody* swivel = swivel_of(robot, body);
  measure.wheel.omni = swivel == nullptr;
  const bool follows = swivel != nullptr && trail(*swivel, measure) >= kLeastTrail * measure.wheel.radius;
  if (follows) return true;
  notes.push_back({RobotNote::Kind::kAssumed, joint_element(robot.bodies[body].joint.name),
                   measure.wheel.omni
                       ? "no swivel turns it: it slides sideways without friction, as an omni wheel does"
                       : "it stands below its swivel, which cannot turn it: it slides without friction"});
  return measure.wheel.omni;
}

std::vector<RollingBody> find_casters(const RigidBodies& robot, const std::vector<RollingBody>& wheels,
                                      std::vector<RobotNote>& notes) {
  std::set<std::size_t> taken;
  double floor = std::numeric_limits<double>::infinity();
  for (const RollingBody& wheel : wheels) {
    taken.insert(wheel.body);
    floor = std::min(floor, lowest_point(wheel.wheel));
  }
  std::vector<RollingBody> casters;
  for (std::size_t i = 1; i < robot.bodies.size(); ++i) {
    if (taken.contains(i)) continue;
    RollingMeasure measure = measure_wheel(robot.bodies[i]);
    if (!measure.objection.empty() || lowest_point(measure.wheel) - floor > kCasterTolerance) continue;
    if (judge_swivel(robot, i, measure, notes)) casters.push_back({i, measure.wheel});
  }
  return casters;
}

}  // namespace

DriveTrain find_drive_train(const RigidBodies& robot, const RobotParameters& parameters,
                            std::vector<RobotNote>& notes) {
  DriveTrain train;
  const bool named = !parameters.left_wheel_joints.empty() || !parameters.right_wheel_joints.empty();
  train.wheels = named ? named_wheels(robot, parameters) : Search(robot).drive_wheels();
  if (train.wheels.size() > kMaxWheels) {
    refuse(robot.source, "<robot>", std::to_string(train.wheels.size()) + " drive wheels",
           "At most " + std::to_string(kMaxWheels) + " are supported; tracks are not");
  }
  for (const RollingBody& wheel : train.wheels) note_lying_names(robot, wheel, notes);
  train.casters = find_casters(robot, train.wheels, notes);
  return train;
}

double wheel_base_of(const std::vector<RollingBody>& wheels) {
  const std::size_t axles = wheels.size() / 2;
  double sum = 0;
  for (std::size_t i = 0; i < axles; ++i) {
    sum += wheels[i].wheel.centre_base[1] - wheels[axles + i].wheel.centre_base[1];
  }
  return sum / static_cast<double>(axles);
}

double scrub_multiplier(const std::vector<RollingBody>& wheels) {
  if (wheels.size() == 2) return 1;
  const double base = wheel_base_of(wheels);
  double mean = 0;
  for (const RollingBody& wheel : wheels) mean += wheel.wheel.centre_base[0] / static_cast<double>(wheels.size());
  double least = 0, most = 0;
  for (const RollingBody& wheel : wheels) {
    most = std::max(most, 2 * std::pow(wheel.wheel.centre_base[0] - mean, 2) / base);
  }
  for (int i = 0; i < kBisections; ++i) {
    const double slip = (least + most) / 2;
    double moment = 0;
    for (const RollingBody& wheel : wheels) {
      const double x = wheel.wheel.centre_base[0] - mean;
      moment += (base * slip / 2 - x * x) / std::hypot(slip, x);
    }
    (moment < 0 ? least : most) = slip;
  }
  return 1 + (least + most) / base;
}

}  // namespace robot_control

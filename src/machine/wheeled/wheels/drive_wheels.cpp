#include "machine/wheeled/wheels/drive_wheels.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include "machine/description/urdf_document.h"
#include "machine/description/wording.h"
#include "machine/wheeled/wheels/named_wheels.h"
#include "machine/wheeled/wheels/other_drives.h"
#include "machine/wheeled/wheels/rollers.h"
#include "machine/wheeled/wheels/swivel.h"
#include "machine/wheeled/wheels/wheel_pairs.h"

namespace robot_control {
namespace {

constexpr int kBisections = 60;  // down to the last bit

double lowest_point(const WheelModel& wheel) {
  return wheel.centre_base[2] - wheel.radius;
}

constexpr double kNearAxle = 10 * M_PI / 180;  // an axis within it is meant to be lateral

std::string joined(const std::vector<std::string>& sentences) {
  std::string text;
  for (const std::string& sentence : sentences) text += (text.empty() ? "" : "; ") + sentence;
  return text;
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
      if (type == JointType::kFixed && looks_like_a_wheel(robot, name)) reject(name, kFixedWheel, kContinuous);
    }
    for (std::size_t i = 1; i < robot.bodies.size(); ++i) consider(i);
    rolling_ = candidates_.size();
    drop_those_above_the_floor();
    drop_those_on_the_middle_line();
  }

  /// Notes wheels with the size of the drive wheels that do not reach the floor: they are not driven, probably by
  /// mistake.
  void note_hanging(const std::vector<RollingBody>& wheels, std::vector<RobotNote>& notes) const {
    const WheelModel& wheel = wheels.front().wheel;
    for (const RollingBody& hanging : hanging_) {
      if (std::abs(hanging.wheel.radius - wheel.radius) > kPairTolerance * wheel.radius) continue;
      const BodyJoint& joint = robot_.bodies[hanging.body].joint;
      if (joint.driven) continue;  // other_drives.h
      notes.push_back({RobotNote::Kind::kSuspicious, joint_element(joint.name),
                       "a wheel with the radius of the drive wheels, whose lowest point is " +
                           number(1000 * (lowest_point(hanging.wheel) - lowest_point(wheel))) +
                           " mm above theirs: assumed passive, only " + std::to_string(wheels.size()) +
                           " wheels drive. If it drives: " + kSetWheels});
    }
  }

  std::vector<RollingBody> drive_wheels() const {
    if (candidates_.empty()) {
      refuse_unclear("no drive wheels found", rejected_.empty() ? "no joint turns" : joined(others()),
                     rejected_.empty() ? kContinuous : fix());
    }
    std::vector<RollingBody> driven;
    for (const RollingBody& candidate : candidates_) {
      if (robot_.bodies[candidate.body].joint.driven) driven.push_back(candidate);
    }
    const bool bound = !driven.empty();
    if (!bound && rolling_ > kMaxWheels) {
      refuse(robot_.source, "<robot>",
             "it is not clear which of " + std::to_string(rolling_) + " wheels drive, and tracks are not supported",
             kSetWheels);
    }
    std::vector<RollingBody> pairs = bound ? driven : candidates_;
    PairObjection objection = sort_into_pairs(robot_, pairs);
    if (objection.found.empty() && !bound) objection = hanging_objection(pairs);
    if (objection.found.empty()) return pairs;
    std::string text = bound ? "the file names " + list(names_of(driven)) + " as driven, but " : "";
    text += objection.found + ". Candidates: ";
    for (const RollingBody& candidate : candidates_) {
      text += (&candidate == &candidates_.front() ? "" : "; ") + described(robot_, candidate);
    }
    if (!others().empty()) text += ". Excluded: " + joined(others());
    refuse_unclear("it is not clear which wheels drive", text, objection.fix == kSetWheels ? fix() : objection.fix);
  }

 private:
  /// Rollers, and joints that are nearly wheels, are named first: a message about pairs would lead to another fault.
  [[noreturn]] void refuse_unclear(const std::string& problem, const std::string& found,
                                   const std::string& remedy) const {
    const std::string rest = "without that, " + problem + (found.empty() ? "" : ": " + found);
    if (roller_wheel_) {
      const auto& [index, rollers] = *roller_wheel_;
      refuse(robot_.source, joint_element(robot_.bodies[index].joint.name), rollers_objection(rollers), rest,
             kRollersRemedy);
    }
    if (near_ > 0)
      refuse(robot_.source, "<robot>", joined({rejected_.begin(), rejected_.begin() + near_}), rest, fix());
    refuse(robot_.source, "<robot>", problem, found, remedy);
  }

  /// Returns the rejected joints that are not nearly wheels.
  std::vector<std::string> others() const { return {rejected_.begin() + near_, rejected_.end()}; }

  std::vector<std::string> names_of(const std::vector<RollingBody>& wheels) const {
    std::vector<std::string> names;
    for (const RollingBody& wheel : wheels) names.push_back(robot_.bodies[wheel.body].joint.name);
    return names;
  }

  /// Returns true if the body follows another wheel, which makes it a drive wheel, too.
  bool follows_a_wheel(const RigidBody& body) const {
    const RigidBody* leader = robot_.moved_by(body.joint.mimicked);
    if (leader == nullptr || swivel_of(robot_, static_cast<std::size_t>(leader - robot_.bodies.data())) != nullptr) {
      return false;
    }
    const RollingMeasure measure = measure_wheel(*leader);
    return measure.objection.empty() && axle_tilt(measure) <= kAxleTolerance;
  }

  /// Returns the change that makes a wheel of the first rejected joint that is meant to have one.
  std::string fix() const { return fixes_.empty() ? kSetWheels : fixes_.front(); }

  /// One that is `nearly` a wheel comes before the others.
  void reject(const std::string& joint, const std::string& reason, const std::string& fix, bool nearly = false) {
    if (nearly || looks_like_a_wheel(robot_, joint)) fixes_.insert(nearly ? fixes_.begin() + near_ : fixes_.end(), fix);
    std::string text = joint + ": " + reason;
    if (robot_.unsaid_axes.contains(joint)) text += " (it has no <axis xyz=\"…\">)";
    if (robot_.turned_joints.contains(joint)) text += " (its <origin rpy=\"…\"> looks like degrees)";
    rejected_.insert(nearly ? rejected_.begin() + near_ : rejected_.end(), text);
    if (nearly) ++near_;
  }

  void consider(std::size_t index) {
    const RigidBody& body = robot_.bodies[index];
    const std::string& joint = body.joint.name;
    if (rollers_of(robot_, body.parent) > 0) return;
    if (const std::size_t rollers = rollers_of(robot_, index); rollers > 0) {
      if (!roller_wheel_) roller_wheel_ = {index, rollers};
      return reject(joint, rollers_objection(rollers), kRollersRemedy);
    }
    const bool named = looks_like_a_wheel(robot_, joint);
    if (body.joint.type == JointType::kPrismatic && !named) return;
    const RollingMeasure measure = measure_wheel(body);
    const bool turns = body.joint.type != JointType::kPrismatic;
    if (turns && axle_tilt(measure) > kAxleTolerance) {
      return reject(joint,
                    "its axis is " + number(axle_tilt(measure) * 180 / M_PI) + "° off the lateral (y) axis of " +
                        robot_.bodies[0].name + ", allowed is 0.2°",
                    kLateralAxis, axle_tilt(measure) < kNearAxle);
    }
    if (!measure.objection.empty()) return reject(joint, measure.objection, measure.fix, measure.nearly);
    if (const RigidBody* swivel = swivel_of(robot_, index); swivel != nullptr) {
      return reject(joint,
                    std::string("it is mounted on a swivel, ") + swivel->joint.name +
                        (is_steered(*swivel, body, measure) ? ", which steers it" : ""),
                    kSetWheels);
    }
    if (!body.joint.mimicked.empty() && !follows_a_wheel(body)) {
      return reject(joint, "it follows " + body.joint.mimicked, kSetWheels);
    }
    candidates_.push_back(rolling_body_of(index, measure));
  }

  void drop_those_above_the_floor() {
    double floor = std::numeric_limits<double>::infinity();
    for (const RollingBody& candidate : candidates_) floor = std::min(floor, lowest_point(candidate.wheel));
    std::erase_if(candidates_, [&](const RollingBody& candidate) {
      const double gap = lowest_point(candidate.wheel) - floor;
      if (gap <= kFloorTolerance + suspension_travel(robot_, candidate.body)) return false;
      reject(robot_.bodies[candidate.body].joint.name,
             "its lowest point is " + number(gap) + " m above the lowest wheel", kSetWheels);
      hanging_.push_back(candidate);
      return true;
    });
  }

  /// Returns the objection to smaller wheels whose hubs are level with those of the drive wheels.
  PairObjection hanging_objection(const std::vector<RollingBody>& wheels) const {
    for (const RollingBody& hanging : hanging_) {
      for (const RollingBody& wheel : wheels) {
        if (std::abs(hanging.wheel.centre_base[2] - wheel.wheel.centre_base[2]) > kFloorTolerance) continue;
        return {
            "their radii differ by more than 1 %: " + described(robot_, hanging) + " and " + described(robot_, wheel),
            kOneRadius};
      }
    }
    return {};
  }

  void drop_those_on_the_middle_line() {
    if (candidates_.empty()) return;
    double middle = 0, half = 0;
    if (candidates_.size() > 1) {
      const auto by_y = [](const RollingBody& a, const RollingBody& b) {
        return a.wheel.centre_base[1] < b.wheel.centre_base[1];
      };
      const auto [right, left] = std::minmax_element(candidates_.begin(), candidates_.end(), by_y);
      middle = (right->wheel.centre_base[1] + left->wheel.centre_base[1]) / 2;
      half = (left->wheel.centre_base[1] - right->wheel.centre_base[1]) / 2;
    }
    std::erase_if(candidates_, [&](const RollingBody& candidate) {
      const double away = std::abs(candidate.wheel.centre_base[1] - middle);
      if (away > std::max(kFloorTolerance, std::min(0.1 * candidate.wheel.radius, half / 2))) return false;
      reject(robot_.bodies[candidate.body].joint.name,
             "it is on the middle line, y " + length(middle) + " m, halfway between the outermost wheels", kSetWheels);
      return true;
    });
  }

  const RigidBodies& robot_;
  std::vector<RollingBody> candidates_;
  std::vector<RollingBody> hanging_;   // candidates above the floor
  std::size_t rolling_ = 0;            // number of candidates at any height
  std::vector<std::string> rejected_;  // joints with the reason
  std::vector<std::string> fixes_;     // of those that are nearly wheels, or have the name of one
  std::ptrdiff_t near_ = 0;            // number of the first ones that are nearly wheels
  std::optional<std::pair<std::size_t, std::size_t>> roller_wheel_;  // body of the first one, and number of its rollers
};

/// A wheel's angle is relative to the body that carries it. On another wheel it would be the sum of both angles.
void refuse_wheels_on_wheels(const RigidBodies& robot, const std::vector<RollingBody>& wheels) {
  for (const RollingBody& wheel : wheels) {
    for (std::size_t i = robot.bodies[wheel.body].parent; i != 0; i = robot.bodies[i].parent) {
      if (std::ranges::find(wheels, i, &RollingBody::body) == wheels.end()) continue;
      refuse(robot.source, joint_element(robot.bodies[wheel.body].joint.name),
             "its parent moves with another drive wheel, " + robot.bodies[i].joint.name,
             "Set the same <parent> for both joints, the body that carries them");
    }
  }
}

void note_lying_names(const RigidBodies& robot, const RollingBody& wheel, std::vector<RobotNote>& notes) {
  const RigidBody& body = robot.bodies[wheel.body];
  const std::string names = body.joint.name + " " + body.name;
  const bool left = wheel.wheel.side == Side::kLeft;
  if (left ? says_left(names) || !says_right(names) : says_right(names) || !says_left(names)) return;
  notes.push_back({RobotNote::Kind::kSuspicious, joint_element(body.joint.name),
                   std::string("its name contains ") + (left ? "right" : "left") + ", but it is the " +
                       (left ? "left" : "right") + " wheel: y is " + length(wheel.wheel.centre_base[1]) + " m"});
}

void note_out_of_round(const RigidBodies& robot, const RollingBody& wheel, std::vector<RobotNote>& notes) {
  if (!(wheel.out_of_round > 0)) return;
  notes.push_back({RobotNote::Kind::kSuspicious, link_element(robot.bodies[wheel.body].name),
                   "out of round: it reaches " + number(wheel.out_of_round * 1000) +
                       " mm farther from its axle than most of its rim, whose radius of " + number(wheel.wheel.radius) +
                       " m is used"});
}

/// Returns whether the caster rolls, and sets `omni`.
bool judge_swivel(const RigidBodies& robot, const RollingMeasure& measure, RollingBody& caster,
                  std::vector<RobotNote>& notes) {
  const RigidBody* swivel = swivel_of(robot, caster.body);
  caster.wheel.omni = swivel == nullptr;
  const bool follows = swivel != nullptr && trails(*swivel, measure);
  if (follows) return true;
  notes.push_back({RobotNote::Kind::kAssumed, joint_element(robot.bodies[caster.body].joint.name),
                   caster.wheel.omni
                       ? "it has no swivel: assumed to slide sideways without friction, like an omni wheel"
                       : "it is centred below its swivel, which cannot turn it: assumed to slide without friction"});
  return caster.wheel.omni;
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
    const RollingMeasure measure = measure_wheel(robot.bodies[i]);
    RollingBody caster = rolling_body_of(i, measure);
    if (!measure.objection.empty() || lowest_point(caster.wheel) - floor > kCasterTolerance) continue;
    if (judge_swivel(robot, measure, caster, notes)) casters.push_back(caster);
  }
  return casters;
}

}  // namespace

RollingBody rolling_body_of(std::size_t body, const RollingMeasure& measure) {
  return {.body = body,
          .wheel = {.centre_base = measure.centre_base,
                    .radius = measure.radius,
                    .width = measure.width,
                    .sign = measure.axle_in_root.y() > 0 ? 1.0 : -1.0,
                    .inertia = measure.inertia},
          .out_of_round = measure.out_of_round};
}

RunningGear find_running_gear(const RigidBodies& robot, const DriveTrainParameters& parameters,
                              std::vector<RobotNote>& notes) {
  RunningGear gear;
  const bool named = !parameters.left_wheel_joints.empty() || !parameters.right_wheel_joints.empty();
  if (named) {
    gear.wheels = named_wheels(robot, parameters);
  } else {
    const Search search(robot);
    gear.wheels = search.drive_wheels();
    search.note_hanging(gear.wheels, notes);
  }
  if (gear.wheels.size() > kMaxWheels) {
    refuse(robot.source, "<robot>", std::to_string(gear.wheels.size()) + " drive wheels",
           "Set at most " + std::to_string(kMaxWheels) + " wheel joints; tracks are not supported");
  }
  refuse_wheels_on_wheels(robot, gear.wheels);
  for (const RollingBody& wheel : gear.wheels) note_lying_names(robot, wheel, notes);
  for (const RollingBody& wheel : gear.wheels) note_out_of_round(robot, wheel, notes);
  gear.casters = find_casters(robot, gear.wheels, notes);
  judge_other_drives(robot, gear, named, notes);
  return gear;
}

void release_followers(RigidBodies& robot, const RunningGear& gear, std::vector<RobotNote>& notes) {
  for (const RollingBody& wheel : gear.wheels) {
    BodyJoint& joint = robot.bodies[wheel.body].joint;
    if (joint.mimicked.empty()) continue;
    notes.push_back({RobotNote::Kind::kSuspicious, joint_element(joint.name),
                     "<mimic joint=\"" + joint.mimicked + "\"> is ignored: a drive wheel has a motor of its own"});
    joint.mimicked.clear();
  }
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
  double least = 0, largest = 0;
  for (const RollingBody& wheel : wheels) {
    largest = std::max(largest, 2 * std::pow(wheel.wheel.centre_base[0] - mean, 2) / base);
  }
  for (int i = 0; i < kBisections; ++i) {
    const double slip = (least + largest) / 2;
    double moment = 0;
    for (const RollingBody& wheel : wheels) {
      const double x = wheel.wheel.centre_base[0] - mean;
      moment += (base * slip / 2 - x * x) / std::hypot(slip, x);
    }
    (moment < 0 ? least : largest) = slip;
  }
  return 1 + (least + largest) / base;
}

}  // namespace robot_control

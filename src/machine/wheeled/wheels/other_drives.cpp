#include "machine/wheeled/wheels/other_drives.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "machine/bodies/rolling.h"
#include "machine/description/wording.h"
#include "machine/wheeled/feet.h"
#include "machine/wheeled/wheels/rollers.h"
#include "machine/wheeled/wheels/swivel.h"

namespace robot_control {
namespace {

constexpr double kCrossAngle = 5 * M_PI / 180;
constexpr double kRadiusTolerance = 0.1;  // share of the radius

const char* const kRemedy =
    "Set robot.left_wheel_joints: […] and robot.right_wheel_joints: […] to drive it as a differential or skid-steer "
    "drive; no other drive is supported";

constexpr const char* kPlain =
    "they are driven like plain wheels: the robot does not move sideways, and its turns differ";

class Judge {
 public:
  Judge(const RigidBodies& robot, const RunningGear& gear, bool named, std::vector<RobotNote>& notes)
      : robot_(robot), gear_(gear), named_(named), notes_(notes) {
    for (std::size_t i = 1; i < robot.bodies.size(); ++i) {
      if (!is_drive_wheel(i)) check(i);
    }
    judge_names();
  }

 private:
  bool is_drive_wheel(std::size_t body) const {
    return std::any_of(gear_.wheels.begin(), gear_.wheels.end(),
                       [body](const RollingBody& wheel) { return wheel.body == body; });
  }

  bool turns_on_a_drive_wheel(std::size_t body) const {
    for (std::size_t i = robot_.bodies[body].parent; i != 0; i = robot_.bodies[i].parent) {
      if (is_drive_wheel(i)) return true;
    }
    return false;
  }

  void check(std::size_t index) {
    const RigidBody& body = robot_.bodies[index];
    if (rollers_of(robot_, body.parent) > 0) return;
    if (const std::size_t rollers = rollers_of(robot_, index); rollers > 0) return judge_rollers(body, rollers);
    const RollingMeasure measure = measure_wheel(body);
    if (!measure.objection.empty() || turns_on_a_drive_wheel(index)) return;
    if (measure.centre_base[2] - measure.radius > floor_height(gear_) + kCasterTolerance) return;
    const RigidBody* swivel = swivel_of(robot_, index);
    if (swivel != nullptr && is_steered(*swivel, body, measure)) {
      return refuse_or_note(body,
                            "it is steered by " + swivel->joint.name + ", out of the direction of the drive wheels");
    }
    if (swivel == nullptr && is_crosswise(body, measure)) {
      return refuse_or_note(body, "it reaches the floor, and its axis is " + number(axle_tilt(measure) * 180 / M_PI) +
                                      "° off the lateral (y) axis of " + robot_.bodies[0].name +
                                      ": the drive wheels would drag it sideways, except omni wheels");
    }
    if (!body.joint.driven && (swivel == nullptr || !swivel->joint.driven)) return;
    if (swivel == nullptr && on_the_middle_line(measure)) {
      return refuse_or_note(body, "the file names it as driven, but it is on the middle line between the others");
    }
    notes_.push_back({RobotNote::Kind::kSuspicious, joint_element(body.joint.name),
                      std::string("the file names it, or its swivel, as driven; it is not driven: it ") +
                          (swivel != nullptr ? "follows its swivel as a caster" : "rolls freely")});
  }

  bool is_crosswise(const RigidBody& body, const RollingMeasure& measure) const {
    const Shape* shape = rolling_shape(body);
    if (axle_tilt(measure) <= kCrossAngle) return false;
    if (body.joint.driven) return true;
    const bool ball = shape != nullptr && shape->type == ShapeType::kSphere;
    const double radius = gear_.wheels.front().wheel.radius;
    const bool alike = std::abs(measure.radius - radius) <= kRadiusTolerance * radius;
    return !ball && alike && no_drive_is_said();
  }

  bool no_drive_is_said() const {
    return std::none_of(gear_.wheels.begin(), gear_.wheels.end(),
                        [this](const RollingBody& wheel) { return robot_.bodies[wheel.body].joint.driven; });
  }

  /// A passive omni wheel is a caster. Its height above the floor is its radius.
  void judge_rollers(const RigidBody& body, std::size_t rollers) {
    const double radius = gear_.wheels.front().wheel.radius;
    const double height = body.in_root.translation().z() - floor_height(gear_);
    const bool alike = std::abs(height - radius) <= kRadiusTolerance * radius;
    if (body.joint.driven) refuse_or_note(body, "the file names it as driven, but " + rollers_objection(rollers));
    if (!body.joint.driven && alike && no_drive_is_said()) {
      refuse_or_note(body, "it is as high as the drive wheels and may be driven, but " + rollers_objection(rollers));
    }
  }

  /// Checks the wheel's own names, and not that of the whole robot.
  void judge_names() {
    if (named_) return;  // note_sideways_names reports it.
    for (const RollingBody& wheel : gear_.wheels) {
      const RigidBody& body = robot_.bodies[wheel.body];
      for (const std::string word : {"mecanum", "omni"}) {
        const auto says = [&](const std::string& name) { return lower_case(name).find(word) != std::string::npos; };
        if (!says(body.joint.name + " " + body.name) || says(robot_.bodies[0].name + " " + robot_.name)) continue;
        refuse(robot_.source, joint_element(body.joint.name),
               "its name contains " + word + ": such a wheel also rolls sideways, and only plain wheels are supported",
               kRemedy);
      }
    }
  }

  bool on_the_middle_line(const RollingMeasure& measure) const {
    double middle = 0;
    for (const RollingBody& wheel : gear_.wheels) {
      middle += wheel.wheel.centre_base[1] / static_cast<double>(gear_.wheels.size());
    }
    return std::abs(measure.centre_base[1] - middle) < wheel_base_of(gear_.wheels) / 4;
  }

  void refuse_or_note(const RigidBody& body, const std::string& text) {
    if (!named_) refuse(robot_.source, joint_element(body.joint.name), text, kRemedy);
    notes_.push_back({RobotNote::Kind::kSuspicious, joint_element(body.joint.name), text});
  }

  const RigidBodies& robot_;
  const RunningGear& gear_;
  bool named_;
  std::vector<RobotNote>& notes_;
};

void note_plugins(const RigidBodies& robot, std::vector<RobotNote>& notes) {
  for (const std::string& plugin : robot.sideways_plugins) {
    notes.push_back(
        {RobotNote::Kind::kSuspicious, "<plugin> " + plugin,
         "it also moves a robot sideways: the wheels may be omni or mecanum wheels; " + std::string(kPlain)});
  }
  for (const std::string& plugin : robot.steering_plugins) {
    notes.push_back(
        {RobotNote::Kind::kSuspicious, "<plugin> " + plugin,
         "it steers wheels: the robot is driven as a differential drive, only by the speeds of its wheels"});
  }
}

/// A caster may be an omni wheel, and a part that does not roll may be called so. Two wheels are no omni drive, unless
/// their own names say so.
bool is_of_the_drive(const RigidBodies& robot, const RunningGear& gear, const SidewaysName& name) {
  const std::size_t body = name.link.empty() ? 0 : robot.links.at(name.link).body;
  if (std::ranges::find(gear.wheels, body, &RollingBody::body) != gear.wheels.end()) return true;
  if (gear.wheels.size() == 2 || std::ranges::find(gear.casters, body, &RollingBody::body) != gear.casters.end()) {
    return false;
  }
  return name.link.empty() || name.link == robot.bodies[0].name || name.word != "omni";
}

void note_sideways_names(const RigidBodies& robot, const RunningGear& gear, std::vector<RobotNote>& notes) {
  std::set<std::string> others;
  const SidewaysName* first = nullptr;
  for (const SidewaysName& name : robot.sideways_names) {
    if (!is_of_the_drive(robot, gear, name)) continue;
    if (first == nullptr) first = &name;
    if (name.element != first->element) others.insert(name.element);
  }
  if (first == nullptr) return;
  const std::string more = others.empty() ? "" : ", as " + std::to_string(others.size()) + " other names do";
  notes.push_back({RobotNote::Kind::kSuspicious, first->element,
                   "its name contains " + first->word + more + ": if the wheels are such, " + kPlain});
}

}  // namespace

void judge_other_drives(const RigidBodies& robot, const RunningGear& gear, bool named, std::vector<RobotNote>& notes) {
  note_plugins(robot, notes);
  note_sideways_names(robot, gear, notes);
  const Judge judge(robot, gear, named, notes);
}

}  // namespace robot_control

#include "machine/bodies/body_joint.h"

#include <cmath>

#include "machine/description/urdf_document.h"
#include "machine/description/wording.h"

namespace robot_control {
namespace {

JointType type_of(const urdf::Joint& joint) {
  if (joint.type == urdf::Joint::CONTINUOUS) return JointType::kContinuous;
  return joint.type == urdf::Joint::REVOLUTE ? JointType::kRevolute : JointType::kPrismatic;
}

void note_negative(const char* attribute, double value, const std::string& element, std::vector<RobotNote>& notes) {
  if (!(value < 0)) return;
  notes.push_back({RobotNote::Kind::kSuspicious, element,
                   std::string(attribute) + "=\"" + number(value) + "\"> is negative: taken as not given"});
}

void read_limits(const urdf::JointLimits& limits, const std::string& source, double endless, BodyJoint& joint,
                 std::vector<RobotNote>& notes) {
  const std::string element = joint_element(joint.name);
  joint.effort_limit = limits.effort > 0 ? limits.effort : 0;
  joint.velocity_limit = limits.velocity > 0 ? limits.velocity : 0;
  note_negative("<limit effort", limits.effort, element, notes);
  note_negative("<limit velocity", limits.velocity, element, notes);
  if (joint.type == JointType::kContinuous) return;
  if (!(limits.lower <= limits.upper)) {
    refuse(source, element, "<limit> from " + number(limits.lower) + " to " + number(limits.upper),
           "Set lower not greater than upper");
  }
  const double range = limits.upper - limits.lower;
  const bool degrees = limits.upper == 180 || limits.upper == 360;
  if (joint.type == JointType::kRevolute && degrees) {
    notes.push_back({RobotNote::Kind::kSuspicious, element,
                     "upper=\"" + number(limits.upper) + "\" is in radians; check whether degrees were meant"});
  }
  if (joint.type == JointType::kRevolute && range > endless) {
    joint.type = JointType::kContinuous;
    notes.push_back(
        {RobotNote::Kind::kAssumed, element, "a range of " + number(range) + " rad has no end: taken as continuous"});
    return;
  }
  if (range == 0) {
    notes.push_back({RobotNote::Kind::kSuspicious, element, "lower equals upper: assumed to have no limits"});
    return;
  }
  joint.lower = limits.lower;
  joint.upper = limits.upper;
}

bool finite(const BodyJoint& joint) {
  return joint.axis.allFinite() && std::isfinite(joint.effort_limit) && std::isfinite(joint.velocity_limit) &&
         std::isfinite(joint.lower) && std::isfinite(joint.upper) && std::isfinite(joint.damping) &&
         std::isfinite(joint.friction) && std::isfinite(joint.mimic_multiplier) && std::isfinite(joint.mimic_offset);
}

}  // namespace

BodyJoint read_joint(const urdf::Joint& joint, const std::string& source, double endless,
                     std::vector<RobotNote>& notes) {
  BodyJoint result;
  result.name = joint.name;
  result.type = type_of(joint);
  const Eigen::Vector3d axis(joint.axis.x, joint.axis.y, joint.axis.z);
  if (!(axis.norm() > 0) || !std::isfinite(axis.norm())) {
    refuse(source, joint_element(joint.name), "its <axis> is zero", "Set a direction, such as xyz=\"0 1 0\"");
  }
  result.axis = axis.normalized();
  if (joint.limits) read_limits(*joint.limits, source, endless, result, notes);
  if (joint.dynamics) {
    result.damping = std::max(0.0, joint.dynamics->damping);
    result.friction = std::max(0.0, joint.dynamics->friction);
    note_negative("<dynamics damping", joint.dynamics->damping, joint_element(joint.name), notes);
    note_negative("<dynamics friction", joint.dynamics->friction, joint_element(joint.name), notes);
  }
  if (joint.mimic) {
    result.mimicked = joint.mimic->joint_name;
    result.mimic_multiplier = joint.mimic->multiplier;
    result.mimic_offset = joint.mimic->offset;
  }
  if (!finite(result)) {
    refuse(source, joint_element(joint.name), "a number in it is not finite", "Set finite numbers");
  }
  if (const double loss = std::max(result.damping, result.friction); loss > kMaxPlausible) {
    refuse(source, joint_element(joint.name), "<dynamics> of " + number(loss),
           "Set damping in N·m·s/rad or N·s/m, and friction in N·m or N");
  }
  return result;
}

}  // namespace robot_control

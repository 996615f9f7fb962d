#include "drivers/mujoco/model/mjcf.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "drivers/mujoco/model/mjcf_shapes.h"
#include "machine/bodies/posed_bodies.h"

namespace robot_control {
namespace {

constexpr double kSwivelPart = 0.02;
constexpr double kSupportFactor = 4;

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string attribute(const std::string& name, const std::string& value) {
  return ' ' + name + "=\"" + value + '"';
}

std::string attribute(const std::string& name, double value) {
  return attribute(name, mjcf_number(value));
}

Eigen::Vector3d eigen(const Vector3& v) {
  return {v[0], v[1], v[2]};
}

// Returns the rotation from the z axis to `axis`, which may have any length. Eigen's FromTwoVectors would double the
// compile time of this file by its singular value decomposition.
Eigen::Quaterniond from_z(const Eigen::Vector3d& axis) {
  const Eigen::Vector3d to = axis.normalized();
  const double s = std::sqrt(2 * (1 + to.z()));  // twice the cosine of half the angle of rotation
  if (s < 1e-6) return {0, 1, 0, 0};
  const Eigen::Vector3d turn = Eigen::Vector3d::UnitZ().cross(to) * (1 / s);
  return {s / 2, turn.x(), turn.y(), turn.z()};
}

class Writer {
 public:
  Writer(const TrueRobot& model, const MujocoPlantParameters& parameters, bool at_rest)
      : model_(model),
        robot_(*model.bodies),
        posed_(at_rest ? resting(robot_, model.joints) : robot_),
        at_rest_(at_rest),
        parameters_(parameters) {}

  std::string write(const MjcfPlace& place) {
    std::string text = "<mujoco" + attribute("model", escaped(robot_.name)) + ">\n";
    if (!place.scene_file.empty()) text += "<include" + attribute("file", escaped(place.scene_file)) + "/>\n";
    Eigen::Isometry3d base = Eigen::Isometry3d::Identity();
    base.translation() = Eigen::Vector3d(place.pose[0], place.pose[1], place.pose[2]);
    base.linear() = Eigen::Quaterniond(place.pose[3], place.pose[4], place.pose[5], place.pose[6]).toRotationMatrix();
    write_body(0, base);
    // A viewer then opens with the robot in view instead of all the ground.
    text += "<statistic extent=\"1\"" + attribute("center", mjcf_numbers(base.translation())) + "/>\n";
    text += "<asset>\n" + assets_ + "</asset>\n<worldbody>\n" + place.terrain + bodies_ + "</worldbody>\n";
    text += "<equality>\n" + equalities_ + "</equality>\n<sensor>\n";
    text += "<gyro" + attribute("name", kMjcfGyro) + attribute("site", kMjcfImu) +
            " noise=\"0\" cutoff=\"0\"/>\n</sensor>\n</mujoco>\n";
    return text;
  }

 private:
  void write_body(std::size_t index, const Eigen::Isometry3d& in_parent) {
    const RigidBody& body = robot_.bodies[index];
    bodies_ += "<body" + attribute("name", escaped(mjcf_body_name(body.name))) + mjcf_pose(in_parent) + ">\n";
    if (index == 0) {
      bodies_ += "<freejoint/>\n";
    } else {
      write_joint(body);
    }
    write_inertia(body);
    if (index == 0) write_imu();
    write_shapes(body);
    for (std::size_t child = index + 1; child < robot_.bodies.size(); ++child) {
      if (robot_.bodies[child].parent == index)
        write_body(child, posed_.bodies[index].in_root.inverse() * posed_.bodies[child].in_root);
    }
    bodies_ += "</body>\n";
  }

  void write_joint(const RigidBody& body) {
    const BodyJoint& joint = body.joint;
    const TrueWheel* rolling = wheel_of(model_, body);
    const JointModel& model = *std::find_if(model_.joints.begin(), model_.joints.end(),
                                            [&](const JointModel& other) { return other.name == joint.name; });
    const bool driven = model.role == JointRole::kDriven;
    const bool slides = joint.type == JointType::kPrismatic;
    const bool limited = model.range.has_value();
    const double gear = parameters_.gear_ratio;
    const double damping = joint.damping + (driven ? gear * gear * parameters_.motor_damping : 0);
    const double friction = joint.friction + (driven ? gear * parameters_.motor_friction : 0);
    const double rotor = model.role == JointRole::kPassive
                             ? swivel_inertia(body)
                             : model.rotor_inertia + (driven ? gear * gear * parameters_.rotor_inertia : 0);
    const double armature = rolling != nullptr ? rolling->rotor_inertia : rotor;
    bodies_ +=
        "<joint" + attribute("name", escaped(joint.name)) + attribute("type", slides ? "slide" : "hinge") +
        " pos=\"0 0 0\"" + attribute("axis", mjcf_numbers(joint.axis)) +
        attribute("limited", limited ? "true" : "false") +
        attribute("range", slides && limited ? mjcf_number(model.range->lower) + ' ' + mjcf_number(model.range->upper)
                                             : "-1 1") +
        attribute("springref", slides ? spring_reference(joint) : 0) + attribute("stiffness", joint.spring_stiffness) +
        attribute("armature", armature) + attribute("damping", damping) + attribute("frictionloss", friction) +
        " ref=\"0\" margin=\"0\" solreflimit=\".004 1\" solimplimit=\".9 .95 .001 .5 2\" solreffriction=\".004 1\""
        " solimpfriction=\".9999 .9999 .001 .5 2\"/>\n";
    if (joint.mimicked.empty()) return;
    equalities_ += "<joint" + attribute("joint1", escaped(joint.name)) + attribute("joint2", escaped(joint.mimicked)) +
                   attribute("polycoef", mjcf_number(at_rest_ ? 0 : joint.mimic_offset) + ' ' +
                                             mjcf_number(joint.mimic_multiplier) + " 0 0 0") +
                   " active=\"true\" solref=\".004 1\" solimp=\".99 .999 .001 .5 2\"/>\n";
  }

  static double spring_reference(const BodyJoint& joint) {
    return joint.spring_stiffness > 0 ? joint.spring_load / joint.spring_stiffness : 0;
  }

  // Returns the armature of a swivel that carries rolling casters.
  double swivel_inertia(const RigidBody& body) const {
    double radius = 0;
    for (const TrueWheel& caster : std::span(model_.wheels).subspan(model_.drive_wheels)) {
      const RigidBody& wheel = *robot_.moved_by(model_.joints[caster.joint].name);
      if (robot_.bodies[wheel.parent].name == body.name) radius = std::max(radius, caster.shape.radius);
    }
    return body.joint.type == JointType::kPrismatic ? 0 : kSwivelPart * model_.mass / kSupportFactor * radius * radius;
  }

  void write_inertia(const RigidBody& body) {
    const Eigen::Matrix3d& i = body.inertia;
    bodies_ += "<inertial" + attribute("pos", mjcf_numbers(body.centre_of_gravity)) + attribute("mass", body.mass) +
               attribute("fullinertia", mjcf_numbers(i.diagonal()) + ' ' + mjcf_numbers({i(0, 1), i(0, 2), i(1, 2)})) +
               "/>\n";
  }

  void write_imu() {
    const Quaternion& q = model_.imu_in_base.orientation;
    Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
    frame.translation() = eigen(model_.imu_in_base.position);
    frame.linear() = Eigen::Quaterniond(q[3], q[0], q[1], q[2]).toRotationMatrix();
    bodies_ += "<site" + attribute("name", kMjcfImu) + " type=\"sphere\" size=\"0.01\"" + mjcf_pose(frame) + "/>\n";
  }

  void write_shapes(const RigidBody& body) {
    if (const TrueWheel* wheel = wheel_of(model_, body)) {
      Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
      frame.translation() = body.in_root.inverse() * eigen(wheel->shape.centre_base);
      frame.linear() = from_z(body.joint.axis).toRotationMatrix();
      bodies_ += mjcf_rolling_shape(mjcf_wheel_name(static_cast<std::size_t>(wheel - model_.wheels.data())), frame,
                                    *wheel, parameters_);
      return;
    }
    for (const Shape& shape : body.shapes) {
      std::string mesh;
      if (shape.type == ShapeType::kMesh) {
        mesh = "robot_control/mesh/" + std::to_string(meshes_++);
        assets_ += mjcf_mesh(mesh, shape.points);
      }
      const std::string name = "robot_control/shape/" + std::to_string(shapes_++) + '/' + escaped(shape.link);
      bodies_ += mjcf_shape(name, shape, mesh, model_.wheels.empty() ? Grip::kGround : Grip::kNone, parameters_);
    }
  }

  const TrueRobot& model_;
  const RigidBodies& robot_;
  const RigidBodies posed_;
  const bool at_rest_;
  const MujocoPlantParameters& parameters_;
  std::size_t meshes_ = 0, shapes_ = 0;
  std::string assets_, bodies_, equalities_;
};

}  // namespace

std::string mjcf_body_name(const std::string& link) {
  return link == "world" ? "robot_control/world" : link;
}

std::string mjcf_wheel_name(std::size_t wheel) {
  return "robot_control/wheel/" + std::to_string(wheel);
}

std::string robot_mjcf(const TrueRobot& robot, const MujocoPlantParameters& parameters, const MjcfPlace& place) {
  return Writer(robot, parameters, place.at_rest).write(place);
}

void apply_angles(const TrueRobot& robot, mjModel& model) {
  for (std::size_t index = 1; index < robot.bodies->bodies.size(); ++index) {
    const BodyJoint& joint = robot.bodies->bodies[index].joint;
    const int id = mj_name2id(&model, mjOBJ_JOINT, joint.name.c_str());
    if (model.jnt_type[id] != mjJNT_HINGE) continue;
    if (model.jnt_limited[id]) {
      model.jnt_range[2 * id] = joint.lower;
      model.jnt_range[2 * id + 1] = joint.upper;
    }
    if (joint.spring_stiffness > 0) {
      model.qpos_spring[model.jnt_qposadr[id]] = joint.spring_load / joint.spring_stiffness;
    }
  }
}

}  // namespace robot_control

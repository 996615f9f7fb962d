#include "drivers/mjcf.h"

#include <algorithm>
#include <limits>
#include <locale>
#include <sstream>

#include "hal/driver.h"
#include "robot/wheel.h"

namespace robot_control {
namespace {

const char* const kContact =
    R"( contype="2" conaffinity="1" friction="0 0 0" solmix="1e6" solref=".004 1" solimp=".99 .999 .001 .5 2")"
    R"( margin="0" gap="0" mass="0")";

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

std::string pose(const Eigen::Isometry3d& frame) {
  const Eigen::Vector3d p = frame.translation();
  const Eigen::Quaterniond q(frame.linear());
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out.precision(17);
  out << " pos=\"" << p.x() << ' ' << p.y() << ' ' << p.z() << "\" quat=\"" << q.w() << ' ' << q.x() << ' ' << q.y()
      << ' ' << q.z() << '"';
  return out.str();
}

class Writer {
 public:
  Writer(const RigidBodies& robot, const RobotModel& model) : robot_(robot), model_(model) {
    out_.imbue(std::locale::classic());
    out_.precision(17);
  }

  std::string write(const std::string& scene_file) {
    out_ << "<mujoco model=\"" << escaped(robot_.name) << "\">\n<include file=\"" << escaped(scene_file)
         << "\"/>\n<worldbody>\n";
    write_body(0);
    out_ << "</worldbody>\n<sensor>\n<gyro name=\"" << kMjcfGyro << "\" site=\"" << kMjcfImu
         << "\" noise=\"0\" cutoff=\"0\"/>\n<accelerometer name=\"" << kMjcfAccelerometer << "\" site=\"" << kMjcfImu
         << "\" noise=\"0\" cutoff=\"0\"/>\n</sensor>\n</mujoco>\n";
    return out_.str();
  }

 private:
  void write_body(std::size_t index) {
    const RigidBody& body = robot_.bodies[index];
    const Eigen::Isometry3d in_parent =
        index == 0 ? Eigen::Isometry3d::Identity() : robot_.bodies[body.parent].in_root.inverse() * body.in_root;
    out_ << "<body name=\"" << escaped(body.name) << '"' << pose(in_parent) << ">\n";
    write_joint(body.joint);
    write_inertia(body);
    if (index == 0) write_imu();
    for (const Shape& shape : body.shapes) write_shape(body, shape);
    for (std::size_t child = index + 1; child < robot_.bodies.size(); ++child) {
      if (robot_.bodies[child].parent == index) write_body(child);
    }
    out_ << "</body>\n";
  }

  void write_joint(const BodyJoint& joint) {
    if (joint.type == JointType::kRoot) {
      out_ << "<freejoint/>\n";
      return;
    }
    const bool limited = joint.type != JointType::kContinuous && joint.lower < joint.upper;
    // The range is in units that the scene chooses; compile_model writes the true one.
    out_ << "<joint name=\"" << escaped(joint.name) << "\" type=\""
         << (joint.type == JointType::kPrismatic ? "slide" : "hinge") << "\" pos=\"0 0 0\" axis=\"" << joint.axis.x()
         << ' ' << joint.axis.y() << ' ' << joint.axis.z() << "\" limited=\"" << (limited ? "true" : "false")
         << "\" range=\"-1 1\" ref=\"0\" springref=\"0\" stiffness=\"0\" armature=\"0\" margin=\"0\" damping=\""
         << joint.damping << "\" frictionloss=\"" << joint.friction << "\"/>\n";
  }

  void write_inertia(const RigidBody& body) {
    const Eigen::Vector3d& c = body.centre_of_gravity;
    const Eigen::Matrix3d& i = body.inertia;
    out_ << "<inertial pos=\"" << c.x() << ' ' << c.y() << ' ' << c.z() << "\" mass=\"" << body.mass
         << "\" fullinertia=\"" << i(0, 0) << ' ' << i(1, 1) << ' ' << i(2, 2) << ' ' << i(0, 1) << ' ' << i(0, 2)
         << ' ' << i(1, 2) << "\"/>\n";
  }

  void write_imu() {
    const Vector3& p = model_.imu_in_base.position;
    const Quaternion& q = model_.imu_in_base.orientation;
    out_ << "<site name=\"" << kMjcfImu << "\" type=\"sphere\" size=\"0.01\" pos=\"" << p[0] << ' ' << p[1] << ' '
         << p[2] << "\" quat=\"" << q[3] << ' ' << q[0] << ' ' << q[1] << ' ' << q[2] << "\"/>\n";
  }

  void write_shape(const RigidBody& body, const Shape& shape) {
    for (const WheelModel* wheel : {&model_.left, &model_.right}) {
      if (model_.joints[wheel->joint].child_link == body.name && &shape == rolling_shape(body)) {
        write_wheel(wheel == &model_.left ? 0 : 1, shape);
        return;
      }
    }
    const bool caster = shape.type == ShapeType::kSphere;
    out_ << "<geom" << pose(shape.in_body) << kContact << " condim=\"" << (caster ? 1 : 3) << "\" priority=\""
         << (caster ? 1 : 0) << '"';
    switch (shape.type) {
      case ShapeType::kSphere:
        out_ << " type=\"sphere\" size=\"" << shape.radius << "\"/>\n";
        break;
      case ShapeType::kCylinder:
        out_ << " type=\"cylinder\" size=\"" << shape.radius << ' ' << shape.length / 2 << "\"/>\n";
        break;
      case ShapeType::kBox:
        out_ << " type=\"box\" size=\"" << shape.size.x() / 2 << ' ' << shape.size.y() / 2 << ' ' << shape.size.z() / 2
             << "\"/>\n";
        break;
      case ShapeType::kMesh:
        throw DriverError(robot_.source + ": <link name=\"" + shape.link +
                          "\">: the simulator knows no collision meshes. Use boxes, cylinders and spheres.");
    }
  }

  void write_wheel(std::size_t wheel, const Shape& shape) {
    const double half_width = shape.type == ShapeType::kCylinder ? shape.length / 2 : shape.radius;
    out_ << "<geom name=\"" << mjcf_wheel_name(wheel) << '"' << pose(shape.in_body) << kContact
         << " condim=\"3\" priority=\"0\" type=\"ellipsoid\" size=\"" << shape.radius << ' ' << shape.radius << ' '
         << half_width << "\"/>\n";
  }

  const RigidBodies& robot_;
  const RobotModel& model_;
  std::ostringstream out_;
};

}  // namespace

std::string robot_mjcf(const RigidBodies& robot, const RobotModel& model, const std::string& scene_file) {
  return Writer(robot, model).write(scene_file);
}

double standing_height(const RigidBodies& robot, const RobotModel& model) {
  double lowest = std::numeric_limits<double>::max();
  for (const RigidBody& body : robot.bodies) {
    const bool wheel = body.name == model.joints[model.left.joint].child_link ||
                       body.name == model.joints[model.right.joint].child_link;
    const Shape* rolling = wheel ? rolling_shape(body) : nullptr;
    for (const Shape& shape : body.shapes) {
      if (&shape != rolling && shape.type != ShapeType::kSphere) continue;
      lowest = std::min(lowest, (body.in_root * shape.in_body).translation().z() - shape.radius);
    }
  }
  return -lowest;
}

std::string mjcf_wheel_name(std::size_t wheel) {
  return "robot_control/wheel/" + std::to_string(wheel);
}

}  // namespace robot_control

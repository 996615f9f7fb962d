/// Converts rigid bodies to MuJoCo's model: shapes, joints, springs, ties.

#include "drivers/mujoco/model/mjcf.h"

#include <mujoco/mujoco.h>

#include "drivers/mujoco/constants.h"
#include "drivers/mujoco/model/mujoco_model.h"
#include "drivers/mujoco/mujoco_errors.h"
#include "drivers/mujoco/plant_fixture.h"
#include "support/robots/made_robot.h"

namespace robot_control::tests {

using ModelPointer = std::unique_ptr<mjModel, DeleteMujoco>;

ModelPointer load_text(const std::string& name, const std::string& text) {
  char error[500] = "";
  ModelPointer model(mj_loadXML(scene_file(name, text).c_str(), nullptr, error, sizeof error));
  EXPECT_TRUE(model) << error;
  return model;
}

/// Two wheels, and an arm whose first joint is `kind` with `inside`.
struct MjcfTest : testing::Test {
  MjcfTest() {
    install_mujoco_handlers();
    model_.bodies = bodies_;
  }

  void read(const std::string& kind, const std::string& inside) {
    robot_.more = R"(<link name="arm"><inertial><mass value="0.5"/><inertia ixx="0.001" iyy="0.001" izz="0.001" ixy="0"
      ixz="0" iyz="0"/></inertial></link><joint name="arm_joint" type=")" +
                  kind +
                  R"("><parent link="base_link"/><child link="arm"/><origin xyz="0 0 0.2"/><axis xyz="1 0 0"/>)" +
                  inside + "</joint>";
    model_ = as_described();
    bodies_ = std::make_shared<RigidBodies>(*model_.bodies);
    model_.bodies = bodies_;
  }
  BodyJoint& arm_joint() { return bodies_->bodies.back().joint; }
  JointModel& arm() { return model_.joints.back(); }
  void add(const Shape& shape) { bodies_->bodies[0].shapes.push_back(shape); }

  void compile() {
    compiled_ = load_text("mjcf_test.xml", robot_mjcf(model_, parameters_, {}));
    apply_angles(model_, *compiled_);
    joint_ = mj_name2id(compiled_.get(), mjOBJ_JOINT, "arm_joint");
    dof_ = joint_ < 0 ? -1 : compiled_->jnt_dofadr[joint_];
  }

  TrueRobot as_described() const {
    MujocoPlantParameters parameters;
    parameters.sensor_errors = ErrorLevel::kIdeal;
    return true_robot(robot_.model(), parameters, kStep);
  }

  MadeRobot robot_;
  TrueRobot model_ = as_described();
  std::shared_ptr<RigidBodies> bodies_ = std::make_shared<RigidBodies>(*model_.bodies);
  MujocoPlantParameters parameters_;
  ModelPointer compiled_;
  int joint_ = -1, dof_ = -1;
};

Shape mesh(std::vector<Eigen::Vector3d> corners) {
  Shape shape;
  shape.type = ShapeType::kMesh;
  shape.points = std::move(corners);
  return shape;
}

TEST_F(MjcfTest, StandsForItselfWithoutAScene) {
  compile();
  EXPECT_EQ(compiled_->nv, 8);
  EXPECT_NEAR(mj_getTotalmass(compiled_.get()), robot_.mass(), 1e-9);
}

TEST_F(MjcfTest, AWheelIsAnEllipsoidAboutItsAxle) {
  compile();
  const int wheel = mj_name2id(compiled_.get(), mjOBJ_GEOM, mjcf_wheel_name(1).c_str());
  EXPECT_EQ(compiled_->geom_type[wheel], mjGEOM_ELLIPSOID);
  const mjtNum* size = compiled_->geom_size + 3 * wheel;
  EXPECT_EQ(std::vector<double>(size, size + 3), (std::vector<double>{0.1, 0.1, 0.02}));
  EXPECT_EQ(compiled_->geom_condim[wheel], 1);
  EXPECT_EQ(compiled_->geom_priority[wheel], 1);
}

TEST_F(MjcfTest, ANativeWheelHasTheFrictionOfTheGround) {
  parameters_.tyre = TyreModel::kNative;
  compile();
  EXPECT_EQ(compiled_->geom_condim[0], 3);
  EXPECT_EQ(compiled_->geom_priority[0], 0);
  parameters_.ground_friction = 0.4;
  compile();
  EXPECT_EQ(compiled_->geom_priority[0], 1);
  EXPECT_EQ(compiled_->geom_friction[0], 0.4);
}

TEST_F(MjcfTest, ShapesThatDoNotRollSlide) {
  Shape box;
  box.type = ShapeType::kBox;
  box.size = {0.2, 0.1, 0.05};
  add(box);
  compile();
  const int geom = 0;  // the base's come first
  EXPECT_EQ(compiled_->geom_type[geom], mjGEOM_BOX);
  EXPECT_EQ(compiled_->geom_condim[geom], 1);
  EXPECT_EQ(compiled_->geom_priority[geom], 1);
}

TEST_F(MjcfTest, MeshesAreHullsOfTheirOwn) {
  const std::vector<Eigen::Vector3d> corners{{0, 0, 0}, {0.1, 0, 0}, {0, 0.2, 0}, {0, 0, 0.3}};
  add(mesh(corners));
  add(mesh({{0, 0, 0}, {0.4, 0, 0}, {0, 0.4, 0}, {0, 0, 0.4}}));
  compile();
  EXPECT_EQ(compiled_->nmesh, 2);
  EXPECT_EQ(compiled_->mesh_vertnum[0], 4);
}

// A sheet, a rod and a point have no volume and no hull.
TEST_F(MjcfTest, FlatMeshesAreThickened) {
  add(mesh({{0, 0, 0.1}, {0.3, 0, 0.1}, {0, 0.2, 0.1}, {0.3, 0.2, 0.1}}));
  add(mesh({{0, 0, 0}, {0.1, 0.1, 0.1}, {0.2, 0.2, 0.2}}));
  add(mesh({{0.1, 0, 0.3}}));
  compile();
  EXPECT_EQ(compiled_->nmesh, 3);
  EXPECT_NEAR(mj_getTotalmass(compiled_.get()), robot_.mass(), 1e-9);
}

TEST_F(MjcfTest, LimitsAreRadiansWhateverTheSceneSays) {
  read("revolute", R"(<limit lower="-0.5" upper="1.5" effort="2" velocity="1"/>)");
  compile();
  EXPECT_EQ(compiled_->jnt_limited[joint_], 1);
  EXPECT_EQ(compiled_->jnt_range[2 * joint_], -0.5);
  EXPECT_EQ(compiled_->jnt_range[2 * joint_ + 1], 1.5);
}

TEST_F(MjcfTest, APrismaticJointSlidesBetweenItsStops) {
  read("prismatic",
       R"(<limit lower="-0.01" upper="0.02" effort="2" velocity="1"/><dynamics damping="3" friction="4"/>)");
  arm().role = JointRole::kPassive;
  compile();
  EXPECT_EQ(compiled_->jnt_type[joint_], mjJNT_SLIDE);
  EXPECT_EQ(compiled_->jnt_range[2 * joint_ + 1], 0.02);
  EXPECT_EQ(compiled_->dof_damping[dof_], 3);
  EXPECT_EQ(compiled_->dof_frictionloss[dof_], 4);
}

TEST_F(MjcfTest, ASuspensionIsASpringAtItsLoad) {
  for (const char* kind : {"prismatic", "revolute"}) {
    read(kind, R"(<limit lower="-0.2" upper="0.2" effort="2" velocity="1"/>)");
    arm_joint().spring_stiffness = 1000;
    arm_joint().spring_load = 50;
    compile();
    EXPECT_EQ(compiled_->jnt_stiffness[joint_], 1000);
    EXPECT_NEAR(compiled_->qpos_spring[compiled_->jnt_qposadr[joint_]], 0.05, 1e-12) << kind;
  }
}

TEST_F(MjcfTest, AHeldJointHasTheRotorOfItsMotor) {
  read("revolute", R"(<limit lower="-2" upper="2" effort="7" velocity="1"/><dynamics friction="0.1"/>)");
  compile();
  EXPECT_NEAR(compiled_->dof_armature[dof_], 7.0 / 200, 1e-12);
  EXPECT_EQ(compiled_->dof_frictionloss[dof_], 0.1);
}

TEST_F(MjcfTest, APassiveJointIsFree) {
  read("continuous", "");
  arm().role = JointRole::kPassive;
  compile();
  EXPECT_EQ(compiled_->jnt_limited[joint_], 0);
  EXPECT_EQ(compiled_->dof_frictionloss[dof_], 0);
}

TEST_F(MjcfTest, AMimicIsTied) {
  read("continuous", "");
  arm_joint().mimicked = "left_0";
  arm_joint().mimic_multiplier = -2;
  arm_joint().mimic_offset = 0.25;
  compile();
  ASSERT_EQ(compiled_->neq, 1);
  EXPECT_EQ(compiled_->eq_type[0], mjEQ_JOINT);
  EXPECT_EQ(compiled_->eq_data[0], 0.25);
  EXPECT_EQ(compiled_->eq_data[1], -2);
}

TEST_F(MjcfTest, TheMotorsLossesActBehindTheGear) {
  parameters_.gear_ratio = 10;
  parameters_.motor_friction = 0.02;
  parameters_.motor_damping = 0.003;
  compile();
  const int dof = compiled_->jnt_dofadr[mj_name2id(compiled_.get(), mjOBJ_JOINT, "right_0")];
  EXPECT_NEAR(compiled_->dof_frictionloss[dof], 0.2, 1e-12);
  EXPECT_NEAR(compiled_->dof_damping[dof], 0.3, 1e-12);
}

TEST_F(MjcfTest, NamesMayHoldWhatXmlEscapes) {
  robot_.more = R"(<link name="a&amp;b&lt;&quot;c&quot;"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"
    ixy="0" ixz="0" iyz="0"/></inertial></link><joint name="&lt;j&gt;" type="continuous"><parent link="base_link"/>
    <child link="a&amp;b&lt;&quot;c&quot;"/></joint>)";
  model_ = as_described();
  compile();
  EXPECT_GE(mj_name2id(compiled_.get(), mjOBJ_BODY, "a&b<\"c\""), 0);
  EXPECT_GE(mj_name2id(compiled_.get(), mjOBJ_JOINT, "<j>"), 0);
}

// mujoco-simulate opens the written file alone, in another directory than the scene's.
TEST_F(MjcfTest, TheExportedTextOpensByItselfAndStands) {
  parameters_.scene = kSlope;
  robot_.ball_x = -0.3;
  robot_.body_x = -0.1;
  const ModelPointer alone = load_text("exported.xml", exported_mjcf(robot_.model(), parameters_, 0.001));
  ASSERT_TRUE(alone);
  EXPECT_NEAR(mj_getTotalmass(alone.get()), robot_.mass(), 1e-6);
  EXPECT_NEAR(alone->opt.timestep, 0.001, 1e-12);
  EXPECT_EQ(alone->opt.cone, mjCONE_ELLIPTIC);
  const MujocoData data(mj_makeData(alone.get()));
  for (int i = 0; i < 2000; ++i) mj_step(alone.get(), data.get());
  EXPECT_EQ(data->ncon, 3) << "two wheels and the ball, rolling down the slope";
}

}  // namespace robot_control::tests

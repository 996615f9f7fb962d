#include "drivers/mujoco/model/mujoco_model.h"

#include <filesystem>

#include "drivers/driver.h"
#include "drivers/mujoco/plant_fixture.h"
#include "support/matchers.h"
#include "support/message_of.h"

namespace robot_control::tests {

struct MujocoModelTest : testing::Test {
  MujocoModel compiled(const std::string& scene, double period = 0.001) const {
    MujocoPlantParameters parameters;
    parameters.scene = scene;
    parameters.tyre = tyre_;
    return compile_model(robot_, parameters, period);
  }
  std::string refusal(const std::string& scene) const {
    return message_of<DriverError>([&] { compiled(scene); }, "accepted");
  }

  DriveTrain robot_ = read_drive_train(diffbot_urdf(), {});
  TyreModel tyre_ = TyreModel::kBrush;
};

TEST_F(MujocoModelTest, WeighsWhatTheUrdfWeighs) {
  const MujocoModel model = compiled(kFlat);
  EXPECT_NEAR(model.model->body_subtreemass[model.base_body], 12.0, 12.0 * 1e-12);
}

TEST_F(MujocoModelTest, FloatsOnSixAxesAndTurnsOnTwo) {
  EXPECT_EQ(compiled(kFlat).model->nv, 8);
}

// "world" is MuJoCo's own word; slashes appear in prefixes of robots.
TEST_F(MujocoModelTest, ALinkMayHaveAnyName) {
  for (const std::string link : {"base_link", "left_wheel_link"}) {
    for (const std::string name : {"world", "robot1/link", "../link", "a link"}) {
      RobotDescription description = diffbot_urdf();
      for (std::size_t at; (at = description.text.find('"' + link + '"')) != std::string::npos;) {
        description.text.replace(at + 1, link.size(), name);
      }
      robot_ = read_drive_train(description, {});
      EXPECT_NEAR(compiled(kFlat).model->body_subtreemass[1], 12.0, 1e-9) << link << ' ' << name;
    }
  }
}

TEST_F(MujocoModelTest, APeriodIsCutIntoStepsOfAtMostOneMillisecond) {
  for (const auto& [period, steps] : {std::pair{0.01, 10}, {0.002, 2}, {0.001, 1}, {0.0005, 1}, {1.0 / 300, 4}}) {
    const MujocoModel model = compiled(kFlat, period);
    EXPECT_EQ(model.substeps, steps);
    EXPECT_DOUBLE_EQ(model.model->opt.timestep * steps, period);
  }
}

TEST_F(MujocoModelTest, ABenchmarkCanStepItBareWithNativeFriction) {
  tyre_ = TyreModel::kNative;
  const MujocoModel model = compiled(kFlat);
  const MujocoData data = set_down(model);
  for (int i = 0; i < 1000; ++i) mj_step(model.model.get(), data.get());
  EXPECT_NEAR(data->qpos[model.base_position + 2], 0.1, 1e-4);
}

TEST_F(MujocoModelTest, OverridesDoNotChangeThePhysics) {
  DriveTrainParameters parameters;
  parameters.wheel_radius = 0.2;
  parameters.wheel_base = 0.9;
  robot_ = read_drive_train(diffbot_urdf(), parameters);
  const MujocoModel model = compiled(kFlat);
  EXPECT_EQ(model.model->geom_size[3 * model.wheel_shape[0]], 0.1);
  EXPECT_NEAR(model.model->qpos0[model.base_position + 2], 0.1, 1e-12);
}

TEST_F(MujocoModelTest, TheScenesDefaultsAndUnitsDoNotReachTheRobot) {
  const MujocoModel model = compiled(scene_file("defaults.xml", R"(<mujoco>
    <compiler angle="degree" eulerseq="zyx"/>
    <option timestep="0.01" integrator="RK4" cone="pyramidal" solver="PGS" impratio="1" gravity="0 0 -1.62"/>
    <default><geom contype="4" conaffinity="4" density="5000" friction="2 2 2" condim="6" margin="0.1"/>
             <joint damping="7" armature="3" stiffness="2" frictionloss="1"/></default>
    <worldbody><geom type="plane" size="1 1 1"/><site name="start"/></worldbody></mujoco>)"));
  const mjModel& m = *model.model;
  const int wheel = model.wheel_shape[0];
  EXPECT_EQ(m.geom_contype[wheel], 2);
  EXPECT_EQ(m.geom_conaffinity[wheel], 1);
  EXPECT_EQ(m.geom_condim[wheel], 1);
  EXPECT_EQ(m.geom_friction[3 * wheel], 0);
  EXPECT_EQ(m.geom_margin[wheel], 0);
  EXPECT_EQ(m.dof_damping[model.joint_velocity[0]], 0);
  EXPECT_EQ(m.dof_armature[model.joint_velocity[0]], 0);
  EXPECT_EQ(m.dof_frictionloss[model.joint_velocity[0]], 0);
  EXPECT_EQ(m.opt.timestep, 0.001);
  EXPECT_EQ(m.opt.integrator, mjINT_EULER);
  EXPECT_EQ(m.opt.cone, mjCONE_ELLIPTIC);
  EXPECT_EQ(m.opt.solver, mjSOL_NEWTON);
  EXPECT_EQ(m.opt.gravity[2], -1.62) << "gravity is the scene's";
}

TEST_F(MujocoModelTest, TheScenesOwnRelativeIncludesWork) {
  std::filesystem::create_directories(testing::TempDir() + "parts");
  scene_file("parts/floor.xml", R"(<mujocoinclude><geom name="floor" type="plane" size="1 1 1"/></mujocoinclude>)");
  const std::string scene = scene_file("with_include.xml", R"(<mujoco><worldbody><include file="parts/floor.xml"/>
    <site name="start" pos="3 0 0"/></worldbody></mujoco>)");
  const MujocoModel model = compiled(scene);
  EXPECT_GE(mj_name2id(model.model.get(), mjOBJ_GEOM, "floor"), 0);
  EXPECT_EQ(model.model->qpos0[model.base_position], 3);
}

TEST_F(MujocoModelTest, ASceneByRelativePathWorks) {
  EXPECT_NO_THROW(compiled(std::filesystem::relative(kFlat).string()));
}

TEST_F(MujocoModelTest, ASceneThatDoesNotCompileIsRefusedWithMujocosMessage) {
  const std::string scene = scene_file(
      "typo.xml", "<mujoco><worldbody><geom type=\"plane\" size=\"1 1 1\" bogus=\"3\"/></worldbody></mujoco>");
  EXPECT_THAT(refusal(scene), AllOf(HasSubstr("typo.xml"), HasSubstr("unrecognized attribute: 'bogus'"),
                                    Not(HasSubstr("\n")), HasSubstr("Repair the scene")));
}

TEST_F(MujocoModelTest, ASceneThatIsNotThereIsRefused) {
  EXPECT_THAT(refusal("/nowhere/scene.xml"), HasSubstr("/nowhere/scene.xml: file not found"));
  EXPECT_THAT(refusal(std::filesystem::path(kFlat).parent_path() / "slope.xml"),
              HasSubstr("kerb, loop, low_friction_patch, room, slope_5deg"));
  EXPECT_THAT(refusal("/"), HasSubstr("is a folder"));
}

// MuJoCo would read them without end.
TEST_F(MujocoModelTest, ASceneThatIsOrNamesNoRegularFileIsRefused) {
  EXPECT_THAT(refusal("/dev/zero"), HasSubstr("/dev/zero: is a device"));
  const auto naming = [&](const std::string& body) {
    return refusal(scene_file("naming.xml", "<mujoco>" + body + "</mujoco>"));
  };
  EXPECT_THAT(naming(R"(<include file="/dev/zero"/>)"), HasSubstr("/dev/zero: is a device"));
  EXPECT_THAT(naming(R"(<compiler meshdir="/dev"/><asset><mesh name="m" file = 'zero'/></asset>)"),
              HasSubstr("/dev/zero: is a device"));
  scene_file("inner.xml", R"(<mujocoinclude><asset><hfield name="h" file="/dev/zero"/></asset></mujocoinclude>)");
  EXPECT_THAT(naming(R"(<include file="inner.xml"/>)"), HasSubstr("/dev/zero: is a device"));
}

TEST_F(MujocoModelTest, ASceneThatIsNoXmlIsRefused) {
  EXPECT_THAT(refusal(scene_file("broken.xml", "<mujoco><worldbody>")), HasSubstr("broken.xml"));
}

TEST_F(MujocoModelTest, ASceneWithoutStartIsRefused) {
  EXPECT_THAT(refusal(scene_file("no_start.xml", "<mujoco><worldbody/></mujoco>")),
              AllOf(HasSubstr("no_start.xml"), HasSubstr("site \"start\"")));
}

TEST_F(MujocoModelTest, ASceneThatChangesTheRobotsMassIsRefused) {
  EXPECT_THAT(refusal(scene_file("heavy.xml", R"(<mujoco><compiler settotalmass="50"/><worldbody><site name="start"/>
    </worldbody></mujoco>)")),
              AllOf(HasSubstr("heavy.xml"), HasSubstr("weigh")));
}

// The scene's own text includes itself, and so does one that it includes.
TEST_F(MujocoModelTest, AnIncludeCycleInASceneIsRefused) {
  const std::string own = scene_file("own.xml", R"(<mujoco><include file="own.xml"/><worldbody><site name="start"/>
    </worldbody></mujoco>)");
  EXPECT_THAT(refusal(own), AllOf(HasSubstr("own.xml"), HasSubstr("include")));
  scene_file("second.xml", R"(<mujocoinclude><include file="first.xml"/></mujocoinclude>)");
  const std::string first = scene_file("first.xml", R"(<mujoco><include file="second.xml"/><worldbody>
    <site name="start"/></worldbody></mujoco>)");
  EXPECT_THAT(refusal(first), AllOf(HasSubstr("first.xml"), HasSubstr("include")));
}

}  // namespace robot_control::tests

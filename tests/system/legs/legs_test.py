"""sim.launch robot:=quadbot: a robot on legs stands up, sways, lifts a foot, moves its joints, is stopped and reset."""

import math
import subprocess
import time
from collections.abc import Callable

import rospy
from geometry_msgs.msg import Twist
from robot_control.msg import BodyPose, FootTarget, RobotStatus
from robot_control.srv import SetGait, SetPosture
from std_srvs.srv import Trigger
from system.legs.legs_support import LegsTestCase
from system.system_support import CONTROLLER, LIMIT, again_after_a_stall, refusal, repository, wait_for
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

SEND_PERIOD = 0.1
"""s; a twelfth of request_timeout."""
QUADBOT = repository() / "urdf" / "quadbot.urdf"


class LegsTest(LegsTestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.launch_quadbot()
        cls.status: RobotStatus | None = None
        rospy.Subscriber("robot_status", RobotStatus, lambda message: setattr(cls, "status", message))
        cls.body_pose = rospy.Publisher("body_pose", BodyPose, queue_size=1, tcp_nodelay=True)
        cls.foot_target = rospy.Publisher("foot_target", FootTarget, queue_size=1, tcp_nodelay=True)
        cls.joints = rospy.Publisher("joint_trajectory", JointTrajectory, queue_size=1, tcp_nodelay=True)
        cls.cmd_vel = rospy.Publisher("cmd_vel", Twist, queue_size=1, tcp_nodelay=True)
        wait_for("all topics", lambda: None not in (cls.legs, cls.safety, cls.truth), cls.startup_limit())
        rospy.wait_for_service("set_posture", LIMIT)

    @staticmethod
    def startup_limit() -> float:
        return 2 * LIMIT

    def set_posture(self, posture: str) -> tuple[bool, str]:
        answer = rospy.ServiceProxy("set_posture", SetPosture)(posture)
        return answer.success, answer.message

    def stand(self) -> None:
        wait_for("standing up", lambda: self.set_posture("standing")[0])
        wait_for("standing", lambda: self.legs is not None and self.legs.posture == "standing")

    def send_until(self, what: str, message: BodyPose | FootTarget, condition: Callable[[], bool]) -> None:
        publisher = self.body_pose if isinstance(message, BodyPose) else self.foot_target
        last = [0.0]

        def send() -> None:
            if time.monotonic() - last[0] >= SEND_PERIOD:
                last[0] = time.monotonic()
                publisher.publish(message)

        wait_for(what, condition, every=send)

    def height(self) -> float:
        assert self.truth is not None
        return float(self.truth.pose.pose.position.z)

    @again_after_a_stall
    def test_it_stands_sways_lifts_a_foot_is_stopped_reset_and_lies_down(self) -> None:
        wait_for("the monitor", lambda: self.safety is not None and self.safety.state_name == "READY")
        self.assertEqual(
            self.set_posture("sitting"), (False, "refused: unknown posture 'sitting'; set standing or lying")
        )
        lying = self.height()
        self.stand()
        self.assertGreater(self.height() - lying, 0.15)
        wait_for("robot_status", lambda: self.status is not None and self.status.posture == "standing")

        assert self.legs is not None
        wait_for("feet that bear", lambda: all(self.legs.bears))
        tall = self.height()
        self.send_until("a lower body", BodyPose(height=-0.03, x=0.02), lambda: self.legs.body.height < -0.029)
        self.assertAlmostEqual(self.height(), tall - 0.03, delta=0.01)
        self.send_until("out of reach", BodyPose(roll=1.0), lambda: "out_of_reach" in self.legs.reasons)
        self.assertLess(abs(self.legs.body.roll), 0.35)
        self.send_until("the nominal pose", BodyPose(), lambda: abs(self.legs.body.roll) < 0.001)

        lifted = FootTarget(foot="rear_left", z=0.08)
        self.send_until("a foot in the air", lifted, lambda: self.legs.lifted == "rear_left" and not self.legs.bears[2])
        wait_for("the foot that was set down without its sender", lambda: not self.legs.lifted and self.legs.bears[2])

        # An e-stop folds the legs; a request from before it, or during it, moves nothing after the reset.
        self.assertTrue(rospy.ServiceProxy("e_stop_trigger", Trigger)().success)
        wait_for("a lying robot", lambda: abs(self.height() - lying) < 0.03 and self.legs.posture == "lying")
        for posture in ("standing", "lying"):
            accepted, text = self.set_posture(posture)
            self.assertFalse(accepted)
            self.assertIn("e_stop_reset", text)

        def reset() -> bool:
            return bool(rospy.ServiceProxy("e_stop_reset", Trigger)().success)

        wait_for("an accepted reset", reset, every=lambda: time.sleep(0.2))
        time.sleep(0.5)
        self.assertEqual(self.legs.posture, "lying")
        self.stand()
        self.assertTrue(self.set_posture("lying")[0])
        wait_for("lying", lambda: self.legs.posture == "lying" and abs(self.height() - lying) < 0.03)
        for _ in range(5):  # the stop may have revoked this sender: its zero ends that
            self.body_pose.publish(BodyPose())
            time.sleep(SEND_PERIOD)
        self.send_until("a refused pose", BodyPose(roll=0.1), lambda: "not_standing" in self.legs.reasons)
        self.assertFalse(math.isnan(self.legs.actual[0]))

    @again_after_a_stall
    def test_it_walks_on_a_twist_and_refuses_unknown_gaits_and_feet_in_words(self) -> None:
        wait_for("a subscriber", lambda: self.cmd_vel.get_num_connections() > 0)
        self.cmd_vel.publish(Twist())  # a stop may have revoked this sender: its zero ends that
        walk = Twist()
        walk.linear.x = 0.2
        wait_for("a walk", lambda: self.legs.posture == "walking", every=lambda: self.cmd_vel.publish(walk))
        self.assertEqual(self.legs.gait, "walking_trot")  # the choice of a slow walk
        set_gait = rospy.ServiceProxy("set_gait", SetGait)
        self.assertFalse(set_gait("moonwalk").success)
        self.assertTrue(set_gait("crawl").success)
        wait_for("a crawl", lambda: self.legs.gait == "crawl", every=lambda: self.cmd_vel.publish(walk))
        self.assertTrue(set_gait("auto").success)
        wait_for("standing", lambda: self.legs.posture == "standing", every=lambda: self.cmd_vel.publish(Twist()))
        wait_for(
            "the refusal of a foot",
            lambda: "there is no foot 'tail'; set one of front_left, front_right" in self.launch.output,
            every=lambda: self.foot_target.publish(FootTarget(foot="tail")),
        )

    def walk_for(self, seconds: float, message: BodyPose | None = None) -> tuple[float, set[str]]:
        """Walks at 0.2 m/s, and publishes `message` beside the twists; returns the largest roll, and the postures."""
        end, roll, postures = time.monotonic() + seconds, 0.0, set()
        walk = Twist()
        walk.linear.x = 0.2
        while time.monotonic() < end:
            self.cmd_vel.publish(walk)
            if message is not None:
                self.body_pose.publish(message)
            time.sleep(SEND_PERIOD / 2)
            roll = max(roll, abs(self.legs.body.roll))
            postures.add(self.legs.posture)
        return roll, postures

    @again_after_a_stall
    def test_a_walk_carries_the_pose_of_its_own_sender_alone_and_survives_nan(self) -> None:
        for publisher, zero in ((self.cmd_vel, Twist()), (self.body_pose, BodyPose())):
            wait_for("a subscriber", lambda p=publisher: p.get_num_connections() > 0)
            publisher.publish(zero)  # a stop may have revoked this sender: its zero ends that
        self.stand()
        posing = subprocess.Popen(
            ["rostopic", "pub", "-r", "10", "body_pose", "robot_control/BodyPose", "{roll: 0.1}"],
            stdout=subprocess.DEVNULL,
        )
        self.addCleanup(posing.wait)
        self.addCleanup(posing.kill)
        wait_for("a leaning body", lambda: abs(self.legs.body.roll) > 0.05)
        wait_for("a level walk", lambda: self.walk_for(0.5)[0] < 0.01 and self.legs.posture == "walking")
        roll, postures = self.walk_for(2.0)
        self.assertEqual(postures, {"walking"}, "the pose of another node ends no walk")
        self.assertLess(roll, 0.01, "nor leans it")
        self.assertIn(f"is refused: the robot walks for {rospy.get_name()}", self.launch.output)
        posing.kill()
        posing.wait()
        self.assertLess(self.walk_for(2.0)[0], 0.01, "nor does what it has left")
        self.assertGreater(self.walk_for(1.5, BodyPose(roll=0.05))[0], 0.045, "its own pose does")
        roll, postures = self.walk_for(2.0, BodyPose(roll=math.nan))
        self.assertEqual(postures, {"walking"})
        repair = f"body_pose holds NaN or infinity: refused; check its sender {rospy.get_name()}"
        self.assertIn(repair, self.launch.output)
        self.body_pose.publish(BodyPose())
        self.assertEqual(self.walk_for(1.0)[1], {"walking"})
        wait_for("standing", lambda: self.legs.posture == "standing", every=lambda: self.cmd_vel.publish(Twist()))
        wait_for("lying", lambda: self.set_posture("lying")[0] and self.legs.posture == "lying")

    def move(self, joint: str, *points: tuple[float, float]) -> None:
        """Publishes a trajectory of (time, position)."""
        message = JointTrajectory(joint_names=[joint])
        for time_from_start, position in points:
            point = JointTrajectoryPoint(positions=[position], time_from_start=rospy.Duration(time_from_start))
            message.points.append(point)
        self.joints.publish(message)

    @again_after_a_stall
    def test_joint_trajectory_moves_a_robot_that_lies_and_is_refused_in_words(self) -> None:
        wait_for("lying", lambda: self.set_posture("lying")[0] and self.legs.posture == "lying")
        wait_for("a subscriber", lambda: self.joints.get_num_connections() > 0)
        self.joints.publish(JointTrajectory())  # a stop may have revoked this sender: its zero ends that
        hip = self.legs.name.index("front_left_hip_joint")
        lying = self.legs.actual[hip]
        time.sleep(SEND_PERIOD)
        self.move("front_left_hip_joint", (1.0, lying + 0.15))  # outwards, away from the ground
        wait_for("moving joints", lambda: self.legs.posture == "joints")
        wait_for("the end of the path", lambda: abs(self.legs.actual[hip] - lying - 0.15) < 0.03)
        wait_for("the report", lambda: f"joint_trajectory of {rospy.get_name()}" in self.launch.output)
        wait_for("its end", lambda: ": done" in self.launch.output)

        for send, sentence in (
            (lambda: self.move("tail", (1, 0)), "there is no joint 'tail'"),
            (lambda: self.move("front_left_hip_joint", (1, math.nan)), "one of its positions is nan"),
            (lambda: self.move("front_left_hip_joint", (0.02, lying)), "give it more time"),
            (lambda: self.move("front_left_hip_joint", (2, lying), (1, lying)), "is not after 2 s"),
        ):
            send()
            wait_for(sentence, lambda sentence=sentence: sentence in self.launch.output)
            time.sleep(0.15)  # two refusals within 0.1 s are one line
        self.assertEqual(self.legs.posture, "joints")

        # An empty trajectory stops the joints on their way.
        self.move("front_left_hip_joint", (10.0, lying))
        time.sleep(0.5)
        self.joints.publish(JointTrajectory())
        wait_for("the end by an empty one", lambda: "sent an empty one" in self.launch.output)
        self.assertGreater(self.legs.actual[hip], lying + 0.1)

        self.stand()
        self.move("front_left_hip_joint", (2, lying))
        wait_for("a refusal", lambda: "the robot does not lie; it is standing" in self.launch.output)

    def test_the_controller_of_wheels_refuses_it_and_names_its_own(self) -> None:
        text = refusal(CONTROLLER, f"_urdf:={QUADBOT}")
        self.assertIn("is on legs, and diff_drive_controller controls robots on wheels: start leg_controller", text)
        wheels = refusal("leg_controller", f"_urdf:={repository() / 'urdf' / 'diffbot.urdf'}")
        self.assertIn("start diff_drive_controller instead", wheels)

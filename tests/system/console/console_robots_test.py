"""Robots in the browser: shapes, meshes of STL and DAE, what is missing or broken, and names that are scripts."""

import os
import struct
import tempfile
import unittest
from pathlib import Path

import rospy
from system import rosunit_results
from system.system_support import repository, wait_for

from bench.console.browser import Browser, missing
from bench.console.process import Console

rosunit_results.record()

SCRIPT = "<img src=x onerror=window.hacked=1><script>window.hacked=1</script>"
SPOKEN = SCRIPT.replace("<", "&lt;").replace(">", "&gt;")
CORNERS = ((0.0, 0.0, 0.0), (0.3, 0.0, 0.0), (0.0, 0.3, 0.0), (0.0, 0.0, 0.3))
FACES = ((0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3))
STL = b"\0" * 80 + struct.pack("<I", 4)
STL += b"".join(struct.pack("<12fH", 0, 0, 0, *(x for c in face for x in CORNERS[c]), 0) for face in FACES)
DAE = f"""<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="1"/><up_axis>Z_UP</up_axis></asset>
<library_images><image id="i"><init_from>https://evil.example/i.png</init_from></image></library_images>
<library_effects><effect id="e"><profile_COMMON><newparam sid="s"><surface type="2D"><init_from>i</init_from></surface>
</newparam><technique sid="c"><phong><diffuse><texture texture="s" texcoord="u"/></diffuse></phong></technique>
</profile_COMMON></effect></library_effects><library_materials><material id="m"><instance_effect url="#e"/></material>
</library_materials><library_geometries><geometry id="g"><mesh><source id="p"><float_array id="a"
count="12">{" ".join(str(x) for c in CORNERS for x in c)}</float_array><technique_common>
<accessor source="#a" count="4" stride="3">
<param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common>
</source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices><triangles count="4" material="m">
<input semantic="VERTEX" source="#v" offset="0"/><p>{" ".join(str(c) for face in FACES for c in face)}</p></triangles>
</mesh></geometry></library_geometries><library_visual_scenes><visual_scene id="w"><node id="n">
<instance_geometry url="#g"><bind_material><technique_common><instance_material symbol="m" target="#m"/>
</technique_common></bind_material></instance_geometry></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#w"/></scene></COLLADA>"""


def corpus() -> Path | None:
    """Descriptions of real robots; ROBOT_CORPUS names the folder."""
    named = os.environ.get("ROBOT_CORPUS")
    folders = [Path(named)] if named else [each / "shared/robots" for each in repository().resolve().parents]
    return next((folder for folder in folders if folder.is_dir()), None)


class ConsoleRobotsTest(unittest.TestCase):
    console: Console
    browser: Browser

    @classmethod
    def setUpClass(cls) -> None:
        if not missing():
            os.environ["ROS_PACKAGE_PATH"] = f"{corpus() or ''}:{os.environ.get('ROS_PACKAGE_PATH', '')}"
            cls.console, cls.browser = Console(), Browser()

    @classmethod
    def tearDownClass(cls) -> None:
        if not missing():
            cls.browser.end()
            cls.console.end()

    def setUp(self) -> None:
        if missing():
            self.skipTest(missing())
        rospy.set_param("robot_description", "")
        self.addCleanup(rospy.set_param, "robot_description", "")

    def show(self, description: str) -> Browser:
        rospy.set_param("robot_description", description)
        self.browser.driver.get(self.console.address)
        wait_for("the model", lambda: self.browser.run("return 'model' in document.body.dataset"))
        return self.browser

    def test_meshes_are_shown_and_what_is_missing_or_broken_is_a_box_with_a_note(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        contents = {
            "a.stl": STL,
            "a.dae": DAE.encode(),
            "cut.stl": STL[:100],
            "cut.dae": b"<COLLADA>",
        }
        for name, content in contents.items():
            Path(folder.name, name).write_bytes(content)
        names = [*contents, "missing.stl", "secret.txt", "onerror=x.stl"]
        visuals = "".join(
            f'<visual><geometry><mesh filename="file://{folder.name}/{name}"/></geometry></visual>' for name in names
        )
        browser = self.show(f'<robot name="{SPOKEN}"><link name="{SPOKEN}">{visuals}</link></robot>')
        note = browser.text("scene-note")
        for name in ("cut.stl", "cut.dae", "missing.stl", "secret.txt"):
            self.assertIn(name, note)
        for name in ("a.stl", "a.dae"):
            self.assertNotIn(name, note)
        self.assertEqual(browser.data("model"), SCRIPT)
        self.assertIn("<script>", browser.driver.title)
        self.assertIsNone(browser.run("return window.hacked ?? null"))
        self.assertEqual([each for each in browser.problems() if "404" not in each], [], "404 are the missing meshes")

    def test_real_robots_are_shown(self) -> None:
        robots = corpus()
        if robots is None:
            self.skipTest("no folder of real robots: set ROBOT_CORPUS")
        files = {name: robots / name / "robot.urdf" for name in ("jackal", "boxer", "kobuki")}
        files["diffbot"] = repository() / "urdf" / "diffbot.urdf"
        for name, path in files.items():
            with self.subTest(robot=name):
                browser = self.show(path.read_text())
                self.assertEqual(browser.text("scene-note"), "")
                self.assertEqual(browser.problems(), [])

// The stage: the robot as the odometry has it, on the ground, with camera, marks, and a stroke that the pointer draws.
import * as THREE from "/lib/three/build/three.module.js";
import { OrbitControls } from "/lib/three/examples/jsm/controls/OrbitControls.js";
import { by, put } from "/dom.js";
import { cast, follow, haze, recolour, surroundings } from "/ground.js";
import { on } from "/link.js";
import { arcOf, ellipseOf, feet, fill, lay, marks, polyline, ribbon, ring } from "/marks.js";
import { orbit } from "/orbit.js";
import { build, lowestOf, pose } from "/robot.js";
import { onTab, tab } from "/tabs.js";
import { words } from "/words.js";

const TRAIL = 1500, STEP = 0.05;        // points of the way driven; m between two of them
const MAX_NOTES = 6;                    // of meshes that cannot be shown
const FRAME = 50;                       // ms between two pictures
const SLOW = 1000 / 15, RESTING = 250;         // ms of a picture that is too slow; ms of rest, because driving comes first
const VISIBLE = 0.001, LOAD = 5;        // m and rad, and N of a foot, that can be seen
const ENOUGH = 1.2e6;                   // px of a picture where it has to be fast
const SHARE = 0.46;                     // of the free part of the window that the robot takes
const CHASE = { side: 0.55, height: 0.33 };  // rad beside and above the line behind the robot
const SCALES = [0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50], BAR = 56;  // m; px at least
const NEAREST = 0.2, FARTHEST = 100;    // m of the camera from what it looks at
const COVERED = ["plots", "logs", "setup"];  // parts that lie over the whole stage
const view = by("view"), canvas = by("scene"), notes = new Set();
const calm = matchMedia("(prefers-reduced-motion: reduce)"), scheme = matchMedia("(prefers-color-scheme: dark)");
export const scene = new THREE.Scene();
const camera = new THREE.PerspectiveCamera(38, 1, 0.05, 300);
camera.up.set(0, 0, 1);
const controls = new OrbitControls(camera, canvas);
let renderer = null, dirty = true, due = 0, began = 0, slow = 0, fine = true, resting = false, blind = false, pictures = 0;
let robot = new THREE.Group(), joints = new Map(), links = new Map(), supports = [], radius = 0.4, trail = [];
let at = { x: 0, y: 0, yaw: 0 }, mode = "chase", following = true, placed = false, scale = 1, shown = "";

const driven = ribbon("measured", TRAIL, { fades: true }), wanted = polyline("limited", 2000, true);
const ellipse = polyline("lines", 65), truth = polyline("true", 66), drawn = polyline("goal", 1000);
const asks = ribbon("asked", 17, { head: true }), moves = ribbon("measured", 17, { head: true });
const nose = ribbon("ink", 2, { head: true });

function say(text) {
  notes.add(text);
  by("scene-note").textContent = [...notes].slice(0, MAX_NOTES).join("; ");
}

/** Something was changed: draws again. */
export function redraw() { dirty = true; }
export function recoloured() { recolour(scene); dirty = true; }

/** Height of the lowest vertex that is drawn, m. */
export function lowest() {
  const place = new THREE.Vector3();
  let least = Infinity;
  robot.traverse(({ geometry, matrixWorld }) => {
    const corners = geometry?.attributes?.position;
    for (let i = 0; i < (corners?.count ?? 0); ++i) {
      least = Math.min(least, place.fromBufferAttribute(corners, i).applyMatrix4(matrixWorld).z);
    }
  });
  return least;
}

// camera

/** The part of the window that no card covers, as left, top, right, bottom, px. */
function free() {
  const { clientWidth: width, clientHeight: height } = view, box = (id) => by(id)?.getBoundingClientRect();
  const seen = (id) => by(id)?.offsetParent ? box(id) : null, bar = box("bar"), tabs = box("tabs");
  const side = [seen("side"), tab() === "map" ? seen("sheet") : null].find((each) => each?.width && each.left > 0.4 * width);
  const below = [seen("sticks"), seen("pad"), box("replay"), seen("why"), tabs, tab() === "map" && !side ? seen("sheet") : null];
  const middle = (each) => each?.height && each.top > 0.3 * height && each.left < 0.6 * width && each.right > 0.4 * width;
  const upright = tabs.height > tabs.width, mini = seen("mini"), above = mini?.width > 0.5 * width ? mini : bar;
  return [upright ? tabs.right : 0, above.bottom, side ? side.left : width,
    Math.min(height, ...below.filter(middle).map((each) => each.top))];
}

function frameUp() {
  const { clientWidth: width, clientHeight: height } = view;
  if (!width || !height) return;
  const [left, top, right, bottom] = free(), before = scale;
  camera.aspect = width / height;
  const x = Math.round((left + right - width) / 2), y = Math.round((top + bottom - height) / 2);
  dirty ||= camera.view?.offsetX !== -x || camera.view.offsetY !== -y;
  camera.setViewOffset(width, height, -x, -y, width, height);
  const size = Math.max(80, Math.min(bottom - top, (right - left) * 0.9));
  scale = radius * height / (SHARE * size * Math.tan(camera.fov * Math.PI / 360));
  if (before !== scale) {
    camera.position.sub(controls.target).multiplyScalar(scale / before).add(controls.target);
    dirty = true;
  }
}

/** chase: from behind; top: from above, what lies ahead is up; fit: as it is, and the robot as large as at the begin. */
export function look(next) {
  const offset = new THREE.Vector3().subVectors(camera.position, controls.target);
  following = true;
  controls.target.set(at.x, at.y, mapped() ? 0 : 0.7 * radius * (next === "top" ? 0 : 1));
  if (next === "top") offset.set(-0.01 * Math.cos(at.yaw), -0.01 * Math.sin(at.yaw), 1).multiplyScalar(mapped() ? 4 : 1.6);
  else if (next === "chase") {
    const from = at.yaw + Math.PI + CHASE.side;
    offset.set(Math.cos(from) * Math.cos(CHASE.height), Math.sin(from) * Math.cos(CHASE.height), Math.sin(CHASE.height));
  } else offset.normalize();
  if (next !== "fit") mode = next;
  camera.position.copy(controls.target).addScaledVector(offset, scale);
  for (const button of by("look").querySelectorAll("[data-look]")) {
    button.setAttribute("aria-pressed", String(button.dataset.look === mode));
  }
  dirty = true;
}
const mapped = () => tab() === "map";
by("look").addEventListener("click", ({ target }) => { if (target.dataset.look) look(target.dataset.look); });
onTab((name) => {
  const flat = name === "map";
  controls.enableRotate = !flat;
  controls.mouseButtons.LEFT = flat ? THREE.MOUSE.PAN : THREE.MOUSE.ROTATE;
  controls.touches.ONE = flat ? THREE.TOUCH.PAN : THREE.TOUCH.ROTATE;
  frameUp();
  look(flat ? "top" : "chase");
});
canvas.addEventListener("pointerdown", () => { if (mapped()) following = false; });
addEventListener("keydown", (event) => {
  const scrolls = event.code.startsWith("Page") ? ", #side, #sheet, #why, #help" : "";
  const other = event.ctrlKey || event.altKey || event.metaKey || event.target.closest?.(`input, textarea, select${scrolls}`);
  if (other || COVERED.includes(tab()) || !orbit(controls, event)) return;
  event.preventDefault();
  dirty = true;
});

function carry(x, y, yaw) {
  const turned = Math.atan2(Math.sin(yaw - at.yaw), Math.cos(yaw - at.yaw)), moved = new THREE.Vector3(x - at.x, y - at.y, 0);
  at = { x, y, yaw };
  if (!placed) {
    placed = true;
    return look(mapped() ? "top" : mode);
  }
  if (!following) return;
  controls.target.add(moved);
  camera.position.add(moved);
  if (mode !== "chase" || mapped() || calm.matches) return;
  camera.position.sub(controls.target).applyAxisAngle(camera.up, turned).add(controls.target);
}

/** The camera as it is placed now, of which the last picture may know a part only. */
function placedCamera() {
  camera.lookAt(controls.target);
  camera.updateMatrixWorld();
  return camera;
}

/** The pixel of a place on the ground. */
export function toScreen(x, y, z = 0) {
  const place = new THREE.Vector3(x, y, z).project(placedCamera()), box = canvas.getBoundingClientRect();
  return [box.left + (place.x + 1) * box.width / 2, box.top + (1 - place.y) * box.height / 2];
}

function showScale() {
  const beside = new THREE.Vector3(1, 0, 0).applyQuaternion(camera.quaternion).add(controls.target);
  const { x, y, z } = controls.target, from = toScreen(x, y, z), to = toScreen(beside.x, beside.y, beside.z);
  const metre = Math.hypot(to[0] - from[0], to[1] - from[1]);
  const length = SCALES.find((each) => each * metre >= BAR) ?? SCALES[SCALES.length - 1];
  by("scale").firstChild.style.width = `${Math.round(length * metre)}px`;
  put("scale-text", `${length} m`);
}

// the robot

async function load() {
  const answer = await fetch("/api/model").catch(() => null);
  if (!answer?.ok) {
    put("scene-note", answer ? await answer.text() : "");
    return void setTimeout(load, 3000);
  }
  notes.clear();
  put("scene-note", "");
  const made = await build(await answer.json(), say);
  scene.remove(robot);
  ({ group: robot, joints, links, supports } = made);
  robot.rotation.order = "ZYX";
  robot.updateMatrixWorld(true);
  const box = new THREE.Box3().setFromObject(robot), size = box.getSize(new THREE.Vector3());
  radius = Number.isFinite(size.x) ? Math.max(0.15, Math.hypot(size.x, size.y, Math.min(size.z, size.x)) / 2) : 0.4;
  scene.add(robot);
  cast(robot);
  shown = "";
  stand();
  frameUp();
  look(mapped() ? "top" : mode);
  begin();
  document.title = words(`${made.name || "Robot"} console`);
  document.body.dataset.model = made.name;
  by("robot-name").textContent = made.name || words("Robot");
}

/** Sets the robot on the ground: its lowest point touches it, whatever the height in odometry is. */
function stand() {
  robot.position.z = 0;
  robot.updateMatrixWorld(true);
  const bottom = lowestOf(supports);
  robot.position.z = Number.isFinite(bottom) ? -bottom : 0;
  robot.updateMatrixWorld(true);
  follow(at.x, at.y);
}

/** Foot → its place: the last link of the leg that bears its name. */
function footPlaces(shown) {
  const places = new Map();
  for (const [name, link] of links) {
    const foot = shown.find((each) => name.startsWith(each.name))?.name;
    if (foot && link.children.length) places.set(foot, new THREE.Vector3().setFromMatrixPosition(link.matrixWorld));
  }
  return places;
}

on("open", load);
on("trail", ({ points }) => { trail = points; lay(driven, trail, 0, 0.03); });
on("wanted", ({ points, frame }) => { fill(wanted, frame === "odom" ? points : [], 0.006); dirty = true; });
on("fast", (frame) => {
  const place = frame.pose && [frame.pose[0], frame.pose[1], frame.pose[5]];
  pose(joints, frame.joints ?? {});
  if (place) {
    const [x, y, , roll, pitch, yaw] = frame.pose;
    carry(x, y, yaw);
    robot.position.set(x, y, robot.position.z);
    robot.rotation.set(roll, pitch, yaw);
    const last = trail[trail.length - 1], step = last ? Math.hypot(x - last[0], y - last[1]) : Infinity;
    if (step >= STEP) {
      if (last && step > 1) trail = [];
      trail.push([x, y]);
      if (trail.length > TRAIL) trail.splice(0, trail.length - TRAIL);
      lay(driven, trail, 0, 0.12 * radius);
    }
    fill(ellipse, ellipseOf(place, frame.covariance), 0.008);
  }
  stand();
  const [request, motion] = [frame.asked, frame.measured].map((speeds) => place ? arcOf(place, speeds) : []);
  lay(asks, request, 0.002, 0.16 * radius);
  lay(moves, motion, 0.003, 0.1 * radius);
  const ahead = (far) => [at.x + far * radius * Math.cos(at.yaw), at.y + far * radius * Math.sin(at.yaw)];
  lay(nose, place ? [ahead(1.15), ahead(1.25)] : [], 0.004, 0.1 * radius);
  fill(truth, frame.truth ? ring(frame.truth, radius, radius, frame.truth[2]) : [], 0.01);
  const stands = frame.legs?.feet ?? [], deviations = frame.covariance?.map((each) => Math.sqrt(Math.abs(each)));
  feet(stands, footPlaces(stands));
  const loads = stands.map(({ bears, load }) => bears && Math.round(load / LOAD));
  if (differs([frame.pose, frame.joints, request, motion, frame.truth, deviations, loads])) dirty = true;
});

/** True if these numbers are others than the last ones by what can be seen: a robot that stands needs no new picture. */
function differs(numbers) {
  const next = JSON.stringify(numbers, (_, value) => typeof value === "number" ? Math.round(value / VISIBLE) : value);
  const before = shown;
  shown = next;
  return next !== before;
}

// pictures

// The renderer is made last: while it begins, which takes a second in software, the page already works.
function begin() {
  if (renderer || blind || !robot.children.length || !view.clientWidth) return;
  try {
    renderer = new THREE.WebGLRenderer({ canvas, antialias: !inSoftware() });
    resize();
    render();
  } catch {
    blind = true;
    say(words("this browser has no WebGL: no 3-D view"));
  }
}

/** True where the processor draws, which has to drive as well: smooth edges cost it four times as much. */
function inSoftware() {
  const context = document.createElement("canvas").getContext("webgl"), info = context?.getExtension("WEBGL_debug_renderer_info");
  const name = info ? context.getParameter(info.UNMASKED_RENDERER_WEBGL) : "";
  context?.getExtension("WEBGL_lose_context")?.loseContext();
  return /SwiftShader|llvmpipe|Software/i.test(name);
}

// Fine pixels give way to the frame rate, down to ENOUGH of them; at last the pictures rest.
function resize() {
  const { clientWidth: width, clientHeight: height } = view, coarse = Math.min(1, Math.sqrt(ENOUGH / (width * height)));
  renderer.setPixelRatio(fine ? Math.min(2, devicePixelRatio) : coarse);
  renderer.setSize(width, height, false);
}

function render() {
  requestAnimationFrame(render);
  const now = performance.now(), { clientWidth: width, clientHeight: height } = view;
  if (began) {  // the browser has drawn the last picture
    const took = now - began;
    began = 0;
    slow = took > SLOW ? slow + 1 : Math.max(0, slow - 0.25);
    resting = !fine && slow > 8;
    if (slow > 8 && fine) {
      fine = false;
      slow = 0;
      resize();
    }
  }
  const size = renderer.getSize(new THREE.Vector2());
  const resized = width && (size.x !== width || size.y !== height);
  if (resized) {
    resize();
    frameUp();
    dirty = true;
  }
  const hidden = document.hidden || (COVERED.includes(tab()) && !resized && pictures);  // a canvas of another size is empty
  if (!dirty || !width || hidden || (now < due && !resized)) return;
  dirty = false;
  controls.update();
  haze(scene.fog, camera, camera.position.distanceTo(controls.target));
  renderer.render(scene, camera);
  ++pictures;
  began = now;
  due = now + (resting ? RESTING : FRAME - 8);  // a picture of the screen is earlier or later by half of one
}

// a stroke

let finish = null, points = [], finger = null;
/** Resolves with the points in odom that the next stroke on the ground draws; with none if it is cancelled. */
export function draw() {
  end([]);
  view.classList.add("drawing");
  controls.enabled = false;
  points = [];
  return new Promise((resolve) => { finish = resolve; });
}
function end(result) {
  finish?.(result);
  finish = finger = null;
  view.classList.remove("drawing");
  controls.enabled = true;
  fill(drawn, [], 0);
  dirty = true;
}
function ground(event) {
  const box = canvas.getBoundingClientRect(), ray = new THREE.Raycaster();
  const x = 2 * (event.clientX - box.left) / box.width - 1, y = 1 - 2 * (event.clientY - box.top) / box.height;
  ray.setFromCamera({ x, y }, placedCamera());
  return ray.ray.intersectPlane(new THREE.Plane(new THREE.Vector3(0, 0, 1), 0), new THREE.Vector3());
}
canvas.addEventListener("pointerdown", (event) => {
  if (!finish) return;
  if (finger !== null) return end([]);
  const place = ground(event);
  finger = event.pointerId;
  if (place) points.push([place.x, place.y]);
});
canvas.addEventListener("pointermove", (event) => {
  if (!finish || event.pointerId !== finger) return;
  const place = ground(event), last = points[points.length - 1];
  if (!place || points.length >= 1000 || (last && Math.hypot(place.x - last[0], place.y - last[1]) < 0.1)) return;
  points.push([place.x, place.y]);
  fill(drawn, points, 0.01);
  dirty = true;
});
canvas.addEventListener("pointerup", (event) => { if (event.pointerId === finger) end(points); });
addEventListener("keydown", ({ code }) => { if (code === "Escape" && finish) end([]); });

controls.maxPolarAngle = 0.49 * Math.PI;
Object.assign(controls, { minDistance: NEAREST, maxDistance: FARTHEST });
controls.addEventListener("change", () => { dirty = true; });
camera.position.set(-1.3, -1.3, 1.2);
scene.add(...surroundings, marks, robot);
recolour(scene);
scheme.addEventListener("change", recoloured);
addEventListener("resize", () => { frameUp(); dirty = true; });
on("slow", () => {
  begin();
  frameUp();
  showScale();
  document.body.dataset.pictures = String(pictures);
});
look(mapped() ? "top" : "chase");

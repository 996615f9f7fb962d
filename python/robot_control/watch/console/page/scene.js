// The robot on a grid: the path driven and wanted, the covariance and the truth; and a path drawn with the pointer.
import * as THREE from "/lib/three/build/three.module.js";
import { OrbitControls } from "/lib/three/examples/jsm/controls/OrbitControls.js";
import { on } from "/link.js";
import { build, pose } from "/robot.js";
import { words } from "/words.js";

const MAX_POINTS = 5000, STEP = 0.05;   // of the path driven; m between two of them
const MAX_NOTES = 6;                    // of meshes that cannot be shown
const SIGMAS = 2.448;                   // 95 % of a normal distribution in the plane
const FRAME = 50;                       // ms between two pictures
const LATE = 40, RESTING = 250;         // ms; a browser that is so late rests so long, because driving comes first
const HALF = 20, SQUARE = 0.5, PIECE = 1;    // m; a software renderer loses long lines that begin behind the camera
const view = document.getElementById("view"), note = document.getElementById("scene-note");
const canvas = document.getElementById("scene"), notes = new Set();
export const scene = new THREE.Scene();
const camera = new THREE.PerspectiveCamera(50, 1, 0.05, 500);
let robot = new THREE.Group(), joints = new Map(), lift = 0, trail = [];
camera.up.set(0, 0, 1);
const controls = new OrbitControls(camera, canvas);
let renderer = null, dirty = true, placed = false, called = 0, due = 0;

function say(text) {
  notes.add(text);
  note.textContent = [...notes].slice(0, MAX_NOTES).join("; ");
}

export function polyline(colour, size, dashed) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(3 * size), 3));
  geometry.setDrawRange(0, 0);
  const style = { color: colour, dashSize: 0.08, gapSize: 0.05 };
  const Material = dashed ? THREE.LineDashedMaterial : THREE.LineBasicMaterial;
  const line = new THREE.Line(geometry, new Material(dashed ? style : { color: colour }));
  line.frustumCulled = false;
  scene.add(line);
  return line;
}

/** Something was changed: draws again. */
export function redraw() { dirty = true; }

export function fill(line, points, z) {
  const attribute = line.geometry.attributes.position, count = Math.min(points.length, attribute.count);
  points.slice(-count).forEach(([x, y], i) => attribute.setXYZ(i, x, y, z));
  attribute.needsUpdate = true;
  line.geometry.setDrawRange(0, count);
  if (line.material.isLineDashedMaterial) line.computeLineDistances();
  dirty = true;
}

const driven = polyline(0x3b82f6, MAX_POINTS), wanted = polyline(0xd97706, 2000, true);
const ellipse = polyline(0x8894a2, 65), truth = polyline(0x10a35a, 66), drawn = polyline(0xd97706, 1000);

function ring([x, y], a, b, angle) {
  return Array.from({ length: 65 }, (_, i) => {
    const u = a * Math.cos(i * Math.PI / 32), v = b * Math.sin(i * Math.PI / 32);
    return [x + u * Math.cos(angle) - v * Math.sin(angle), y + u * Math.sin(angle) + v * Math.cos(angle)];
  });
}

function ellipseOf(centre, [xx, xy, yy]) {
  const middle = (xx + yy) / 2, root = Math.hypot((xx - yy) / 2, xy);
  const [a, b] = [middle + root, middle - root].map((value) => SIGMAS * Math.sqrt(Math.max(value, 0)));
  return ring(centre, a, b, Math.atan2(2 * xy, xx - yy) / 2);
}

// The renderer is made last: while it begins, which takes a second in software, the page already works.
function begin() {
  try {
    renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true });
    render();
  } catch {
    say("this browser has no WebGL: no 3-D view");
  }
}

async function load() {
  const answer = await fetch("/api/model").catch(() => null);
  if (!answer?.ok) {
    note.textContent = answer ? await answer.text() : "";
    return void setTimeout(load, 3000);
  }
  notes.clear(); note.textContent = "";
  const made = await build(await answer.json(), say);
  scene.remove(robot);
  ({ group: robot, joints } = made);
  robot.updateMatrixWorld(true);
  const bottom = new THREE.Box3().setFromObject(robot).min.z;
  lift = Number.isFinite(bottom) ? -bottom : 0;  // odom is at the height of the root link
  robot.position.set(controls.target.x, controls.target.y, lift);
  scene.add(robot);
  dirty = true;
  if (!renderer) begin();
  document.title = words(`${made.name || "Robot"} console`);
  document.body.dataset.model = made.name;
}

on("open", load);
on("trail", ({ points }) => { trail = points; fill(driven, trail, 0.004); });
on("wanted", ({ points, frame }) => fill(wanted, frame === "odom" ? points : [], 0.006));
on("fast", (frame) => {
  if (frame.pose) {
    const [x, y, yaw] = frame.pose, moved = new THREE.Vector3(x - controls.target.x, y - controls.target.y, 0);
    if (placed) camera.position.add(moved);
    else camera.position.set(x - 1.3, y - 1.3, 1.2);
    controls.target.add(moved);
    placed = true;
    robot.position.set(x, y, lift);
    robot.rotation.set(0, 0, yaw);
    const last = trail[trail.length - 1], step = last ? Math.hypot(x - last[0], y - last[1]) : Infinity;
    if (step >= STEP) {
      if (last && step > 1) trail = [];
      trail.push([x, y]);
      if (trail.length > MAX_POINTS) trail = trail.filter((_, i) => i % 2);
      fill(driven, trail, 0.004);
    }
    fill(ellipse, ellipseOf(frame.pose, frame.covariance), 0.008);
  }
  fill(truth, frame.truth ? [...ring(frame.truth, 0.25, 0.25, frame.truth[2]), frame.truth] : [], 0.01);
  pose(joints, frame.joints ?? {});
  dirty = true;
});

function render() {
  requestAnimationFrame(render);
  const { clientWidth: width, clientHeight: height } = view, size = renderer.getSize(new THREE.Vector2());
  if (size.x !== width || size.y !== height) {
    renderer.setSize(width, height, false);
    camera.aspect = width / height;
    camera.updateProjectionMatrix();
    dirty = true;
  }
  const now = performance.now(), late = now - called;
  called = now;
  if (!dirty || !width || document.hidden || now < due) return;
  dirty = false;
  controls.update();
  renderer.render(scene, camera);
  due = now + (late > LATE ? RESTING : FRAME);
}

let finish = null, points = [];
/** Resolves with the points in odom that the next stroke on the grid draws. */
export function draw() {
  view.classList.add("drawing");
  controls.enabled = false;
  points = [];
  return new Promise((resolve) => { finish = resolve; });
}
function ground(event) {
  const box = canvas.getBoundingClientRect(), ray = new THREE.Raycaster();
  const x = 2 * (event.clientX - box.left) / box.width - 1, y = 1 - 2 * (event.clientY - box.top) / box.height;
  ray.setFromCamera({ x, y }, camera);
  return ray.ray.intersectPlane(new THREE.Plane(new THREE.Vector3(0, 0, 1), 0), new THREE.Vector3());
}
canvas.addEventListener("pointerdown", (event) => {
  const at = finish && ground(event);
  if (at) points.push([at.x, at.y]);
});
canvas.addEventListener("pointermove", (event) => {
  if (!finish || !event.buttons) return;
  const at = ground(event), last = points[points.length - 1];
  if (!at || points.length >= 1000 || (last && Math.hypot(at.x - last[0], at.y - last[1]) < 0.1)) return;
  points.push([at.x, at.y]);
  fill(drawn, points, 0.01);
});
canvas.addEventListener("pointerup", () => {
  if (!finish) return;
  view.classList.remove("drawing");
  controls.enabled = true;
  finish(points);
  finish = null;
  fill(drawn, [], 0);
});

controls.target.set(0, 0, 0.1);
controls.addEventListener("change", () => { dirty = true; });
camera.position.set(-1.3, -1.3, 1.2);
const squares = new THREE.BufferGeometry(), lines = [];
for (let at = -HALF; at <= HALF; at += SQUARE) {
  for (let from = -HALF; from < HALF; from += PIECE) {
    lines.push(from, at, 0, from + PIECE, at, 0, at, from, 0, at, from + PIECE, 0);
  }
}
squares.setAttribute("position", new THREE.Float32BufferAttribute(lines, 3));
const faint = new THREE.LineBasicMaterial({ color: 0x8d99a6, transparent: true, opacity: 0.6 });
const grid = new THREE.LineSegments(squares, faint);
grid.frustumCulled = false;
const sun = new THREE.DirectionalLight(0xffffff, 0.7);
sun.position.set(-2, -3, 5);
scene.add(grid, robot, new THREE.HemisphereLight(0xffffff, 0x777777, 0.7), sun);

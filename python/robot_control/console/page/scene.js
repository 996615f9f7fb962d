// The robot on a grid: its URDF with meshes, the path driven and wanted, the covariance and the truth.
import * as THREE from "/lib/three/build/three.module.js";
import { OrbitControls } from "/lib/three/examples/jsm/controls/OrbitControls.js";
import { STLLoader } from "/lib/three/examples/jsm/loaders/STLLoader.js";
import { ColladaLoader } from "/lib/three/examples/jsm/loaders/ColladaLoader.js";
import { OBJLoader } from "/lib/three/examples/jsm/loaders/OBJLoader.js";
import { on } from "/link.js";

const MAX_POINTS = 5000, STEP = 0.05;   // of the path driven; m between two of them
const SIGMAS = 2.448;                   // 95 % of a normal distribution in the plane
const view = document.getElementById("view"), note = document.getElementById("scene-note");
const canvas = document.getElementById("scene");
const joints = new Map();
const scene = new THREE.Scene(), robot = new THREE.Group(), camera = new THREE.PerspectiveCamera(50, 1, 0.05, 500);
const FRAME = 50, LATE = 40, RESTING = 250;  // ms between two pictures; a browser that is late gets a rest, for driving comes first
let called = 0, due = 0;
let renderer = null, controls = null, dirty = true, placed = false, lift = 0;
const notes = new Set();

function say(text) {
  notes.add(text);
  note.textContent = [...notes].slice(0, 4).join("; ");
}

function polyline(colour, size, dashed) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(3 * size), 3));
  geometry.setDrawRange(0, 0);
  const Material = dashed ? THREE.LineDashedMaterial : THREE.LineBasicMaterial;
  const line = new THREE.Line(geometry, new Material({ color: colour, ...(dashed ? { dashSize: 0.08, gapSize: 0.05 } : {}) }));
  line.frustumCulled = false;
  scene.add(line);
  return line;
}

function fill(line, points, z) {
  const attribute = line.geometry.attributes.position, count = Math.min(points.length, attribute.count);
  points.slice(-count).forEach(([x, y], i) => attribute.setXYZ(i, x, y, z));
  attribute.needsUpdate = true;
  line.geometry.setDrawRange(0, count);
  if (line.material.isLineDashedMaterial) line.computeLineDistances();
  dirty = true;
}

const driven = polyline(0x3b82f6, MAX_POINTS), wanted = polyline(0xd97706, 2000, true);
const ellipse = polyline(0x8894a2, 65), truth = polyline(0x10a35a, 35), drawn = polyline(0xd97706, 1000);
let trail = [];

function ellipseOf([x, y], [xx, xy, yy]) {
  const middle = (xx + yy) / 2, root = Math.hypot((xx - yy) / 2, xy), angle = Math.atan2(2 * xy, xx - yy) / 2;
  const [a, b] = [middle + root, middle - root].map((value) => SIGMAS * Math.sqrt(Math.max(value, 0)));
  return Array.from({ length: 65 }, (_, i) => {
    const u = a * Math.cos(i * Math.PI / 32), v = b * Math.sin(i * Math.PI / 32);
    return [x + u * Math.cos(angle) - v * Math.sin(angle), y + u * Math.sin(angle) + v * Math.cos(angle)];
  });
}

function truthOf([x, y, yaw]) {
  const ring = Array.from({ length: 33 }, (_, i) => [x + 0.25 * Math.cos(yaw + i * Math.PI / 16), y + 0.25 * Math.sin(yaw + i * Math.PI / 16)]);
  return [...ring, [x, y]];
}

// the model

function placeAt(object, { xyz, rpy }) {
  object.position.set(...xyz);
  object.rotation.set(rpy[0], rpy[1], rpy[2], "ZYX");
}

const LOADERS = {
  stl: (data) => {
    const geometry = new STLLoader().parse(data);
    geometry.computeVertexNormals();  // those of the file are often zero
    return new THREE.Mesh(geometry);
  },
  obj: (data) => new OBJLoader().parse(new TextDecoder().decode(data)),
  dae: (data) => {
    const text = new TextDecoder().decode(data).replace(/<texture\b[^>]*?(\/>|>[\s\S]*?<\/texture>)/g, "");  // no pictures are served
    const model = new ColladaLoader().parse(text, "/").scene;
    model.quaternion.set(0, 0, 0, 1);  // as RViz: the axes of the file are those of the link
    return model;
  },
};

async function mesh(visual, material) {
  const answer = await fetch(`/api/mesh/${visual.mesh}`);
  if (!answer.ok) throw new Error(await answer.text());
  const object = LOADERS[visual.format](await answer.arrayBuffer());
  let corners = 0;
  object.traverse((part) => {
    if (!part.isMesh) return;
    corners += part.geometry.attributes.position?.count ?? 0;
    if (visual.format !== "dae" || visual.colour) part.material = material;
  });
  const box = new THREE.Box3().setFromObject(object);
  if (!corners || !Number.isFinite(box.min.x + box.max.x)) throw new Error("holds no triangle");
  object.scale.multiply(new THREE.Vector3(...visual.scale));
  return object;
}

function shape(visual) {
  const colour = visual.colour ?? [0.6, 0.65, 0.7, 1];
  const material = new THREE.MeshPhongMaterial({
    color: new THREE.Color(...colour.slice(0, 3)), transparent: colour[3] < 1, opacity: colour[3], side: THREE.DoubleSide,
  });
  const group = new THREE.Group();
  placeAt(group, visual);
  if (visual.shape === "box") group.add(new THREE.Mesh(new THREE.BoxBufferGeometry(...visual.size), material));
  else if (visual.shape === "sphere") group.add(new THREE.Mesh(new THREE.SphereBufferGeometry(visual.radius ?? 0.05, 24, 16), material));
  else if (visual.shape === "cylinder") {
    const cylinder = new THREE.Mesh(new THREE.CylinderBufferGeometry(visual.radius ?? 0.05, visual.radius ?? 0.05, visual.length ?? 0.05, 32), material);
    cylinder.rotation.x = Math.PI / 2;
    group.add(cylinder);
  } else if (visual.shape === "mesh") {
    const fail = (error) => {
      say(`${visual.file}: ${error.message}`);
      const instead = new THREE.Mesh(new THREE.BoxBufferGeometry(0.1, 0.1, 0.1), new THREE.MeshBasicMaterial({ color: 0xd97706, wireframe: true }));
      group.add(instead);
    };
    pending.push(mesh(visual, material).then((object) => group.add(object), fail).then(() => { dirty = true; }));
  }
  return group;
}

const pending = [];
async function load() {
  const answer = await fetch("/api/model").catch(() => null);
  if (!answer?.ok) {
    note.textContent = answer ? await answer.text() : "";
    return void setTimeout(load, 3000);
  }
  const tree = await answer.json();
  document.title = `${tree.name || "Robot"} console`;
  notes.clear(); note.textContent = ""; joints.clear(); pending.length = 0;
  robot.remove(...robot.children);
  const links = new Map(tree.links.map((link) => {
    const group = new THREE.Group();
    link.visuals.forEach((visual) => group.add(shape(visual)));
    return [link.name, group];
  }));
  const children = new Set();
  for (const joint of tree.joints) {
    const parent = links.get(joint.parent), child = links.get(joint.child);
    if (!parent || !child || children.has(joint.child) || parent === child) continue;
    children.add(joint.child);
    const fixed = new THREE.Group(), moving = new THREE.Group();
    placeAt(fixed, joint);
    fixed.add(moving); moving.add(child); parent.add(fixed);
    joints.set(joint.name, { moving, type: joint.type, axis: new THREE.Vector3(...joint.axis).normalize() });
  }
  for (const [name, group] of links) if (!children.has(name)) robot.add(group);
  await Promise.all(pending);
  robot.position.z = 0;
  robot.updateMatrixWorld(true);
  const bottom = new THREE.Box3().setFromObject(robot).min.z;
  robot.position.z = lift = Number.isFinite(bottom) ? -bottom : 0;  // odom is at the height of the root link
  document.body.dataset.model = tree.name;
  dirty = true;
}

// frames

on("open", () => { if (renderer) load(); });
on("trail", ({ points }) => { trail = points; fill(driven, trail, 0.004); });
on("wanted", ({ points, frame }) => fill(wanted, frame === "odom" ? points : [], 0.006));
on("fast", (frame) => {
  if (frame.pose) {
    const [x, y, yaw] = frame.pose, moved = new THREE.Vector3(x, y, robot.position.z).sub(robot.position);
    robot.position.set(x, y, lift);
    robot.rotation.set(0, 0, yaw);
    if (controls) { controls.target.add(moved); camera.position.add(moved); }
    if (!placed && controls) { camera.position.set(x - 1.6, y - 1.6, 1.5); controls.target.set(x, y, 0.1); placed = true; }
    const last = trail[trail.length - 1];
    if (!last || Math.hypot(x - last[0], y - last[1]) >= STEP) {
      if (last && Math.hypot(x - last[0], y - last[1]) > 1) trail = [];
      trail.push([x, y]);
      if (trail.length > MAX_POINTS) trail = trail.filter((_, i) => i % 2);
      fill(driven, trail, 0.004);
    }
    fill(ellipse, ellipseOf(frame.pose, frame.covariance), 0.008);
  }
  fill(truth, frame.truth ? truthOf(frame.truth) : [], 0.01);
  for (const [name, position] of Object.entries(frame.joints ?? {})) {
    const joint = joints.get(name);
    if (!joint || position === null) continue;
    if (joint.type === "prismatic") joint.moving.position.copy(joint.axis).multiplyScalar(position);
    else joint.moving.quaternion.setFromAxisAngle(joint.axis, position);
  }
  dirty = true;
});

function render() {
  requestAnimationFrame(render);
  const { clientWidth: width, clientHeight: height } = view;
  const size = renderer.getSize(new THREE.Vector2());
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

// a path, drawn with the pointer

let finish = null, points = [];
/** Resolves with the points in odom that the next stroke on the grid draws. */
export function draw() {
  view.classList.add("drawing");
  if (controls) controls.enabled = false;
  points = [];
  return new Promise((resolve) => { finish = resolve; });
}
function ground(event) {
  const box = canvas.getBoundingClientRect(), ray = new THREE.Raycaster();
  ray.setFromCamera({ x: 2 * (event.clientX - box.left) / box.width - 1, y: 1 - 2 * (event.clientY - box.top) / box.height }, camera);
  return ray.ray.intersectPlane(new THREE.Plane(new THREE.Vector3(0, 0, 1), 0), new THREE.Vector3());
}
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
  if (controls) controls.enabled = true;
  finish(points);
  finish = null;
  fill(drawn, [], 0);
});

try {
  renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true });
  controls = new OrbitControls(camera, canvas);
  controls.addEventListener("change", () => { dirty = true; });
} catch {
  say("this browser has no WebGL: no 3-D view");
}
camera.up.set(0, 0, 1);
camera.position.set(-1.6, -1.6, 1.5);
camera.lookAt(0, 0, 0.1);
const HALF = 20, SQUARE = 0.5, PIECE = 1, lines = [];  // m; a software renderer loses long lines that begin behind the camera
for (let at = -HALF; at <= HALF; at += SQUARE) {
  for (let from = -HALF; from < HALF; from += PIECE) {
    lines.push(from, at, 0, from + PIECE, at, 0, at, from, 0, at, from + PIECE, 0);
  }
}
const squares = new THREE.BufferGeometry();
squares.setAttribute("position", new THREE.Float32BufferAttribute(lines, 3));
const grid = new THREE.LineSegments(squares, new THREE.LineBasicMaterial({ color: 0x8d99a6, transparent: true, opacity: 0.6 }));
grid.frustumCulled = false;
const sun = new THREE.DirectionalLight(0xffffff, 0.7);
sun.position.set(-2, -3, 5);
scene.add(grid, robot, new THREE.HemisphereLight(0xffffff, 0x777777, 0.7), sun);
if (renderer) requestAnimationFrame(render);

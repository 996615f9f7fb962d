// The map from above: grids as flat pictures, scan, particles, the way that was planned and its goal; a switch for each.
import * as THREE from "/lib/three/build/three.module.js";
import { by, make, put } from "/dom.js";
import { on } from "/link.js";
import { fill, lay, polyline, ribbon } from "/marks.js";
import { recoloured, redraw, scene } from "/scene.js";
import { openTab, tab } from "/tabs.js";
import { commands } from "/why.js";
import { words } from "/words.js";

const KEY = "console-layers", START = "roslaunch robot_control navigation.launch";
const HEIGHTS = { map: -0.006, costmap: -0.004 };  // m; below the paths
const WALL = 65;                                   // occupied from here on, as navigate has it
const COLOURS = {
  map: (cell) => cell < 0 ? [128, 134, 142, 150] : cell >= WALL ? [22, 26, 33, 255] : [248 - cell, 250 - cell, 252 - cell, 235],
  costmap: (cell) => cell >= 99 ? [214, 40, 57, 150] : [230, 140, 30, Math.max(0, 1.3 * cell)],
};
const LAYERS = { map: "map", costmap: "cost", scan: "scan", cloud: "particles", planned: "planned way and goal" };
const map = new THREE.Group(), grids = {}, marks = {};
const planned = polyline("limited", 2000, true), flag = ribbon("goal", 2, { head: true });
const scan = dots("goal", 1000), cloud = dots("asked", 300);
let pose = null, shown = { costmap: false };
const live = make("div"), start = make("div");
const recorded = make("div", { textContent: words("This recording has no map. record:=true at the start of the robot also records its map.") });
commands(start, [START]);
live.append(words("There is no map. Start navigation:"), start);
by("no-map").append(live, recorded);
scene.add(map);
map.add(planned, flag, cloud);
map.visible = false;

function dots(token, size) {
  const geometry = new THREE.BufferGeometry(), style = { size: 3, sizeAttenuation: false, fog: false };
  geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(3 * size), 3));
  const points = new THREE.Points(geometry, new THREE.PointsMaterial(style));
  points.frustumCulled = false;
  points.userData.token = token;
  scene.add(points);
  return points;
}

async function load(name) {
  const answer = await fetch(`/api/grids/${name}`).catch(() => null);
  if (!answer?.ok) return;
  const { x, y, yaw, resolution, columns, cells } = await answer.json();
  const values = Int8Array.from(atob(cells), (sign) => sign.charCodeAt(0)), height = values.length / columns;
  const pixels = new Uint8Array(4 * values.length);
  values.forEach((cell, i) => pixels.set(COLOURS[name](cell), 4 * i));
  const texture = new THREE.DataTexture(pixels, columns, height, THREE.RGBAFormat);
  texture.needsUpdate = true;
  const [w, h] = [columns * resolution, height * resolution];
  const plane = new THREE.PlaneGeometry(w, h).translate(w / 2, h / 2, 0);
  const layer = new THREE.Mesh(plane, new THREE.MeshBasicMaterial({ map: texture, transparent: true, depthWrite: false, fog: false }));
  layer.position.set(x, y, HEIGHTS[name]);
  layer.rotation.z = yaw;
  layer.renderOrder = -1;
  if (grids[name]) {
    map.remove(grids[name]);
    grids[name].material.map.dispose();
    grids[name].material.dispose();
    grids[name].geometry.dispose();
  }
  map.add(grids[name] = layer);
  document.body.dataset[name] = String(Number(document.body.dataset[name] ?? 0) + 1);
  apply();
}

on("slow", ({ navigation, goal, replay }) => {
  pose = navigation.map ?? null;
  if (pose || map.visible) redraw();
  map.visible = Boolean(pose);
  by("map-tools").hidden = !pose;
  by("no-map").hidden = Boolean(pose);
  live.hidden = Boolean(replay);
  recorded.hidden = !replay;
  by("go-here").hidden = !pose || !goal || tab() !== "drive";
  put("goal-state", goal ? `goal: ${goal}` : "navigate does not run");
  if (pose) {
    map.position.set(pose[0], pose[1], 0);
    map.rotation.z = pose[2];
  }
  for (const [name, mark] of Object.entries(navigation.grids)) {
    if (marks[name] !== mark) load(name);
    marks[name] = mark;
  }
  fill(scan, navigation.scan ?? [], 0.02);
  fill(cloud, navigation.particles ?? [], 0.02);
});
on("wanted", ({ points, frame }) => {
  const way = frame === "map" ? points : [], goal = way[way.length - 1], before = way[way.length - 2];
  fill(planned, way, 0.006);
  const length = before ? Math.hypot(goal[0] - before[0], goal[1] - before[1]) || 1 : 1;
  const tail = before && [goal[0] - 0.25 * (goal[0] - before[0]) / length, goal[1] - 0.25 * (goal[1] - before[1]) / length];
  lay(flag, before ? [tail, goal] : [], 0.01, 0.1);
  redraw();
});

by("go-here").addEventListener("click", () => {
  openTab("map");
  by("set-goal").click();
});

// layers

const parts = { scan: [scan], cloud: [cloud], planned: [planned, flag] };
function apply() {
  for (const name of Object.keys(LAYERS)) {
    for (const part of parts[name] ?? [grids[name]]) if (part) part.visible = shown[name] !== false;
  }
  redraw();
}
try { shown = { ...shown, ...JSON.parse(localStorage.getItem(KEY)) }; } catch { /* what is stored is none */ }
for (const [name, label] of Object.entries(LAYERS)) {
  const box = make("input", { type: "checkbox", checked: shown[name] !== false, id: `layer-${name}` });
  box.addEventListener("change", () => {
    shown[name] = box.checked;
    try { localStorage.setItem(KEY, JSON.stringify(shown)); } catch { /* forgotten with the page */ }
    apply();
  });
  by("layers").append(make("label", {}, box, make("span", { textContent: words(label) })));
}
apply();
recoloured();

/** Returns the place `from` in the map's frame, with the heading towards `to`; both are in odom. */
export function onMap(from, to) {
  if (!pose) return null;
  const [x, y, yaw] = pose, dx = from[0] - x, dy = from[1] - y;
  const heading = Math.atan2(to[1] - from[1], to[0] - from[0]) - yaw;
  return {
    x: Math.cos(yaw) * dx + Math.sin(yaw) * dy,
    y: Math.cos(yaw) * dy - Math.sin(yaw) * dx,
    yaw: Math.atan2(Math.sin(heading), Math.cos(heading)),
  };
}

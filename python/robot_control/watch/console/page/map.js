// The grids of map and costmap as flat pictures, the scan, the particles, and the way that was planned on the map.
import * as THREE from "/lib/three/build/three.module.js";
import { on } from "/link.js";
import { fill, polyline, redraw, scene } from "/scene.js";

const HEIGHTS = { map: -0.004, costmap: -0.002 };  // m; below the lines of the grid and the paths
const COLOURS = {
  map: (cell) => cell < 0 ? [128, 128, 128, 60] : [255 - 2.3 * cell, 255 - 2.3 * cell, 255 - 2 * cell, 230],
  costmap: (cell) => cell >= 99 ? [220, 60, 60, 120] : [220, 140, 40, Math.max(0, cell)],
};
const map = new THREE.Group(), layers = {}, marks = {};
const wanted = polyline(0xd97706, 2000, true), scan = dots(0xdb2777, 1000, 0.02), cloud = dots(0x7c3aed, 300, 0.02);
let pose = null;
scene.add(map);
map.add(wanted, cloud);
map.visible = false;

function dots(colour, size, height) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(3 * size), 3));
  const points = new THREE.Points(geometry, new THREE.PointsMaterial({ color: colour, size: 3, sizeAttenuation: false }));
  points.frustumCulled = false;
  points.userData.height = height;
  scene.add(points);
  return points;
}

async function show(name) {
  const answer = await fetch(`/api/grids/${name}`).catch(() => null);
  if (!answer?.ok) return;
  const { x, y, yaw, resolution, columns, cells } = await answer.json();
  const values = Int8Array.from(atob(cells), (sign) => sign.charCodeAt(0)), rows = values.length / columns;
  const pixels = new Uint8Array(4 * values.length);
  values.forEach((cell, i) => pixels.set(COLOURS[name](cell), 4 * i));
  const texture = new THREE.DataTexture(pixels, columns, rows, THREE.RGBAFormat);
  texture.needsUpdate = true;
  const width = columns * resolution, height = rows * resolution;
  const plane = new THREE.PlaneGeometry(width, height).translate(width / 2, height / 2, 0);
  const layer = new THREE.Mesh(plane, new THREE.MeshBasicMaterial({ map: texture, transparent: true, depthWrite: false }));
  layer.position.set(x, y, HEIGHTS[name]);
  layer.rotation.z = yaw;
  if (layers[name]) {
    map.remove(layers[name]);
    layers[name].material.map.dispose();
    layers[name].material.dispose();
    layers[name].geometry.dispose();
  }
  map.add(layers[name] = layer);
  document.body.dataset[name] = String(Number(document.body.dataset[name] ?? 0) + 1);
  redraw();
}

on("slow", ({ navigation }) => {
  pose = navigation.map ?? null;
  map.visible = Boolean(pose);
  if (pose) {
    map.position.set(pose[0], pose[1], 0);
    map.rotation.z = pose[2];
  }
  for (const [name, mark] of Object.entries(navigation.grids)) {
    if (marks[name] !== mark) show(name);
    marks[name] = mark;
  }
  fill(scan, navigation.scan ?? [], scan.userData.height);
  fill(cloud, navigation.particles ?? [], cloud.userData.height);
});
on("wanted", ({ points, frame }) => fill(wanted, frame === "map" ? points : [], 0.006));

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

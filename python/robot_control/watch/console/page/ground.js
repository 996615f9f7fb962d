// The floor with a line each metre up to the horizon, light and a soft shadow, in the colours of the page's scheme.
import * as THREE from "/lib/three/build/three.module.js";

const HALF = 16, PIECE = 2;    // m; a software renderer loses long lines that begin behind the camera
const HORIZON = 60;            // m
const SHADOW = 1024;           // px of its map
const token = (name) => new THREE.Color(getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim());

const floor = new THREE.Mesh(new THREE.CircleBufferGeometry(HORIZON, 48), new THREE.MeshBasicMaterial());
const lines = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial());
const sun = new THREE.DirectionalLight(0xffffff, 0.75), sky = new THREE.HemisphereLight(0xffffff, 0x8a8f98, 0.62);
const shade = new THREE.Mesh(new THREE.PlaneBufferGeometry(1, 1), new THREE.ShadowMaterial({ opacity: 0.3 }));
const ground = new THREE.Group().add(floor, lines, shade);
export const surroundings = [ground, sun, sun.target, sky];

const places = [];
for (let at = -HALF; at <= HALF; ++at) {
  for (let from = -HALF; from < HALF; from += PIECE) {
    places.push(from, at, 0, from + PIECE, at, 0, at, from, 0, at, from + PIECE, 0);
  }
}
lines.geometry.setAttribute("position", new THREE.Float32BufferAttribute(places, 3));
lines.frustumCulled = false;
floor.position.z = -0.012;
lines.position.z = -0.008;
shade.position.z = -0.002;
shade.receiveShadow = sun.castShadow = true;
floor.material.depthWrite = lines.material.depthWrite = false;
floor.renderOrder = -3;
lines.renderOrder = -2;
sun.shadow.mapSize.set(SHADOW, SHADOW);
sun.shadow.radius = 5;

/** The colours of tokens.css: again whenever the scheme changes. */
export function recolour(scene) {
  scene.background = token("sky");
  scene.fog = new THREE.Fog(scene.background);
  floor.material.color = token("floor");
  lines.material.color = token("lines");
  for (const part of scene.children) part.traverse(({ material, userData }) => {
    if (userData.token) material.color = token(userData.token);
  });
}

/** The floor goes on under a robot at this place, and its shadow is as large as the robot. */
export function follow(x, y, radius) {
  floor.position.x = x; floor.position.y = y;
  lines.position.x = Math.round(x); lines.position.y = Math.round(y);
  shade.position.x = x; shade.position.y = y;
  shade.scale.setScalar(7 * radius);
  sun.position.set(x - 1.5 * radius, y - 2.2 * radius, 4.5 * radius);
  sun.target.position.set(x, y, 0);
  const { camera } = sun.shadow;
  Object.assign(camera, { left: -2 * radius, right: 2 * radius, top: 2 * radius, bottom: -2 * radius, near: radius, far: 9 * radius });
  camera.updateProjectionMatrix();
}

/** The haze begins behind what a camera at this distance looks at. */
export function haze(fog, distance) {
  Object.assign(fog, { near: 1.6 * distance + 2, far: 2.5 * distance + HALF });
}

export const shadows = (on) => { shade.visible = sun.castShadow = on; };

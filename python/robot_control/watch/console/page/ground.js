// The floor with a line each metre up to the horizon, light and the robot's shadow, in the colours of the page's scheme.
import * as THREE from "/lib/three/build/three.module.js";

const HALF = 16, PIECE = 2;    // m; a software renderer loses long lines that begin behind the camera
const SECTORS = 48;            // of the ring of haze
const HIGH = 1000;             // m that the sky is high
const SUN = new THREE.Vector3(-1.5, -2.2, 4.5);
const FLAT = 1e-4;             // m of a shadow's height for one of the robot: a matrix with a zero has no inverse
const token = (name) => new THREE.Color(getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim());

// The floor is the colour of an empty picture. Around the camera a ring goes over into the sky, which is a wall on it:
// a software renderer fills a picture in no time, and shades each of its pixels in 30 ms.
const air = new THREE.Mesh(new THREE.BufferGeometry(), new THREE.MeshBasicMaterial({
  vertexColors: THREE.VertexColors, side: THREE.DoubleSide, fog: false, depthTest: false, depthWrite: false,
}));
const lines = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial());
const sun = new THREE.DirectionalLight(0xffffff, 0.75), sky = new THREE.HemisphereLight(0xffffff, 0x8a8f98, 0.62);
// Each shape of the robot once more, pressed onto the floor along the light: a shadow map costs a software renderer 80 ms.
const shade = new THREE.Group(), dark = new THREE.MeshBasicMaterial({ side: THREE.DoubleSide, depthWrite: false });
const pressed = new THREE.Matrix4().set(1, 0, -SUN.x / SUN.z, 0, 0, 1, -SUN.y / SUN.z, 0, 0, 0, FLAT, -0.01, 0, 0, 0, 1);
const ground = new THREE.Group().add(air, lines, shade);
export const surroundings = [ground, sun, sky];

const places = [];
for (let at = -HALF; at <= HALF; ++at) {
  for (let from = -HALF; from < HALF; from += PIECE) {
    places.push(from, at, 0, from + PIECE, at, 0, at, from, 0, at, from + PIECE, 0);
  }
}
lines.geometry.setAttribute("position", new THREE.Float32BufferAttribute(places, 3));
lines.frustumCulled = false;
air.geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(9 * (SECTORS + 1)), 3));
air.geometry.setAttribute("color", new THREE.BufferAttribute(new Float32Array(9 * (SECTORS + 1)), 3));
air.geometry.setIndex(Array.from({ length: SECTORS }, (_, i) => [0, 1].flatMap((circle) => {
  const from = 3 * i + circle;
  return [from, from + 1, from + 3, from + 1, from + 4, from + 3];
})).flat());
air.frustumCulled = false;
air.renderOrder = -3;
lines.position.z = -0.008;
sun.position.copy(SUN);
lines.material.depthWrite = false;
lines.renderOrder = -2;

/** The colours of tokens.css: again whenever the scheme changes. */
export function recolour(scene) {
  scene.background = token("floor");
  scene.fog = new THREE.Fog(token("sky"));
  const { color } = air.geometry.attributes, colours = [scene.background, scene.fog.color, scene.fog.color];
  for (let i = 0; i < color.count; ++i) color.setXYZ(i, ...colours[i % 3].toArray());
  color.needsUpdate = true;
  dark.color = token("shade");
  lines.material.color = token("lines");
  for (const part of scene.children) part.traverse(({ material, userData }) => {
    if (userData.token) material.color = token(userData.token);
  });
}

/** This robot casts the shadow. */
export function cast(robot) {
  shade.remove(...shade.children);
  robot.traverse((part) => {
    if (!part.isMesh) return;
    const shadow = new THREE.Mesh(part.geometry, dark);
    Object.assign(shadow, { matrixAutoUpdate: false, frustumCulled: false, renderOrder: -2.5, userData: { part } });
    shade.add(shadow);
  });
}

/** The lines and the shadow go along with a robot at this place. */
export function follow(x, y) {
  lines.position.x = Math.round(x); lines.position.y = Math.round(y);
  for (const { matrix, userData } of shade.children) matrix.multiplyMatrices(pressed, userData.part.matrixWorld);
}

/** The haze begins behind what a camera that is here, so far from what it looks at, shows. */
export function haze(fog, { position: { x, y } }, distance) {
  const { position } = air.geometry.attributes, near = 1.6 * distance + 2, far = 2.5 * distance + HALF;
  Object.assign(fog, { near, far });
  for (let i = 0; i <= SECTORS; ++i) {
    const angle = 2 * Math.PI * i / SECTORS, [c, s] = [Math.cos(angle), Math.sin(angle)];
    [[near, 0], [far, 0], [far, HIGH]].forEach(([r, z], circle) => position.setXYZ(3 * i + circle, x + r * c, y + r * s, z));
  }
  position.needsUpdate = true;
}

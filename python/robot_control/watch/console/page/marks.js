// What is drawn on the ground: the way driven and wanted, heading and speed, the covariance, the truth, feet that bear.
import * as THREE from "/lib/three/build/three.module.js";

const SIGMAS = 2.448;              // 95 % of a normal distribution in the plane
const AHEAD = 1.2, PARTS = 16;     // s that the arrows of speed look ahead; pieces of their arc
const STILL = 0.02;                // m/s and rad/s; a slower robot has no arrow
const NEWTONS = 60;                // N of a foot's disc of DISC
const DISC = 0.045;                // m
export const marks = new THREE.Group();

function line(token, size, dashed) {
  const geometry = new THREE.BufferGeometry(), style = { dashSize: 0.08, gapSize: 0.05 };
  geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(3 * size), 3));
  geometry.setDrawRange(0, 0);
  const made = new THREE.Line(geometry, dashed ? new THREE.LineDashedMaterial(style) : new THREE.LineBasicMaterial());
  made.frustumCulled = false;
  made.userData.token = token;
  return made;
}

/** A line on the ground in the colour of a token. */
export function polyline(token, size, dashed) {
  const made = line(token, size, dashed);
  marks.add(made);
  return made;
}

export function fill(made, points, z) {
  const attribute = made.geometry.attributes.position, count = Math.min(points.length, attribute.count);
  points.slice(-count).forEach(([x, y], i) => attribute.setXYZ(i, x, y, z));
  attribute.needsUpdate = true;
  made.geometry.setDrawRange(0, count);
  if (made.material.isLineDashedMaterial) made.computeLineDistances();
}

/** A ribbon of `size` points in the colour of a token; it fades towards its begin, and ends in a head. */
export function ribbon(token, size, { fades = false, head = false } = {}) {
  const geometry = new THREE.BufferGeometry(), count = 2 * size + 3, index = [];
  geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(3 * count), 3));
  for (let i = 0; i < size - 1; ++i) index.push(2 * i, 2 * i + 1, 2 * i + 2, 2 * i + 1, 2 * i + 3, 2 * i + 2);
  geometry.setIndex([...index, 2 * size, 2 * size + 1, 2 * size + 2]);
  geometry.setDrawRange(0, 0);
  const material = new THREE.MeshBasicMaterial({ side: THREE.DoubleSide, transparent: true, depthWrite: false });
  if (fades) material.onBeforeCompile = (shader) => {  // three.js has no opacity of a vertex
    shader.vertexShader = shader.vertexShader.replace("void main() {", "attribute float share; varying float vShare; void main() { vShare = share;");
    shader.fragmentShader = shader.fragmentShader.replace("void main() {", "varying float vShare; void main() {")
      .replace("#include <fog_fragment>", "gl_FragColor.a *= vShare;\n#include <fog_fragment>");
  };
  if (fades) geometry.setAttribute("share", new THREE.BufferAttribute(new Float32Array(count), 1));
  const made = new THREE.Mesh(geometry, material);
  made.frustumCulled = false;
  made.userData = { token, size, head };
  marks.add(made);
  return made;
}

export function lay(made, points, z, width) {
  const { position, share } = made.geometry.attributes, { size, head } = made.userData;
  const shown = points.slice(-size), count = shown.length;
  let x = 0, y = 0;
  shown.forEach(([px, py], i) => {
    const [ax, ay] = shown[Math.max(0, i - 1)], [bx, by] = shown[Math.min(count - 1, i + 1)];
    const length = Math.hypot(bx - ax, by - ay) || 1;
    x = width * (bx - ax) / length / 2; y = width * (by - ay) / length / 2;
    position.setXYZ(2 * i, px - y, py + x, z);
    position.setXYZ(2 * i + 1, px + y, py - x, z);
    share?.setX(2 * i, (i + 1) / count);
    share?.setX(2 * i + 1, (i + 1) / count);
  });
  for (let i = count; i && i < size; ++i) {  // what is not used lies on the last point
    for (const side of [0, 1]) position.setXYZ(2 * i + side, ...shown[count - 1], z);
  }
  if (head && count) {
    const [ex, ey] = shown[count - 1];
    position.setXYZ(2 * size, ex - 2.6 * y, ey + 2.6 * x, z);
    position.setXYZ(2 * size + 1, ex + 2.6 * y, ey - 2.6 * x, z);
    position.setXYZ(2 * size + 2, ex + 5 * x, ey + 5 * y, z);
  }
  position.needsUpdate = true;
  if (share) share.needsUpdate = true;
  made.geometry.setDrawRange(0, count > 1 ? 6 * (size - 1) + (head ? 3 : 0) : 0);
}

/** Where this speed brings a robot at this pose, and how. */
export function arcOf([x, y, yaw], speeds) {
  const [v, w, l = 0] = speeds ?? [];
  if (!speeds || (Math.abs(v) < STILL && Math.abs(l) < STILL)) return [];
  const points = [[x, y]];
  for (let i = 0; i < PARTS; ++i) {
    const step = AHEAD / PARTS, angle = yaw + w * step * (i + 0.5), [px, py] = points[i];
    points.push([px + step * (v * Math.cos(angle) - l * Math.sin(angle)), py + step * (v * Math.sin(angle) + l * Math.cos(angle))]);
  }
  return points;
}

export function ring([x, y], a, b, angle) {
  return Array.from({ length: 65 }, (_, i) => {
    const u = a * Math.cos(i * Math.PI / 32), v = b * Math.sin(i * Math.PI / 32);
    return [x + u * Math.cos(angle) - v * Math.sin(angle), y + u * Math.sin(angle) + v * Math.cos(angle)];
  });
}

export function ellipseOf(centre, [xx, xy, yy]) {
  const middle = (xx + yy) / 2, root = Math.hypot((xx - yy) / 2, xy);
  const [a, b] = [middle + root, middle - root].map((value) => SIGMAS * Math.sqrt(Math.max(value, 0)));
  return ring(centre, a, b, Math.atan2(2 * xy, xx - yy) / 2);
}

const discs = new Map();
/** A disc below each foot that bears, as large as its force. */
export function feet(shown, places) {
  for (const { name, bears, load } of shown) {
    if (!discs.has(name)) {
      const made = new THREE.Mesh(new THREE.CircleBufferGeometry(1, 24), new THREE.MeshBasicMaterial({ transparent: true, opacity: 0.75, depthWrite: false }));
      made.userData.token = "true";
      discs.set(name, made);
      marks.add(made);
    }
    const disc = discs.get(name), at = places.get(name);
    disc.visible = Boolean(bears && at && load > 0);
    if (!disc.visible) continue;
    disc.position.set(at.x, at.y, 0.004);
    disc.scale.setScalar(DISC * Math.sqrt(load / NEWTONS));
  }
  for (const [name, disc] of discs) if (!shown.some((foot) => foot.name === name)) disc.visible = false;
}

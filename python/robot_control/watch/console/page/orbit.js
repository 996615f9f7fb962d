// Keys that turn, tilt and zoom the view: what the pointer does by a drag and a wheel.
import * as THREE from "/lib/three/build/three.module.js";

const STEP = 0.1, ZOOM = 1.15;  // rad and factor of one press
const STEEP = 0.01;             // rad between the view and the vertical at least: straight down has no heading
const KEYS = {                  // turn about the vertical, tilt, zoom: by the place of a key, or by its sign
  Comma: [-1, 0, 0], Period: [1, 0, 0], PageUp: [0, -1, 0], PageDown: [0, 1, 0], "+": [0, 0, -1], "=": [0, 0, -1], "-": [0, 0, 1],
};

/** Moves the camera about the target of these controls; false if this key does not. */
export function orbit({ object: camera, target, enableRotate, maxPolarAngle }, { code, key }) {
  const found = [code, key].find((each) => Object.hasOwn(KEYS, each));
  if (!found) return false;
  const [turn, tilt, zoom] = KEYS[found], offset = new THREE.Vector3().subVectors(camera.position, target);
  if (enableRotate) {
    const angle = offset.angleTo(camera.up), next = Math.min(maxPolarAngle, Math.max(STEEP, angle + STEP * tilt));
    offset.applyAxisAngle(new THREE.Vector3().crossVectors(camera.up, offset).normalize(), next - angle);
    offset.applyAxisAngle(camera.up, STEP * turn);
  }
  camera.position.copy(target).addScaledVector(offset, ZOOM ** zoom);
  return true;
}

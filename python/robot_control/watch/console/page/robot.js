// A URDF → a group of three.js that moves with its joints. A mesh that is missing or broken is a box with a note.
import * as THREE from "/lib/three/build/three.module.js";

const LOADERS = {  // loaded where a robot needs them
  stl: async (data) => {
    const { STLLoader } = await import("/lib/three/examples/jsm/loaders/STLLoader.js");
    const geometry = new STLLoader().parse(data);
    geometry.computeVertexNormals();  // those of the file are often zero
    return new THREE.Mesh(geometry);
  },
  dae: async (data) => {
    const { ColladaLoader } = await import("/lib/three/examples/jsm/loaders/ColladaLoader.js");
    const textures = /<texture\b[^>]*?(\/>|>[\s\S]*?<\/texture>)/g;  // their pictures are not served
    const model = new ColladaLoader().parse(new TextDecoder().decode(data).replace(textures, ""), "/").scene;
    model.quaternion.set(0, 0, 0, 1);  // as RViz: the axes of the file are those of the link
    return model;
  },
};

/** The child elements with this name. */
const all = (element, name) => [...(element?.children ?? [])].filter((each) => each.tagName === name);
const text = (element, name, attribute) => all(element, name)[0]?.getAttribute(attribute) ?? "";

/** As many finite numbers as the default has; else the default. */
function numbers(words, otherwise) {
  const found = words.trim().split(/\s+/).map(parseFloat);
  return found.length === otherwise.length && found.every(Number.isFinite) ? found : otherwise;
}

const size = (shape, name) => numbers(shape.getAttribute(name) ?? "", [0.05])[0];
const SHAPES = {
  box: (shape) => new THREE.BoxBufferGeometry(...numbers(shape.getAttribute("size") ?? "", [0.1, 0.1, 0.1])),
  sphere: (shape) => new THREE.SphereBufferGeometry(size(shape, "radius"), 24, 16),
  cylinder: (shape) => {
    const radius = size(shape, "radius");
    return new THREE.CylinderBufferGeometry(radius, radius, size(shape, "length"), 32).rotateX(Math.PI / 2);
  },
};

function placeAt(object, element) {
  const [roll, pitch, yaw] = numbers(text(element, "origin", "rpy"), [0, 0, 0]);
  object.position.set(...numbers(text(element, "origin", "xyz"), [0, 0, 0]));
  object.rotation.set(roll, pitch, yaw, "ZYX");
  return object;
}

function materialOf(visual, root) {
  const own = all(visual, "material")[0], name = own?.getAttribute("name");
  const named = all(root, "material").find((each) => own && each.getAttribute("name") === name);
  const given = text(own, "color", "rgba") || text(named, "color", "rgba");
  const [r, g, b, opacity] = numbers(given, [0.6, 0.65, 0.7, 1]), color = new THREE.Color(r, g, b);
  const transparent = opacity < 1, side = THREE.DoubleSide;
  return { material: new THREE.MeshLambertMaterial({ color, transparent, opacity, side }), given: Boolean(given) };
}

async function mesh(file, id, scale, { material, given }) {
  const format = file.split(".").pop().toLowerCase(), answer = await fetch(`/api/mesh/${id}`);
  if (!answer.ok) throw new Error(await answer.text());
  const object = await LOADERS[format](await answer.arrayBuffer());
  let corners = 0;
  object.traverse((part) => {
    if (!part.isMesh) return;
    corners += part.geometry.attributes.position?.count ?? 0;
    if (format !== "dae" || given) part.material = material;
  });
  const { min, max } = new THREE.Box3().setFromObject(object);
  if (!corners || !Number.isFinite(min.x + max.x)) throw new Error("holds no triangle");
  object.scale.multiply(new THREE.Vector3(...scale));
  return object;
}

/** Resolves with {name, group, joints, links, supports} once every mesh is there; `say` takes a note. */
export async function build({ urdf, meshes }, say) {
  const root = new DOMParser().parseFromString(urdf, "application/xml").documentElement, pending = [];
  function visualOf(visual) {
    const group = placeAt(new THREE.Group(), visual), made = materialOf(visual, root);
    const shape = all(visual, "geometry")[0]?.firstElementChild;
    if (Object.hasOwn(SHAPES, shape?.tagName)) group.add(new THREE.Mesh(SHAPES[shape.tagName](shape), made.material));
    else if (shape?.tagName === "mesh") {
      const file = shape.getAttribute("filename") ?? "", scale = numbers(shape.getAttribute("scale") ?? "", [1, 1, 1]);
      const fail = (error) => {
        say(`${file.split("/").pop()}: ${error.message}`);
        const frame = new THREE.MeshBasicMaterial({ color: 0xd97706, wireframe: true });
        group.add(new THREE.Mesh(new THREE.BoxBufferGeometry(0.1, 0.1, 0.1), frame));
      };
      pending.push(mesh(file, meshes[file], scale, made).then((object) => group.add(object), fail));
    }
    return group;
  }
  const links = new Map(all(root, "link").map((link) => {
    const seen = all(link, "visual"), group = new THREE.Group();
    (seen.length ? seen : all(link, "collision")).forEach((visual) => group.add(visualOf(visual)));
    return [link.getAttribute("name"), group];
  }));
  const children = new Set(), joints = new Map(), group = new THREE.Group();
  for (const joint of all(root, "joint")) {
    const name = text(joint, "child", "link"), child = links.get(name);
    const parent = links.get(text(joint, "parent", "link"));
    if (!parent || !child || children.has(name) || parent === child) continue;
    if (["floating", "planar"].includes(joint.getAttribute("type"))) continue;  // the child is the base
    children.add(name);
    const moving = new THREE.Group().add(child);
    const place = placeAt(new THREE.Group(), joint).add(moving);
    place.userData.joint = true;
    parent.add(place);
    const axis = new THREE.Vector3(...numbers(text(joint, "axis", "xyz"), [1, 0, 0])).normalize();
    joints.set(joint.getAttribute("name"), { moving, axis, slides: joint.getAttribute("type") === "prismatic" });
  }
  for (const [name, link] of links) if (!children.has(name)) group.add(link);
  await Promise.all(pending);
  return { name: root.getAttribute("name") ?? "", group, joints, links, supports: supportsOf(links.values()) };
}

const DIRECTIONS = Array.from({ length: 200 }, (_, i) => {  // spread evenly over a sphere
  const z = 1 - (2 * i + 1) / 200, turn = i * Math.PI * (3 - Math.sqrt(5)), r = Math.sqrt(1 - z * z);
  return new THREE.Vector3(r * Math.cos(turn), r * Math.sin(turn), z);
});

/** For each link its outermost vertices, in its own frame: the lowest point of the robot is one of them. */
function supportsOf(links) {
  return [...links].map((link) => {
    const points = [], inverse = new THREE.Matrix4();
    link.updateMatrixWorld(true);
    inverse.getInverse(link.matrixWorld);
    for (const visual of link.children.filter((child) => !child.userData.joint)) {
      visual.traverse(({ geometry, matrixWorld }) => {
        const at = geometry?.attributes?.position, to = new THREE.Matrix4().multiplyMatrices(inverse, matrixWorld);
        for (let i = 0; i < (at?.count ?? 0); ++i) points.push(new THREE.Vector3().fromBufferAttribute(at, i).applyMatrix4(to));
      });
    }
    if (points.length <= DIRECTIONS.length) return { link, points };
    const outermost = DIRECTIONS.map((d) => points.reduce((best, point) => point.dot(d) > best.dot(d) ? point : best));
    return { link, points: [...new Set(outermost)] };
  }).filter(({ points }) => points.length);
}

/** m above the ground of the lowest of these points; the matrices of the links are those of now. */
export function lowestOf(supports) {
  let least = Infinity;
  for (const { link: { matrixWorld: { elements: m } }, points } of supports) {
    for (const { x, y, z } of points) least = Math.min(least, m[2] * x + m[6] * y + m[10] * z + m[14]);
  }
  return least;
}

/** Moves the joints to these positions. */
export function pose(joints, positions) {
  for (const [name, position] of Object.entries(positions)) {
    const joint = joints.get(name);
    if (!joint || position === null) continue;
    if (joint.slides) joint.moving.position.copy(joint.axis).multiplyScalar(position);
    else joint.moving.quaternion.setFromAxisAngle(joint.axis, position);
  }
}

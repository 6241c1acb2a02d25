"use strict";
// Triangles of the basic shapes: corners and faces, in the form of those of meshes; for round shapes also the normal at each corner.

const AROUND = 32; // corners of a circle

// A solid of revolution about the vertical axis, from a line of [radius, height, outward, upward], upwards; the last two are the normal.
function turned(line) {
  const places = [], faces = [], facing = [];
  for (const [radius, height, outward = 0, upward = 0] of line)
    for (let n = 0; n < AROUND; n++) {
      const angle = (2 * Math.PI * n) / AROUND, c = Math.cos(angle), s = Math.sin(angle);
      places.push(radius * c, radius * s, height);
      facing.push(outward * c, outward * s, upward);
    }
  for (let ring = 0; ring + 1 < line.length; ring++)
    for (let n = 0; n < AROUND; n++) {
      const a = ring * AROUND + n, b = ring * AROUND + ((n + 1) % AROUND);
      if (line[ring][0] > 0) faces.push(a, b, b + AROUND);
      if (line[ring + 1][0] > 0) faces.push(a, b + AROUND, a + AROUND);
    }
  return { places, faces, facing };
}

// Half a circle from below to above, its halves apart by `length`.
function arc(radius, length) {
  const line = [], steps = AROUND / 2;
  for (let n = 0; n <= steps; n++) {
    const angle = (Math.PI * n) / steps - Math.PI / 2;
    const outward = n % steps ? Math.cos(angle) : 0, upward = Math.sin(angle);
    const point = (side) => [radius * outward, radius * upward + side * length, outward, upward];
    if (n <= steps / 2) line.push(point(-1));
    if (n >= steps / 2 && (length > 0 || n > steps / 2)) line.push(point(1));
  }
  return line;
}

function box(x, y, z) {
  const places = [];
  for (let n = 0; n < 8; n++) places.push(n & 1 ? x : -x, n & 2 ? y : -y, n & 4 ? z : -z);
  const sides = [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]];
  return { places, faces: sides.flatMap(([a, b, c, d]) => [a, b, c, a, c, d]) };
}

const SOLIDS = {
  sphere: (radius) => turned(arc(radius, 0)),
  capsule: (radius, half) => turned(arc(radius, half)),
  cylinder: (radius, half) => turned([[0, -half], [radius, -half], [radius, half], [0, half]]),
  ellipsoid: (...half) => {
    const { places, faces, facing } = turned(arc(1, 0));
    return { places: places.map((place, n) => place * half[n % 3]), faces, facing: facing.map((part, n) => part / half[n % 3]) };
  },
  box,
};

// All parts of a body as one: corners in its frame, their colours, where they face (nowhere: as their triangles do), triangles, and
// whether one sees through any.
function joined(parts, meshes) {
  const places = [], colours = [], facing = [], faces = [];
  for (const part of parts) {
    const solid = part.kind === "mesh" ? meshes[part.mesh] : SOLIDS[part.kind](...part.size);
    const pose = poseMatrix([...part.place, ...part.turn]), first = places.length / 3;
    for (let n = 0; n < solid.places.length; n += 3) {
      const [x, y, z] = solid.places.slice(n, n + 3);
      const [u, v, w] = solid.facing?.slice(n, n + 3) ?? [0, 0, 0];
      for (let axis = 0; axis < 3; axis++) {
        const [a, b, c] = [pose[axis], pose[4 + axis], pose[8 + axis]];
        places.push(a * x + b * y + c * z + pose[12 + axis]);
        facing.push(a * u + b * v + c * w);
      }
      colours.push(...part.colour);
    }
    for (const corner of solid.faces) faces.push(first + corner);
  }
  const clear = parts.some(({ colour }) => colour[3] < 250);
  return { places: new Float32Array(places), colours: new Uint8Array(colours), facing: new Float32Array(facing), faces: new Uint32Array(faces), clear };
}

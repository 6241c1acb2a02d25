"use strict";
// Matrices of 16 numbers, by columns, as WebGL takes them; vectors are those of the page (static/scene/space.js).

function times(a, b) {
  const out = new Float32Array(16);
  for (let c = 0; c < 4; c++)
    for (let r = 0; r < 4; r++) {
      let sum = 0;
      for (let k = 0; k < 4; k++) sum += a[k * 4 + r] * b[c * 4 + k];
      out[c * 4 + r] = sum;
    }
  return out;
}

function perspective(fov, aspect, near, far) {
  const f = 1 / Math.tan(fov / 2);
  return new Float32Array([f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, (far + near) / (near - far), -1, 0, 0, (2 * far * near) / (near - far), 0]);
}

function lookAt(eye, target) {
  const back = unit(minus(eye, target));
  const right = unit(cross([0, 0, 1], back));
  const up = cross(back, right);
  return new Float32Array([
    right[0], up[0], back[0], 0, right[1], up[1], back[1], 0, right[2], up[2], back[2], 0, -dot(right, eye), -dot(up, eye), -dot(back, eye), 1,
  ]);
}

// Where something stands: a place and a quaternion, seven numbers.
function poseMatrix(p) {
  const [x, y, z, w, i, j, k] = p;
  return new Float32Array([
    1 - 2 * (j * j + k * k), 2 * (i * j + w * k), 2 * (i * k - w * j), 0,
    2 * (i * j - w * k), 1 - 2 * (i * i + k * k), 2 * (j * k + w * i), 0,
    2 * (i * k + w * j), 2 * (j * k - w * i), 1 - 2 * (i * i + j * j), 0,
    x, y, z, 1,
  ]);
}

// Between two poses, the shorter way round.
function between(poses, one, other, part) {
  const out = new Array(7);
  let sign = 0;
  for (let n = 3; n < 7; n++) sign += poses[one + n] * poses[other + n];
  for (let n = 0; n < 7; n++) {
    const end = n > 2 && sign < 0 ? -poses[other + n] : poses[other + n];
    out[n] = poses[one + n] * (1 - part) + end * part;
  }
  const length = Math.hypot(out[3], out[4], out[5], out[6]) || 1;
  for (let n = 3; n < 7; n++) out[n] /= length;
  return out;
}

function unpacked(text, Kind) {
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  return new Kind(bytes.buffer);
}

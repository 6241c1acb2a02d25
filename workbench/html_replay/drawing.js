"use strict";
// Draws the scene: shapes lit from above, and the ground as a grid.

const SHAPE_VERTEX = `#version 300 es
in vec3 place, facing; in vec4 colour; uniform mat4 pose, view; out vec4 tint; out vec3 at, faces;
void main() { vec4 world = pose * vec4(place, 1.0); at = world.xyz; tint = colour; faces = mat3(pose) * facing; gl_Position = view * world; }`;
const SHAPE_FRAGMENT = `#version 300 es
precision highp float; in vec4 tint; in vec3 at, faces; uniform vec3 eye; out vec4 seen;
void main() {
  vec3 normal = normalize(dot(faces, faces) > 0.0 ? faces : cross(dFdx(at), dFdy(at)));
  if (dot(normal, eye - at) < 0.0) normal = -normal;
  float light = 0.45 + 0.4 * max(dot(normal, normalize(vec3(-0.4, -0.6, 1.0))), 0.0) + 0.2 * max(dot(normal, normalize(eye - at)), 0.0);
  seen = vec4(tint.rgb * light, tint.a);
}`;
const GROUND_VERTEX = `#version 300 es
in vec2 place; uniform mat4 view; uniform float height; uniform vec2 middle; out vec2 at;
void main() { at = place * 60.0 + floor(middle); gl_Position = view * vec4(at, height, 1.0); }`;
const GROUND_FRAGMENT = `#version 300 es
precision highp float; in vec2 at; uniform vec3 ground, line; uniform vec2 middle; out vec4 seen;
void main() {
  vec2 width = fwidth(at);
  vec2 off = abs(fract(at - 0.5) - 0.5) / max(width, vec2(1e-6));
  float strong = (1.0 - min(min(off.x, off.y) / 1.3, 1.0)) * clamp(0.6 / max(width.x, width.y), 0.0, 1.0);
  float far = clamp(1.0 - length(at - middle) / 55.0, 0.0, 1.0);
  seen = vec4(mix(ground, line, strong), far);
}`;

const SHADE_VERTEX = `#version 300 es
in vec2 place; uniform mat4 view; uniform float height; uniform vec4 around; uniform vec3 form; out vec2 at;
void main() {
  at = place * (form.xy + form.z);
  vec2 turned = vec2(around.z * at.x - around.w * at.y, around.w * at.x + around.z * at.y);
  gl_Position = view * vec4(around.xy + turned, height, 1.0);
}`;
const SHADE_FRAGMENT = `#version 300 es
precision highp float; in vec2 at; uniform vec3 form; uniform float dark; out vec4 seen;
void main() { seen = vec4(0.0, 0.0, 0.0, dark * (1.0 - smoothstep(0.0, 1.0, length(max(abs(at) - form.xy, 0.0)) / form.z))); }`;

const parts = (hex) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16) / 255);

class Drawing {
  constructor(canvas, scenes, palette) {
    this.canvas = canvas;
    this.palette = palette;
    this.gl = canvas.getContext("webgl2", { antialias: true, alpha: false });
    if (!this.gl) throw new Error("this browser has no WebGL 2, which the 3D scene needs");
    this.shaded = this.program(SHAPE_VERTEX, SHAPE_FRAGMENT);
    this.grounded = this.program(GROUND_VERTEX, GROUND_FRAGMENT);
    this.darkened = this.program(SHADE_VERTEX, SHADE_FRAGMENT);
    this.darkSquare = this.array(this.darkened, { place: [new Float32Array([-1, -1, 1, -1, -1, 1, 1, 1]), 2, this.gl.FLOAT, false] });
    this.square = this.array(this.grounded, { place: [new Float32Array([-1, -1, 1, -1, -1, 1, 1, 1]), 2, this.gl.FLOAT, false] });
    this.scenes = scenes.map((scene) => this.drawable(scene));
    this.begin = this.scenes[0].times[0];
    this.end = this.scenes.at(-1).times.at(-1);
    this.choose(0);
    this.now = 0;
    this.dark = matchMedia("(prefers-color-scheme: dark)");
    this.listen();
  }

  // Returns what is drawn of a scene.
  drawable(scene) {
    const meshes = scene.meshes.map(({ places, faces }) => ({ places: unpacked(places, Float32Array), faces: unpacked(faces, Uint32Array) }));
    const shapes = scene.shapes.map((parts) => this.shape(joined(parts, meshes)));
    const boxes = scene.shapes.map((parts) => parts.map((part) => boxOf(part, meshes)));
    const [times, poses] = [scene.times, scene.poses].map((numbers) => unpacked(numbers, Float32Array));
    const first = shapes.length ? [...times].map((_, frame) => (frame * shapes.length + scene.stage.follow) * 7) : [];
    return { scene, times, poses, shapes, boxes, camera: new Camera(scene.stage, first.map((at) => [poses[at], poses[at + 1]])) };
  }

  // Sets the scene of a time: that of the simulation which has begun last.
  choose(time) {
    const now = this.scenes.filter(({ times }) => times[0] <= Math.fround(time)).at(-1) || this.scenes[0];
    if (this.camera) now.camera.following = this.camera.following;
    Object.assign(this, now);
  }

  program(vertex, fragment) {
    const gl = this.gl, program = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    return program;
  }

  array(program, values) {
    const gl = this.gl, array = gl.createVertexArray();
    gl.bindVertexArray(array);
    for (const [name, [data, size, kind, whole]] of Object.entries(values)) {
      gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
      gl.bufferData(gl.ARRAY_BUFFER, data, gl.STATIC_DRAW);
      const at = gl.getAttribLocation(program, name);
      gl.enableVertexAttribArray(at);
      gl.vertexAttribPointer(at, size, kind, whole, 0, 0);
    }
    return array;
  }

  shape(shape) {
    const gl = this.gl, { places, colours, facing, faces, clear } = shape;
    const array = this.array(this.shaded, {
      place: [places, 3, gl.FLOAT, false],
      facing: [facing, 3, gl.FLOAT, false],
      colour: [colours, 4, gl.UNSIGNED_BYTE, true],
    });
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, faces, gl.STATIC_DRAW);
    return { array, count: faces.length, clear };
  }

  // Returns the position and orientation of a shape at a time.
  pose(shape, time) {
    const times = this.times, count = this.shapes.length;
    let low = 0, high = times.length - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (times[middle] <= time) low = middle;
      else high = middle - 1;
    }
    const next = Math.min(low + 1, times.length - 1);
    const part = next > low ? Math.min(1, Math.max(0, (time - times[low]) / (times[next] - times[low]))) : 0;
    return between(this.poses, (low * count + shape) * 7, (next * count + shape) * 7, part);
  }

  draw(time) {
    const gl = this.gl, canvas = this.canvas;
    this.now = time;
    this.choose(time);
    const wide = Math.max(1, Math.round(canvas.clientWidth * devicePixelRatio)), high = Math.max(1, Math.round(canvas.clientHeight * devicePixelRatio));
    if (canvas.width !== wide || canvas.height !== high) [canvas.width, canvas.height] = [wide, high];
    gl.viewport(0, 0, wide, high);
    const colours = this.palette[this.dark.matches ? "dark" : "light"];
    gl.clearColor(...parts(colours.haze), 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    if (!this.shapes.length) return;
    const { eye, target, view } = this.camera.seen(this.pose(this.scene.stage.follow, time), wide / high);
    this.target = target;
    this.drawGround(view, colours);
    this.drawShades(view, colours, time);
    gl.useProgram(this.shaded);
    const place = (name) => gl.getUniformLocation(this.shaded, name);
    gl.uniformMatrix4fv(place("view"), false, view);
    gl.uniform3fv(place("eye"), eye);
    for (const clear of [false, true])
      this.shapes.forEach((shape, number) => {
        if (shape.clear !== clear) return;
        gl.uniformMatrix4fv(place("pose"), false, poseMatrix(this.pose(number, time)));
        gl.bindVertexArray(shape.array);
        gl.drawElements(gl.TRIANGLES, shape.count, gl.UNSIGNED_INT, 0);
      });
  }

  drawGround(view, colours) {
    const gl = this.gl, place = (name) => gl.getUniformLocation(this.grounded, name);
    gl.useProgram(this.grounded);
    gl.uniformMatrix4fv(place("view"), false, view);
    gl.uniform2f(place("middle"), this.target[0], this.target[1]);
    gl.uniform3fv(place("ground"), parts(colours.ground));
    gl.uniform3fv(place("line"), parts(colours.line));
    gl.bindVertexArray(this.square);
    for (const height of this.scene.grounds) {
      gl.uniform1f(place("height"), height);
      gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
    }
  }

  // Draws the shadows on the highest ground; they hide nothing.
  drawShades(view, colours, time) {
    if (!this.scene.grounds.length) return;
    const gl = this.gl, place = (name) => gl.getUniformLocation(this.darkened, name), ground = this.scene.grounds.at(-1);
    gl.useProgram(this.darkened);
    gl.uniformMatrix4fv(place("view"), false, view);
    gl.uniform1f(place("height"), ground);
    gl.bindVertexArray(this.darkSquare);
    gl.depthMask(false);
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.polygonOffset(-2, -2);
    for (const [x, y, c, s, a, b, soft, dark] of shadesOf(this.boxes.map((boxes, n) => ({ boxes, pose: poseMatrix(this.pose(n, time)) })), ground)) {
      gl.uniform4f(place("around"), x, y, c, s);
      gl.uniform3f(place("form"), a, b, soft);
      gl.uniform1f(place("dark"), dark * colours.shade);
      gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
    }
    gl.disable(gl.POLYGON_OFFSET_FILL);
    gl.depthMask(true);
  }

  listen() {
    const canvas = this.canvas;
    canvas.addEventListener("pointerdown", (event) => canvas.setPointerCapture(event.pointerId));
    canvas.addEventListener("pointermove", (event) => {
      if (!event.buttons) return;
      if (event.shiftKey || event.buttons > 1) this.camera.shift(event.movementX / canvas.clientHeight, event.movementY / canvas.clientHeight);
      else this.camera.swing(event.movementX, event.movementY);
      this.draw(this.now);
    });
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.camera.near(event.deltaY);
      this.draw(this.now);
    }, { passive: false });
    new ResizeObserver(() => this.draw(this.now)).observe(canvas);
    this.dark.addEventListener("change", () => this.draw(this.now));
  }
}

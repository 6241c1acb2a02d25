// The ground and the sky of the 3D view: the colours of the theme, a horizon, and soft shadows under objects, which cost little even if
// the processor draws.

import { palette } from "./colours.js";

const MAX_SHADOWS = 64; // the maximum number of shadows
const LIFT = 0.004; // their height above the ground [m]
// Far away, the depth of the ground's two large triangles is less exact than that height: shadows are drawn as if they were this much nearer.
const NEARER = { polygonOffset: true, polygonOffsetFactor: -2, polygonOffsetUnits: -2 };
const RISE = 0.6; // the height over which the sky changes its colour above the horizon, as a part of the picture's
const FADE = 0.12; // the same below the horizon

const VERTEX = `
attribute vec2 local; attribute vec4 form; varying vec2 at; varying vec4 shape;
void main() { at = local; shape = form; gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }`;
const FRAGMENT = `
uniform float strength; varying vec2 at; varying vec4 shape;
void main() {
  float off = length(max(abs(at) - shape.xy, 0.0)) / shape.z;
  float dark = 1.0 - smoothstep(0.0, 1.0, off);
  gl_FragColor = vec4(0.0, 0.0, 0.0, shape.w * strength * dark);
}`;

export class Ground {
  constructor(viewer) {
    this.viewer = viewer;
    this.theme = "";
    this.horizon = null;
    this.styled = new WeakMap();
    const pattern = this.backdrop();
    pattern.visible = false; // viser's background image, which is unused here, would be drawn over the whole picture
    this.shades = this.makeShades(pattern);
  }

  /** Returns viser's mesh for a background image. */
  backdrop() {
    let found = null;
    this.viewer.scene.traverse((object) => {
      if (object.material === this.viewer.backgroundMaterial) found = object;
    });
    return found;
  }

  /** Creates one mesh for all shadows; three.js is inside viser's bundle, so its classes are taken from a mesh of viser's. */
  makeShades({ constructor: Mesh, material: { constructor: Material }, geometry: plane }) {
    const Geometry = Object.getPrototypeOf(plane.constructor);
    const Attribute = Object.getPrototypeOf(plane.attributes.position.constructor);
    const geometry = new Geometry();
    for (const [name, size] of [["position", 3], ["local", 2], ["form", 4]]) geometry.setAttribute(name, new Attribute(new Float32Array(4 * MAX_SHADOWS * size), size));
    const corners = [];
    for (let n = 0; n < MAX_SHADOWS; n++) corners.push(...[0, 1, 2, 2, 1, 3].map((corner) => 4 * n + corner));
    geometry.setIndex(corners);
    const material = new Material({ vertexShader: VERTEX, fragmentShader: FRAGMENT, uniforms: { strength: { value: 0 } }, transparent: true, depthWrite: false, ...NEARER });
    const mesh = new Mesh(geometry, material);
    mesh.frustumCulled = false;
    mesh.renderOrder = 1;
    return mesh;
  }

  /** Sets the shadows: x, y, the direction of the first side as cosine and sine, two half sides, softness [m] and strength. */
  shade(shades, ground) {
    const { geometry } = this.shades;
    const { position, local, form } = geometry.attributes;
    const count = Math.min(MAX_SHADOWS, shades.length);
    for (let n = 0; n < count; n++) {
      const [x, y, c, s, a, b, soft, dark] = shades[n];
      for (let corner = 0; corner < 4; corner++) {
        const u = (corner & 1 ? 1 : -1) * (a + soft);
        const v = (corner & 2 ? 1 : -1) * (b + soft);
        position.setXYZ(4 * n + corner, x + c * u - s * v, y + s * u + c * v, ground + LIFT);
        local.setXY(4 * n + corner, u, v);
        form.setXYZW(4 * n + corner, a, b, soft, dark);
      }
    }
    geometry.setDrawRange(0, 6 * count);
    for (const attribute of [position, local, form]) attribute.needsUpdate = true;
  }

  /** Colours sky and ground by the theme, and draws the horizon where the camera sees it. */
  draw(theme, horizon, stage, flat) {
    const colours = palette[theme];
    const root = this.viewer.nodeRefFromName[""];
    if (this.shades.parent !== root) root.add(this.shades);
    for (const name of stage.grounds) {
      this.viewer.nodeRefFromName[name]?.traverse(({ material }) => {
        if (!material?.uniforms?.planeColor || this.styled.get(material) === theme) return;
        const { uniforms } = material;
        uniforms.planeColor.value.set(colours.ground);
        uniforms.cellColor.value.set(colours.line);
        uniforms.sectionColor.value.set(colours.line);
        this.styled.set(material, theme);
      });
    }
    if (theme === this.theme && flat === this.flat && Math.abs(horizon - this.horizon) < 0.002) return;
    this.shades.material.uniforms.strength.value = colours.shade;
    [this.theme, this.horizon, this.flat] = [theme, horizon, flat];
    const below = stage.grounds.length ? colours.ground : colours.haze;
    this.sky = [[horizon - RISE, colours.sky], [horizon, colours.haze], [horizon, colours.haze], [horizon + (flat ? 0 : FADE), below]];
    const stops = this.sky.map(([at, colour]) => `${colour} ${(100 * at).toFixed(1)}%`);
    document.documentElement.style.background = `linear-gradient(${stops.join(", ")}) fixed`;
  }

  /** Paints the sky, and what is below the horizon, as the page shows them. */
  paintSky(context, width, height) {
    const [top, bottom] = [this.sky[0][0], this.sky.at(-1)[0]];
    const gradient = context.createLinearGradient(0, top * height, 0, bottom * height);
    for (const [at, colour] of this.sky) gradient.addColorStop((at - top) / (bottom - top), colour);
    context.fillStyle = gradient;
    context.fillRect(0, 0, width, height);
  }
}

// What stands between the camera and the body is cut away around the body, with a shaded rim. The camera itself stays where it is, so that
// the picture never jumps; and as the body has a fixed place in it, so has the opening.

import { dot, plus, unit } from "./space.js";

const WIDE = 0.62; // how wide the opening is at least, by its height
const ROUND = 1.25; // how much larger than the body it is
const AHEAD = 0.05; // what is farther than this before the middle of the body stands before it [m]
const LOW = 0.05; // what is no higher than this above the feet is ground [m]

const DECLARED = `
uniform vec4 cutAt; uniform vec4 cutFront; uniform vec4 cutLow;
void main() {
  float cutOff = 2.0;`;
const CUT = `
  if (cutAt.w > 0.0 && dot(cutFront.xyz, vViewPosition) < -cutFront.w && dot(cutLow.xyz, vViewPosition) < -cutLow.w) {
    cutOff = length((vViewPosition.xy / -vViewPosition.z - cutAt.xy) / cutAt.zw);
    if (cutOff < 1.0) discard;
  }
#include <clipping_planes_fragment>`;
const RIM = `
#include <dithering_fragment>
  gl_FragColor.rgb *= mix(0.72, 1.0, smoothstep(1.0, 1.12, cutOff));`;

export class Cutaway {
  constructor(viewer) {
    this.viewer = viewer;
    this.uniforms = Object.fromEntries(["cutAt", "cutFront", "cutLow"].map((name) => [name, { value: [0, 0, 0, 0] }]));
    this.prepared = new WeakSet();
    this.compile = (shader) => {
      if (!shader.fragmentShader.includes("vViewPosition") && !shader.vertexShader.includes("vViewPosition")) return;
      Object.assign(shader.uniforms, this.uniforms);
      shader.fragmentShader = shader.fragmentShader.replace("void main() {", DECLARED).replace("#include <clipping_planes_fragment>", CUT).replace("#include <dithering_fragment>", RIM);
    };
  }

  /** Cuts for the next picture, where a camera looks at the body. */
  draw(stage, now, camera) {
    const { cutAt, cutFront, cutLow } = this.uniforms;
    cutAt.value = [0, 0, 0, 0];
    if (camera.view !== "follow") return;
    this.prepare(stage.own);
    const view = camera.camera.matrixWorldInverse;
    const inView = (place) => camera.toThree(place).applyMatrix4(view).toArray();
    const middle = inView(plus(now.body, stage.middle));
    const size = stage.height * ROUND / 2 / -middle[2];
    if (!(size > 0)) return;
    cutAt.value = [middle[0] / -middle[2], middle[1] / -middle[2], size * WIDE, size];
    const upward = camera.toThree([0, 0, 1], true).transformDirection(view).toArray();
    // From the body to the camera, level: a wall beside the body stands before it wherever it is on the camera's side.
    const way = unit(middle.map((x) => -x));
    const level = unit(plus(way, upward, -dot(way, upward)));
    cutFront.value = [...level, dot(level, middle) + AHEAD];
    cutLow.value = [...upward, dot(upward, middle) - stage.height / 2 + LOW];
  }

  /** Prepares the materials of all that is no part of the body, as they come. */
  prepare(own) {
    for (const [name, node] of Object.entries(this.viewer.nodeRefFromName)) {
      if (!/^\/(fixed_)?bodies\//.test(name) || own.some((body) => `${name}/`.startsWith(`/bodies/${body}/`))) continue;
      node?.traverse(({ material }) => {
        for (const one of [material].flat()) {
          if (!one || one.isShaderMaterial || this.prepared.has(one)) continue;
          this.prepared.add(one);
          one.onBeforeCompile = this.compile;
          one.customProgramCacheKey = () => "cut away"; // viser's instanced meshes do not tell one `onBeforeCompile` from another
          one.needsUpdate = true;
        }
      });
    }
  }
}

// Cuts away what is between the camera and the body, around the body, with a shaded rim. The camera itself is not moved, so that the
// picture never jumps; as the body has a fixed place in the picture, so has the opening.

import { THING } from "./camera.js";
import { dot, plus, unit } from "./space.js";

const WIDE = 0.62; // the minimum width of the opening, relative to its height
const ROUND = 1.25; // the size of the opening relative to the body
const AHEAD = 0.05; // what is nearer to the camera than the body's middle by more than this can hide it [m]
const LOW = 0.05; // what is at most this high above the feet counts as ground [m]

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

  /** Sets the opening for the next picture, for a camera that looks at the body. */
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
    // The horizontal direction from the body to the camera: a wall beside the body hides it wherever it is on the camera's side.
    const way = unit(middle.map((x) => -x));
    const level = unit(plus(way, upward, -dot(way, upward)));
    cutFront.value = [...level, dot(level, middle) + AHEAD];
    cutLow.value = [...upward, dot(upward, middle) - stage.height / 2 + LOW];
  }

  /** Prepares the materials of everything that is not part of the body, as they are added. */
  prepare(own) {
    for (const [name, node] of Object.entries(this.viewer.nodeRefFromName)) {
      if (!THING.test(name) || own.some((body) => `${name}/`.startsWith(`/bodies/${body}/`))) continue;
      node?.traverse(({ material }) => {
        for (const one of [material].flat()) {
          if (!one || one.isShaderMaterial || this.prepared.has(one)) continue;
          this.prepared.add(one);
          one.onBeforeCompile = this.compile;
          one.customProgramCacheKey = () => "cut away"; // viser's instanced meshes do not distinguish two `onBeforeCompile` functions
          one.needsUpdate = true;
        }
      });
    }
  }
}

// The camera of this browser: its view, and how it follows the body. It moves viser's own camera controls, which
// rotate, pan and zoom by mouse.

import { FOV, NOTHING, anchorOf, cameraPose } from "./stage.js";
import { cross, plus } from "./space.js";

/** The names of viser's nodes that are things of the world, in contrast to what is drawn over it. */
export const THING = /^\/(fixed_)?bodies\//;
const SLIGHT = 1e-6; // smaller movements are ignored [m]
const MOVED = 1e-3; // smaller changes of a free camera are not reported [m]
const RESTS = 300; // how long it must stand before its place is reported [ms]
const DEEP = 500; // without perspective, the visible depth before and behind the target [m]

/** Returns whether an object of the scene is shown, with all that it is in. */
function isSeen(object) {
  return object === null || (object.visible && isSeen(object.parent));
}

/** @param viewer Viser's own objects. */
export class SceneCamera {
  constructor(viewer) {
    this.viewer = viewer;
    this.camera = viewer.camera;
    this.controls = viewer.cameraControl;
    this.view = null;
    this.flat = false; // whether the picture is without perspective
    this.anchor = [0, 0, 0];
    this.coveredIn = () => NOTHING; // what the page covers of the picture in a view
    this.covered = NOTHING;
    this.aspect = 0;
    this.touched = false; // whether the user has moved it
    this.aim = null; // where it is to look once its view is free, in the frame of three.js
    this.vector = this.camera.position.clone();
    this.other = this.vector.clone();
    this.matrix = this.camera.matrix.clone();
    const { camera } = this;
    const usual = camera.updateProjectionMatrix;
    camera.updateProjectionMatrix = () => {
      usual.call(camera);
      if (this.flat) this.flatten();
      this.shift();
    };
    this.straightenRays();
    this.actions = this.controls.constructor.ACTION;
    this.root.__r3f.root.getState().gl.domElement.addEventListener("dblclick", (event) => this.focus(event));
    for (const kind of ["controlstart", "control"]) this.controls.addEventListener(kind, () => (this.touched = true));
    camera.up.copy(this.toThree([0, 0, 1], true));
    this.controls.updateCameraUp();
  }

  get root() {
    return this.viewer.nodeRefFromName[""];
  }

  /** Converts a position in the world, or a direction, to the frame of three.js. */
  toThree(place, direction = false) {
    const found = this.vector.set(...place).applyMatrix4(this.root.matrixWorld);
    return direction ? found.sub(this.other.set(0, 0, 0).applyMatrix4(this.root.matrixWorld)) : found;
  }

  /** Moves the camera to the start of a view. When coming from the view of the body, `free` keeps its place.
   *
   * @param kept Where the user has left the free camera, as `report` gives it; null for nowhere.
   */
  choose(view, stage, now, kept = null) {
    const stays = view === "free" && this.view === "follow";
    const returns = view === "free" && !stays && kept !== null;
    this.view = view;
    this.touched = stays || returns;
    this.aspect = this.camera.aspect;
    const { controls, camera, actions } = this;
    this.flat = view === "top" || view === "side";
    if (!stays) this.covered = view === "eye" ? NOTHING : this.coveredIn(view);
    if (returns) this.covered = { right: kept[6], top: kept[7] };
    controls.setFocalOffset(0, 0, 0, false);
    // A view without perspective pans and does not rotate; one that follows the body pans within the picture and rotates about the body.
    controls.mouseButtons.left = this.flat ? actions.TRUCK : actions.ROTATE;
    controls.mouseButtons.right = view === "follow" ? actions.OFFSET : actions.TRUCK;
    controls.maxPolarAngle = this.flat ? Math.PI : 0.52 * Math.PI; // not below the ground
    this.setFov(FOV);
    this.anchor = anchorOf(view, stage, now.body);
    if (returns) controls.setLookAt(...plus(kept.slice(0, 3), this.shiftOf()), ...plus(kept.slice(3, 6), this.shiftOf()), false);
    else if (view !== "eye" && !stays) {
      const { target, back, distance } = cameraPose(view, stage, now.body, camera.aspect, this.covered);
      const place = this.toThree(plus(target, back, distance)).toArray();
      controls.setLookAt(...place, ...this.toThree(target).toArray(), false);
    }
    if (stays && this.aim) controls.moveTo(...this.aim.toArray(), false);
    this.aim = null;
    clearTimeout(this.reporting);
    this.reported = stays ? null : this.place();
    camera.updateProjectionMatrix();
    this.viewer.requestRender();
  }

  /** Returns how far the body that has left the stage has taken the camera with it, in the frame of three.js. */
  shiftOf() {
    return this.toThree(this.anchor, true).toArray();
  }

  /** Returns where a free camera is and where it looks, without that, in the frame of three.js, and which parts of the picture count as
   * covered: [x, y, z, x, y, z, right, top]. */
  place() {
    const shift = this.shiftOf();
    const points = [this.controls.getPosition(this.vector.clone()), this.controls.getTarget(this.vector.clone())];
    return [...points.flatMap((point) => plus(point.toArray(), shift, -1)), this.covered.right, this.covered.top];
  }

  /** Reports to the page where the user has left the free camera. */
  report() {
    if (this.view !== "free") return;
    const place = this.place();
    if (this.reported?.every((value, n) => Math.abs(value - place[n]) < MOVED)) return;
    this.reported = place;
    clearTimeout(this.reporting);
    this.reporting = setTimeout(() => parent.postMessage({ camera: place }, location.origin), RESTS);
  }

  /** Moves the camera so that the thing at the pointer is in the middle. A view that follows the body becomes free, which the page is asked for. */
  focus({ offsetX, offsetY, currentTarget }) {
    if (this.view === "eye") return;
    const { raycaster } = this.root.__r3f.root.getState();
    raycaster.setFromCamera({ x: (2 * offsetX) / currentTarget.clientWidth - 1, y: 1 - (2 * offsetY) / currentTarget.clientHeight }, this.camera);
    const things = Object.entries(this.viewer.nodeRefFromName).flatMap(([name, node]) => (node && THING.test(name) ? [node] : []));
    const hit = raycaster.intersectObjects(things, true).find(({ object }) => object.instancesCount !== undefined && isSeen(object)); // the rest is no shape
    if (!hit) return;
    const place = raycaster.ray.at(hit.distance, this.vector.clone()); // viser's shapes give it in the frame of the world
    this.touched = true;
    if (this.view === "follow") {
      this.aim = place;
      parent.postMessage({ focused: true }, location.origin);
    } else this.controls.moveTo(...place.toArray(), false);
    this.viewer.requestRender();
  }

  setFov(fov) {
    const degrees = (fov * 180) / Math.PI;
    if (Math.abs(this.camera.fov - degrees) < 1e-6) return;
    this.camera.fov = degrees;
    this.camera.updateProjectionMatrix();
  }

  /** Moves the camera with what is shown now; called just before each picture. */
  follow(stage, now) {
    if (this.view === "eye") {
      if (now.eye) this.lookThrough(now.eye);
      return;
    }
    // The picture's aspect ratio has changed, for example with a panel's width: what was in view stays in view.
    if (!this.touched && Math.abs(this.camera.aspect - this.aspect) > 0.01) this.choose(this.view, stage, now);
    const anchor = anchorOf(this.view, stage, now.body);
    const target = this.controls.getTarget(this.other.clone());
    const wanted = this.view === "follow" ? this.toThree(anchor).clone() : this.toThree(plus(anchor, this.anchor, -1), true).clone().add(target);
    this.anchor = anchor;
    const way = wanted.clone().sub(target);
    if (way.length() > SLIGHT) {
      this.controls.moveTo(...wanted.toArray(), false);
      this.camera.position.add(way); // the controls would do this only for the next picture
    }
    if (this.flat) this.camera.updateProjectionMatrix();
    this.camera.updateMatrixWorld();
    this.report();
  }

  /** Looks from an eye, with its vertical field of view; the horizontal one depends on the browser's window. */
  lookThrough({ place, forward, up, fov }) {
    const { camera } = this;
    this.setFov(Math.min(fov, 2.6));
    const left = cross(up, forward);
    camera.position.copy(this.toThree(place));
    const axes = [left.map((x) => -x), up, forward.map((x) => -x)].map((axis) => this.toThree(axis, true).clone());
    camera.quaternion.setFromRotationMatrix(this.matrix.makeBasis(...axes));
    camera.updateMatrixWorld();
  }

  /** Replaces the projection by one without perspective, with the height that the picture had at the target. */
  flatten() {
    const { camera } = this;
    const high = this.controls.distance * Math.tan(FOV / 2);
    const wide = high * camera.aspect;
    camera.projectionMatrix.makeOrthographic(-wide, wide, high, -high, -DEEP, DEEP, camera.coordinateSystem, camera.reversedDepth);
  }

  /** Shifts the picture, so that its middle is in the middle of the part that is not covered. */
  shift() {
    const { projectionMatrix, projectionMatrixInverse } = this.camera;
    const { right, top } = this.covered;
    const [column, sign] = this.flat ? [12, -1] : [8, 1]; // with perspective, the shift is by a part of the depth
    projectionMatrix.elements[column] += sign * right;
    projectionMatrix.elements[column + 1] += sign * top;
    projectionMatrixInverse.copy(projectionMatrix).invert();
  }

  /** Makes the rays from the pointer parallel where the picture has no perspective: they find what is dragged. */
  straightenRays() {
    const { raycaster } = this.root.__r3f.root.getState();
    const usual = raycaster.setFromCamera;
    raycaster.setFromCamera = (place, camera) => {
      usual.call(raycaster, place, camera);
      if (!this.flat || camera !== this.camera) return;
      const { origin, direction } = raycaster.ray;
      direction.set(0, 0, -1).transformDirection(camera.matrixWorld);
      origin.set(place.x, place.y, 0.5).unproject(camera).addScaledVector(direction, -2 * DEEP);
    };
  }

  /** Returns the position of a world point in the picture: x and y from 0 to 1, from the left and from the top, and its depth [m]. */
  at(place) {
    const point = this.toThree(place).applyMatrix4(this.camera.matrixWorldInverse);
    const depth = this.flat ? 1 : -point.z;
    point.applyMatrix4(this.camera.projectionMatrix);
    return { x: (1 + point.x) / 2, y: (1 - point.y) / 2, depth };
  }

  /** Returns the height of one metre in the picture at a depth, as a part of the picture's height. */
  scaleAt(depth) {
    const half = Math.tan((this.camera.fov * Math.PI) / 360);
    return 1 / (2 * half * (this.flat ? this.controls.distance : Math.max(depth, 0.05)));
  }

  /** Returns the height of the horizon in the picture, from 0 (top) to 1; without perspective, that of the ground of the stage. */
  horizon(stage) {
    const { camera } = this;
    const forward = camera.getWorldDirection(this.other.clone());
    const pitch = Math.asin(Math.max(-1, Math.min(1, forward.dot(camera.up))));
    if (this.flat) return this.view === "top" ? -1 : this.at([stage.start[0], stage.start[1], stage.ground]).y;
    if (Math.abs(pitch) > 1.4) return pitch > 0 ? 2 : -1;
    return (1 + this.covered.top + Math.tan(pitch) / Math.tan((camera.fov * Math.PI) / 360)) / 2;
  }
}

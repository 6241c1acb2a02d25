// A picture of the 3D view, with its sky and its labels.

const SHARPNESS = 2; // pixels of the picture per pixel of the page

/** Returns what the 3D view shows now, as a canvas. */
export function pictureOf({ renderer, viewer, ground, labels }) {
  const { clientWidth: width, clientHeight: height } = renderer.domElement;
  const canvas = document.createElement("canvas");
  canvas.width = SHARPNESS * width;
  canvas.height = SHARPNESS * height;
  const context = canvas.getContext("2d");
  context.scale(SHARPNESS, SHARPNESS);
  ground.paintSky(context, width, height);
  const ratio = renderer.getPixelRatio();
  renderer.setPixelRatio(SHARPNESS);
  renderer.render(viewer.scene, viewer.camera);
  context.drawImage(renderer.domElement, 0, 0, width, height); // at once: the browser clears what has been drawn
  renderer.setPixelRatio(ratio);
  viewer.requestRender();
  labels.paint(context);
  return canvas;
}

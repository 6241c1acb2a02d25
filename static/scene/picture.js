// A picture of the 3D view, with its sky and its labels.

/** Returns what the 3D view shows now, as a canvas with `sharpness` pixels per pixel of the page. */
export function pictureOf({ renderer, viewer, ground, labels }, sharpness) {
  const { clientWidth: width, clientHeight: height } = renderer.domElement;
  const canvas = document.createElement("canvas");
  canvas.width = sharpness * width;
  canvas.height = sharpness * height;
  const context = canvas.getContext("2d");
  context.scale(sharpness, sharpness);
  ground.paintSky(context, width, height);
  const ratio = renderer.getPixelRatio();
  renderer.setPixelRatio(sharpness);
  renderer.render(viewer.scene, viewer.camera);
  context.drawImage(renderer.domElement, 0, 0, width, height); // at once: the browser clears what has been drawn
  renderer.setPixelRatio(ratio);
  viewer.requestRender();
  labels.paint(context);
  return canvas;
}

// A picture of the 3D view, with its sky and its labels.

/** Returns what the 3D view shows now, as a canvas with `sharpness` pixels per pixel of the page. A canvas that is given is drawn on;
 * it keeps its size. */
export function pictureOf({ renderer, viewer, ground, labels }, sharpness, given = null) {
  const { clientWidth: width, clientHeight: height } = renderer.domElement;
  const canvas = given ?? document.createElement("canvas");
  if (!given) {
    canvas.width = sharpness * width;
    canvas.height = sharpness * height;
  }
  const context = canvas.getContext("2d");
  context.setTransform(sharpness, 0, 0, sharpness, 0, 0);
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

// Runs before viser's own script, in its page. It keeps connecting while the page is in the background; `?panel=hidden` hides viser's
// panel and notices, for a page with its own controls around it; it notifies that page if there will be no picture; it receives what the
// server sends of the scene; and it draws less without a graphics card. It is not a module: modules may run after viser has
// read its address.

{
  document.hasFocus = () => true;

  // What the server sends about the scene besides its shapes, and the chosen view; `scene/view.js` draws both.
  const MAX_HEARD = 64;
  window.scene = {
    facts: {},
    heard: [], // the data of the newest moments, with the stage of their scene; some of them are not drawn yet
    view: "follow",
    kept: null,
    onview: null,
    beforeFrame: null, // called before viser draws a frame
    receive(name, value) {
      this.facts[name] = value;
      if (name === "now") this.heard = [...this.heard, { ...value, stage: this.facts.stage }].slice(-MAX_HEARD);
    },
    /** Moves the camera to the start of a view, also if the view is shown already. A free view starts at `kept`, the position in which the
     * user left the camera, if there is one: as the camera reports it (`scene/camera.js`). */
    choose(view, kept = null) {
      Object.assign(this, { view, kept });
      this.onview?.();
    },
  };

  const asked = new URLSearchParams(location.search);
  if (asked.get("panel") === "hidden") {
    const style = document.createElement("style");
    style.textContent = `
      .mantine-Paper-root, .mantine-Notification-root { display: none !important; }
    `;
    document.documentElement.append(style);
  }

  /** Whether the processor draws, without a graphics card. */
  function drawnBySoftware() {
    const gl = document.createElement("canvas").getContext("webgl2");
    if (!gl) parent.postMessage({ drawn: false }, location.origin); // there will be no picture; view.js notifies of the first one
    const info = gl?.getExtension("WEBGL_debug_renderer_info");
    const name = gl ? String(gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER)) : "";
    gl?.getExtension("WEBGL_lose_context")?.loseContext();
    return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
  }

  // Without a graphics card, shadows take half of a picture's time, and smooth edges four tenths of the rest.
  const bySoftware = drawnBySoftware();
  window.scene.bySoftware = bySoftware;
  if (!asked.has("websocket") && bySoftware) {
    asked.set("websocket", `${location.protocol === "https:" ? "wss" : "ws"}://${location.host}${location.pathname.replace(/\/$/, "")}?shadows=off`);
    history.replaceState(null, "", `?${asked}`);
    const usual = HTMLCanvasElement.prototype.getContext;
    HTMLCanvasElement.prototype.getContext = function (kind, options) {
      return usual.call(this, kind, kind.startsWith("webgl") ? { ...options, antialias: false } : options);
    };
  }

  // While the run goes as fast as possible, this draws when the surrounding page does, which provides the shared timing.
  const ask = requestAnimationFrame.bind(window);
  const forget = cancelAnimationFrame.bind(window);
  const waiting = new Map();
  let frameBudget = null;
  let last = 0;

  window.scene.isHurried = () => frameBudget?.hurried ?? false;
  window.useFrameBudget = (given) => (frameBudget = given);

  window.requestAnimationFrame = (draw) => {
    last += 1;
    const mine = last;
    function now(time) {
      if (frameBudget?.left > 0) {
        waiting.set(mine, ask(now));
        return;
      }
      waiting.delete(mine);
      frameBudget?.drawing();
      window.scene.beforeFrame?.();
      draw(time);
    }
    waiting.set(mine, ask(now));
    return mine;
  };

  window.cancelAnimationFrame = (mine) => {
    forget(waiting.get(mine));
    waiting.delete(mine);
  };
}

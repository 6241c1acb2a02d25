// Runs before viser's own script, in its page. It keeps connecting while the page is not in front; `?panel=hidden` hides viser's panel and
// notices, for a page that has controls of its own around it; it tells that page when the first picture is drawn; it takes what the server
// tells of the scene; and it draws less on a machine without a graphics card. It is no module: modules may run after viser has read its address.

{
  document.hasFocus = () => true;

  // What the server tells of the scene beside its shapes, and the view that is chosen: `scene/view.js` shows both.
  const MOST_HEARD = 64;
  window.scene = {
    told: {},
    heard: [], // what was told of the newest moments; some of them are not drawn yet
    view: "follow",
    onview: null,
    tell(name, value) {
      this.told[name] = value;
      if (name === "now") this.heard = [...this.heard, value].slice(-MOST_HEARD);
    },
    /** Puts the camera where a view begins, also where it is that view already. */
    choose(view) {
      this.view = view;
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

  /** Tells the page around it whether there is a picture, or, by false, that there will be none. */
  const tellDrawn = (drawn) => parent.postMessage({ drawn }, location.origin);

  /** Tells when something is first drawn on the screen itself, not for the sake of what is drawn later. */
  function tellFirst() {
    const kind = WebGL2RenderingContext.prototype;
    for (const name of ["drawElements", "drawArrays", "drawElementsInstanced", "drawArraysInstanced"]) {
      const draw = kind[name];
      kind[name] = function (...all) {
        draw.apply(this, all);
        if (this.getParameter(this.FRAMEBUFFER_BINDING) !== null) return;
        kind[name] = draw;
        tellDrawn(true);
      };
    }
  }

  /** Whether the processor draws, in place of a graphics card. */
  function drawnBySoftware() {
    const gl = document.createElement("canvas").getContext("webgl2");
    if (gl) tellFirst();
    else tellDrawn(false);
    const told = gl?.getExtension("WEBGL_debug_renderer_info");
    const name = gl ? String(gl.getParameter(told ? told.UNMASKED_RENDERER_WEBGL : gl.RENDERER)) : "";
    gl?.getExtension("WEBGL_lose_context")?.loseContext();
    return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
  }

  // Half of what a picture costs without a graphics card is its shadows, and four tenths of the rest that edges are smooth.
  const bySoftware = drawnBySoftware();
  if (!asked.has("websocket") && bySoftware) {
    asked.set("websocket", `${location.protocol === "https:" ? "wss" : "ws"}://${location.host}${location.pathname.replace(/\/$/, "")}?shadows=off`);
    history.replaceState(null, "", `?${asked}`);
    const usual = HTMLCanvasElement.prototype.getContext;
    HTMLCanvasElement.prototype.getContext = function (kind, options) {
      return usual.call(this, kind, kind.startsWith("webgl") ? { ...options, antialias: false } : options);
    };
  }

  // While the run goes as fast as it can, it draws when the page around it does, which gives it what both go by.
  const ask = requestAnimationFrame.bind(window);
  const forget = cancelAnimationFrame.bind(window);
  const waiting = new Map();
  let rest = null;
  let last = 0;

  window.restWith = (given) => (rest = given);

  window.requestAnimationFrame = (draw) => {
    last += 1;
    const mine = last;
    function now(time) {
      if (rest?.left > 0) {
        waiting.set(mine, ask(now));
        return;
      }
      waiting.delete(mine);
      rest?.drawing();
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

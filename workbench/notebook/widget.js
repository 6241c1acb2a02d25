// Shows the workbench's page in a frame of a notebook; where the browser cannot reach it, says why, and plays the run without it.

const PATIENCE = 8000; // how long the page may take to report that it is there [ms]
const LOCAL = ["localhost", "127.0.0.1"]; // the page is served on this computer only, and cookies need the name that the notebook has

const STYLE = `
  .actr3d { position: relative; display: flex; flex-direction: column; gap: 6px; width: 100%; font: 13px system-ui, sans-serif; }
  .actr3d iframe { flex: 1; min-height: 0; width: 100%; border: 0; border-radius: 4px; background: transparent; }
  .actr3d-note { box-sizing: border-box; padding: 8px 12px; border: 1px solid #8888; border-radius: 4px; line-height: 1.5; }
  .actr3d iframe[hidden] { display: block; position: absolute; inset: 0; height: 100%; visibility: hidden; } /* of its size, to which it lays itself out */
  p.actr3d-note { margin: 0; }
  .actr3d-note p { margin: 0 0 6px; }
  .actr3d-note button { margin-right: 6px; padding: 3px 10px; border: 1px solid #8888; border-radius: 4px; background: #8881; color: inherit; font: inherit; cursor: pointer; }
  .actr3d-note code { font-size: 12px; }
`;

/** Returns whether the notebook is dark behind an element. */
function isDark(element) {
  const canvas = new OffscreenCanvas(1, 1).getContext("2d"); // reads colours in every notation
  for (let at = element; at; at = at.parentElement ?? at.getRootNode().host) {
    canvas.clearRect(0, 0, 1, 1);
    canvas.fillStyle = getComputedStyle(at).backgroundColor;
    canvas.fillRect(0, 0, 1, 1);
    const [red, green, blue, alpha] = canvas.getImageData(0, 0, 1, 1).data;
    if (alpha > 128) return red + green + blue < 384;
  }
  return matchMedia("(prefers-color-scheme: dark)").matches;
}

function made(tag, props, ...children) {
  const element = Object.assign(document.createElement(tag), props);
  element.append(...children);
  return element;
}

function render({ model, el }) {
  const { port, session, ticket } = model.get("page");
  const place = made("div", { className: "actr3d" });
  place.style.height = `${model.get("height")}px`;
  el.append(made("style", { textContent: STYLE }), place);
  let timer = 0;
  let frame = null;
  let asked = false; // whether a replay was asked for here, and not in another view of the widget

  /** Returns the address of the page, for this notebook. */
  function address() {
    const query = new URLSearchParams({ session, theme: isDark(el) ? "dark" : "light", ticket, embedder: location.origin });
    return `http://${location.hostname}:${port}/?${query}`;
  }

  function showPage() {
    frame = made("iframe", { title: "ACT-R 3D", src: address(), allow: "fullscreen" });
    place.replaceChildren(frame);
    timer = setTimeout(() => explain(unreachable(), frame), PATIENCE);
  }

  function unreachable() {
    const forward = made("code", { textContent: `ssh -L ${port}:127.0.0.1:${port} HOST` });
    if (!LOCAL.includes(location.hostname)) {
      return ["The live view comes from a server on the notebook's computer, which answers only browsers that reach it as localhost. Forward the ports of the notebook and of the view (", forward, "), and open the notebook as http://localhost:PORT."];
    }
    return [`The live view at port ${port} does not answer this browser. If the notebook runs on another computer, forward the port: `, forward, ". After a restart of the kernel, or in another browser, run the cell again."];
  }

  /** Says why there is no page, and offers what can be done. A page that is only late is shown as soon as it reports: `late` is its frame. */
  function explain(reason, late = null) {
    clearTimeout(timer);
    frame = late;
    const again = made("button", { textContent: "Try again", onclick: showPage });
    const replay = made("button", { textContent: "Play the run up to now", onclick: askReplay });
    const buttons = port && LOCAL.includes(location.hostname) ? [again, replay] : [replay];
    const note = made("div", { className: "actr3d-note", role: "status" }, made("p", {}, ...reason), ...buttons);
    if (!late) return place.replaceChildren(note);
    late.hidden = true;
    place.prepend(note); // a frame that is moved would load again
  }

  function askReplay() {
    asked = true;
    place.replaceChildren(made("div", { className: "actr3d-note", role: "status" }, "The replay is made as soon as the kernel is free …"));
    model.send({ wanted: "replay" });
  }

  function hearPage({ source, data }) {
    if (!frame || source !== frame.contentWindow || data !== "workbench") return;
    clearTimeout(timer);
    frame.hidden = false;
    place.querySelector(".actr3d-note")?.remove();
  }

  function hearKernel({ replay, error }) {
    if (!asked) return;
    asked = false;
    if (error) return explain([error]);
    const problem = model.get("problem");
    const note = problem ? [made("p", { className: "actr3d-note", textContent: `Only a replay of scene and trace: ${problem}` })] : [];
    // Without `allow-same-origin`, nothing in the replay reaches the notebook.
    place.replaceChildren(...note, made("iframe", { title: "ACT-R 3D", sandbox: "allow-scripts", srcdoc: replay }));
  }

  addEventListener("message", hearPage);
  model.on("msg:custom", hearKernel);
  // The notebook may insert the element only after this function.
  timer = setTimeout(!port ? askReplay : LOCAL.includes(location.hostname) ? showPage : () => explain(unreachable()));
  return () => {
    clearTimeout(timer);
    removeEventListener("message", hearPage);
    model.off("msg:custom", hearKernel);
  };
}

export default { render };

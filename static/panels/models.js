// The list of models: choosing one begins a session with it, or shows the one there is.

import { el } from "../dom.js";
import { call, complain, show } from "../server.js";

export async function models(root) {
  const list = el("select", { ariaLabel: "Model", onchange: () => choose(list.value) });
  root.append(el("label", {}, "model ", list));
  try {
    const { models } = await call("GET", "/api/models");
    list.append(...models.map(({ path, title }) => el("option", { value: path, title }, path)));
    if (models.length === 0) {
      complain("There are no models in the folder: put a Python file there.");
      return;
    }
    const wanted = new URLSearchParams(location.search).get("model");
    const known = models.map(({ path }) => path);
    const first = [wanted, sessionStorage.getItem("model"), "aperture_passage.py", "doorway.py"].find((path) => known.includes(path));
    list.value = first ?? known[0];
    await choose(list.value);
  } catch (error) {
    complain(error.message);
  }
}

async function choose(model) {
  sessionStorage.setItem("model", model);
  try {
    const { sessions } = await call("GET", "/api/sessions");
    const there = sessions.filter((session) => session.model === model).at(-1);
    show((there ?? (await call("POST", "/api/sessions", { model }))).id);
  } catch (error) {
    complain(error.message);
  }
}

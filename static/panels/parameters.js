// The model's parameters: those that are live act at once, the others wait for the next run.

import { el } from "../dom.js";
import { call, complain, order } from "../server.js";
import { store, watch } from "../store.js";

export function parameters(root) {
  const form = el("form", { onsubmit: begin });
  const stale = el("p", { className: "warning", hidden: true }, "The file has changed since this run began.");
  const again = el("button", {}, "restart with these");
  root.append(el("h2", {}, "Parameters"), stale, form);
  let of = null;
  let fields = [];

  function begin(event) {
    event.preventDefault();
    const settings = {};
    for (const { parameter, input } of fields) {
      const value = read(parameter, input);
      if (value !== parameter.default) settings[parameter.name] = value;
    }
    order({ type: "restart", settings });
  }

  watch(["session"], async () => {
    const { session } = store;
    stale.hidden = !session?.stale;
    if (!session || of === `${session.id} ${session.run}`) return;
    of = `${session.id} ${session.run}`;
    try {
      const { listing } = await call("GET", `/api/model?path=${encodeURIComponent(session.model)}`);
      fields = listing.parameters.filter((parameter) => parameter.known).map((parameter) => field(parameter, session.parameters?.[parameter.name]));
      form.replaceChildren(...fields.map(({ label }) => label), ...(fields.length ? [again] : []));
    } catch (error) {
      complain(error.message);
    }
  });
}

function field(parameter, now) {
  const value = now ?? parameter.default;
  const attributes = { name: parameter.name, title: parameter.help };
  const input =
    parameter.takes === "switch"
      ? el("input", { ...attributes, type: "checkbox", checked: Boolean(value) })
      : parameter.takes === "choice"
        ? el("select", attributes, ...parameter.choices.map((choice) => el("option", { selected: choice === value }, String(choice))))
        : el("input", { ...attributes, type: "text", size: 8, value: value ?? "" });
  if (parameter.live) input.addEventListener("change", () => order({ type: "set", name: parameter.name, value: read(parameter, input) }));
  const unit = parameter.unit ? ` [${parameter.unit}]` : "";
  return { parameter, input, label: el("label", { title: parameter.help }, `${parameter.name}${unit} `, input, parameter.live ? " live " : " ") };
}

function read(parameter, input) {
  if (parameter.takes === "switch") return input.checked;
  if (input.value === "" && parameter.optional) return null;
  return parameter.takes === "number" || parameter.takes === "whole number" ? Number(input.value) : input.value;
}

// The recordings: open one again, take it away, delete it.

import { el } from "../dom.js";
import { call, complain, show } from "../server.js";
import { store, watch } from "../store.js";

export function recordings(root) {
  const table = el("table");
  root.append(el("h2", {}, "Recordings ", el("button", { onclick: list }, "refresh")), table);
  let status = null;

  async function list() {
    const { recordings: found } = await call("GET", "/api/recordings");
    table.replaceChildren(...found.slice(0, 20).map(row));
  }

  function row({ id, model, time, ended }) {
    const act = (text, work) => el("button", { onclick: () => work().then(list).catch((error) => complain(error.message)) }, text);
    return el(
      "tr",
      {},
      el("td", {}, el("a", { href: `/api/recordings/${id}/file` }, id)),
      el("td", {}, `${model} ${time.toFixed(2)} s ${ended ?? ""}`),
      el("td", {}, act("open", async () => show((await call("POST", `/api/recordings/${id}/open`)).id))),
      el("td", {}, act("delete", () => call("POST", `/api/recordings/${id}/delete`))),
    );
  }

  watch(["state"], () => {
    if (store.state?.status !== status && store.state?.status === "ended") list().catch(() => {});
    status = store.state?.status;
  });
}

// The model's description: its docstring, with values to try, and links to its source and its page in the manual.

import { h, html } from "../vendor/preact.js";
import { useDescription } from "../inspector/description.js";
import { Button } from "../parts/button.js";
import { Icon } from "../parts/icon.js";
import { openAt } from "../parts/place.js";
import { sendCommand } from "../server.js";
import { runStatus } from "../run_status.js";
import { session } from "../store.js";

/** The elements allowed in a description; the server sends no others. */
const ELEMENTS = new Set(["p", "h2", "h3", "h4", "ul", "ol", "li", "blockquote", "em", "strong", "code", "pre", "br", "hr", "a", "table", "thead", "tbody", "tr", "th", "td"]);

/** Draws a node: a text, or an element with its children. All content is shown as text. */
function Node({ node }) {
  if (typeof node === "string") return node;
  const { tag, children, settings, href } = node;
  if (!ELEMENTS.has(tag)) return html`<${Nodes} nodes=${children} />`;
  if (settings) {
    return html`<${Button} class="try" disabled=${!session.value} title="Run the model from its start with these values" onClick=${() => sendCommand({ type: "restart", settings, run: true })}>
      <${Icon} name="run" /><code>${children}</code>
    <//>`;
  }
  const more = tag === "a" ? { href, target: "_blank", rel: "noopener noreferrer" } : null;
  return h(tag, more, ...children.map((child) => h(Node, { node: child })));
}

function Nodes({ nodes }) {
  return nodes.map((node) => h(Node, { node }));
}

function About() {
  const shown = session.value;
  const { answer, problem } = useDescription();
  if (!shown) return html`<p class="empty">${runStatus.value.text}</p>`;
  const isLost = runStatus.value.is === "unloadable";
  return html`<article class="about">
    <header>
      <span class="mono">${shown.model}</span>
      <span class="stretch"></span>
      ${answer?.manual ? html`<a href=${answer.manual} target="_blank" rel="noopener" title="Its page in the manual, with what it prints and a picture of a run"><${Icon} name="book" />Manual</a>` : null}
      <button title="Open its file in the editor" onClick=${() => openAt(shown.model, 1)}><${Icon} name="pen" />Edit</button>
    </header>
    ${isLost ? html`<p class="bad">${runStatus.value.text}</p>` : null}
    ${problem ? html`<p class="bad">The description cannot be read: ${problem}</p>` : null}
    ${answer ? html`<${Description} answer=${answer} />` : null}
  </article>`;
}

function Description({ answer: { title, nodes, cut, readable } }) {
  if (title.length === 0 && nodes.length === 0) {
    return readable
      ? html`<p class="quiet">This model has no description. A text in triple quotes at the beginning of its file is shown here.</p>`
      : html`<p class="quiet">The text of this model cannot be read as Python, so its description is not known.</p>`;
  }
  return html`<h2><${Nodes} nodes=${title} /></h2>
    <${Nodes} nodes=${nodes} />
    ${cut ? html`<p class="quiet">The description is longer; its file has all of it.</p>` : null}`;
}

export const panel = { id: "about", title: "About", order: 1, View: About, needs: "models folder" };

// Tabs: one of several panels is shown, chosen by pointer or by arrow keys, with a link to its page of the manual.

import { html } from "../vendor/preact.js";
import { ManualLink } from "./manual.js";

/**
 * @param label The accessible name of the tab list.
 * @param tabs [{id, title, View, badge?}]; `badge` returns {text, title?, level?} for a mark beside the title (a dot if the text is
 *   empty), or nothing.
 * @param shown A signal with the id of the visible tab.
 * @param more What comes after the tabs.
 */
export function Tabs({ label, tabs, shown, more = null }) {
  const open = tabs.find(({ id }) => id === shown.value) ?? tabs[0];

  function press(event) {
    if (event.shiftKey || event.ctrlKey || event.metaKey || event.altKey) return;
    const at = tabs.indexOf(open);
    const to = { ArrowRight: at + 1, ArrowLeft: at - 1, Home: 0, End: tabs.length - 1 }[event.key];
    if (to === undefined) return;
    event.preventDefault();
    shown.value = tabs[(to + tabs.length) % tabs.length].id;
    event.currentTarget.children[(to + tabs.length) % tabs.length].focus();
  }

  return html`
    <div class="tab-row"><div class="tabs" role="tablist" aria-label=${label} onKeyDown=${press}>
      ${tabs.map(({ id, title, badge }) => {
        const mark = badge?.();
        return html`<button
          key=${id}
          id="tab-${id}"
          role="tab"
          aria-selected=${open.id === id}
          aria-controls="panel-${id}"
          tabindex=${open.id === id ? 0 : -1}
          onClick=${() => (shown.value = id)}
        >
          <span class="tab-title" data-text=${title}>${title}</span>${mark ? html`<span class="badge ${mark.level ?? ""} ${mark.text ? "" : "dot"}" title=${mark.title}>${mark.text}</span>` : null}
        </button>`;
      })}
    </div><${ManualLink} page=${open.id} title=${open.title} />${more}</div>
    <div class="tab-panel" role="tabpanel" tabindex="-1" id="panel-${open.id}" aria-labelledby="tab-${open.id}" key=${open.id}>
      <${open.View} />
    </div>
  `;
}

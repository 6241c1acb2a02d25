// The editor: any model file of the folder, its problems, and whether the run that is shown is one of this text.

import { html, signal, useEffect, useLayoutEffect, useRef } from "../vendor/preact.js";
import { folder, listModels, model, models, UnusableModels } from "../bar/models.js";
import { define, format, rename as renameName } from "../editor/actions.js";
import { checkByLoading } from "../editor/checks.js";
import { focusText, goToLine, keys, leaveText, showText } from "../editor/code.js";
import { Conflict } from "../editor/conflict.js";
import { documents, look, open, save, shown, shownDocument, take, unsaved, wanted } from "../editor/documents.js";
import { duplicate, makeNew, remove, rename } from "../editor/files.js";
import { ACTIONS, EditorMenu, INSERTIONS } from "../editor/menu.js";
import { Problems } from "../editor/problems.js";
import { Unchanged } from "../editor/unchanged.js";
import { saveAndRun } from "../editor/stale_run.js";
import { FileBanner } from "../editor/banner.js";
import { command, commandsOf } from "../commands.js";
import { buttonTitle, noteKey } from "../keys.js";
import { goToTab } from "../open_tab.js";
import { Button } from "../parts/button.js";
import { Icon } from "../parts/icon.js";
import { connected, session } from "../store.js";

const needs = "models folder";
const AGAIN = 3000; // how often it checks whether the file has changed on disk [ms]

/** The text whose two versions are compared. */
const comparing = signal(null);
let followed = { of: null, id: null }; // the model that was last opened because it is shown, and its session

async function saveShown() {
  const document = shownDocument();
  if (!document) return;
  if (!(await save(document)) && document.theirs.value?.text != null) comparing.value = document;
}

async function runShown() {
  const document = shownDocument();
  if (!document) return;
  await saveAndRun(document);
  if (document.theirs.value?.text != null) comparing.value = document;
}

Object.assign(keys, { run: runShown, save: saveShown });
const hasText = () => Boolean(shownDocument());
const noText = () => "No file is open in the editor.";
const saving = command({ text: "Save the text", key: "Mod+s", group: "Editor", work: saveShown, ready: hasText, why: noText, needs });
const runningText = command({ text: "Save the text, and run it", key: "Mod+Enter", group: "Editor", work: runShown, ready: hasText, why: noText, needs });
noteKey("Escape+Tab", "One after the other: leave the text, where Tab alone indents", "Editor", needs);

const onShown = (work) => () => shownDocument() && work(shownDocument());
Object.assign(keys, { define: onShown(define), rename: onShown(renameName), format: onShown(format) });
for (const { key, text } of ACTIONS) noteKey(key, text.replace(" …", ""), "Editor", needs);
commandsOf(
  () =>
    [
      ...ACTIONS,
      ...INSERTIONS.map(({ text, work }) => ({ text: `Insert a snippet: ${text}`, work })),
      { text: "New model …", work: makeNew, ready: () => true },
      { text: "Duplicate the file …", work: () => duplicate(shown.value.path) },
      { text: "Check: load the text, and list what is wrong", work: () => checkByLoading(shownDocument()) },
      { text: "Rename the file …", work: () => rename(shown.value.path) },
      { text: "Delete the file …", work: () => remove(shown.value.path, shownDocument().dirty.value) },
    ].map(({ key = null, text, work, ready = hasText }) => {
      const inText = () => {
        goToTab("editor");
        requestAnimationFrame(work); // once the text is visible
      };
      return { text, key, group: "Editor", work: inText, ready, why: noText };
    }),
  { needs },
);
noteKey("Mod+Click", "Go to the definition", "Editor", needs);

/** Applies the user's choice between two versions. */
async function choose(document, which) {
  comparing.value = null;
  const theirs = document.theirs.value;
  if (which === "mine" && !(await save(document, theirs.version)) && document.theirs.value) comparing.value = document;
  if (which === "theirs") take(document, theirs);
  requestAnimationFrame(focusText); // once it is visible again
}

/** Checks regularly whether files have changed on disk, while the editor is visible. */
function useLooking() {
  useEffect(() => {
    function lookAt(list) {
      if (document.visibilityState === "hidden" || connected.value === false) return;
      for (const one of list) look(one).catch(() => {}); // a failed request is repeated next time
    }
    function returned() {
      lookAt(documents.peek().values());
      listModels().catch(() => {});
    }
    const timer = setInterval(() => lookAt([shownDocument()].filter(Boolean)), AGAIN);
    addEventListener("focus", returned);
    return () => {
      clearInterval(timer);
      removeEventListener("focus", returned);
    };
  }, []);
}

function Files({ path, document }) {
  const waiting = unsaved();
  const known = models.value.some((one) => one.path === path);
  const option = (one) => html`<option key=${one} value=${one}>${waiting.includes(one) ? "● " : ""}${one}</option>`;
  const tool = (name, text, work, off = !document) =>
    html`<${Button} class="bare" title=${text} aria-label=${text} disabled=${off} onClick=${work}><${Icon} name=${name} /><//>`;
  return html`<div class="tools" role="toolbar" aria-label="Files">
    <select class="file" aria-label="File" title="${folder.value}/${path ?? ""}" value=${path ?? ""} onChange=${(event) => open(event.currentTarget.value)}>
      ${path ? null : html`<option value="">no file</option>`}
      ${path && !known ? option(path) : null}${models.value.map((one) => option(one.path))}
      <${UnusableModels} />
    </select>
    ${tool("file", "New model", makeNew, false)}${tool("copy", "Duplicate", () => duplicate(path))}
    ${tool("pen", "Rename", () => rename(path))}${tool("trash", "Delete", () => remove(path, document.dirty.value))}
    ${tool("check", "Check the model without a run: a file with a function build is executed for the first 10 ms of the run, any other file is only compiled", () => checkByLoading(document))}
    <${EditorMenu} disabled=${!document} />
  </div>`;
}

function Standing({ document }) {
  const dirty = document.dirty.value;
  const note = document.note.value;
  const full = `${folder.value}/${document.path}`;
  return html`<div class="file-status">
    <span class="path" title=${full}><bdi>${full.slice(0, full.lastIndexOf("/") + 1)}</bdi></span>
    <span class="state" role="status">
      ${document.saving.value ? html`<span class="quiet">saving …</span>` : dirty ? html`<span class="unsaved">● unsaved</span>` : null}
      ${note && !document.saving.value ? html`<span class="quiet" title=${note}>${note}</span>` : null}
    </span>
    <${Button} disabled=${!dirty} title=${buttonTitle(saving, "Save")} onClick=${saveShown}>Save<//>
    <button class="primary" title=${buttonTitle(runningText, "Save, and run from the start")} onClick=${runShown}>Save and run</button>
  </div>`;
}

function Editor() {
  const place = useRef(null);
  const { path, error } = shown.value;
  const document = shownDocument();
  const compares = document && comparing.value === document && document.theirs.value?.text != null;
  const { id = null, model: of = model.value } = session.value ?? {};
  useLooking();
  // At once, not after the next picture: by then the user may have chosen another file, which this would replace.
  useLayoutEffect(() => {
    if (!of) return;
    const other = of !== followed.of && (id === null || id !== followed.id); // not only another name of the same model
    followed = { of, id };
    if (other && !wanted.value) open(of);
  }, [of, id]);
  useLayoutEffect(() => {
    if (document && !compares) {
      showText(place.current, document);
      if (place.current.closest("[role=tabpanel]:focus")) focusText(); // a command has opened the tab before the text was read
    }
    return leaveText;
  }, [document, compares]);
  useLayoutEffect(() => {
    if (!document || compares || wanted.value?.path !== document.path) return;
    goToLine(wanted.value.line);
    wanted.value = null;
  }, [document, compares, wanted.value]);
  return html`<div class="editor">
    <${Files} path=${path} document=${document} />
    ${document ? html`<${Standing} document=${document} />` : null}
    ${compares ? html`<${Conflict} document=${document} choose=${(which) => choose(document, which)} />` : null}
    <div class="code" ref=${place} hidden=${!document || compares}></div>
    ${document
      ? html`${compares ? null : html`<${Unchanged} document=${document} /><${FileBanner} document=${document} compare=${() => (comparing.value = document)} />`}<${Problems} document=${document} />`
      : html`<div class="empty">
          <p class=${error ? "bad" : ""}>${error ?? (path ? "Being read …" : "No file is open. Choose one above, or make a new model.")}</p>
          ${path && !error ? null : html`<button onClick=${makeNew}>Make a new model</button>`}
        </div>`}
  </div>`;
}

export const panel = {
  id: "editor",
  title: "Editor",
  order: 7,
  View: Editor,
  needs,
  badge: () => (unsaved().length > 0 ? { text: "", title: "unsaved" } : null),
};

// Preact with its hooks, signals and tagged templates: what panels are written in.
import htm from "htm";
import { Fragment, h, render } from "preact";

export { batch, computed, effect, signal, untracked, useComputed, useSignal, useSignalEffect } from "@preact/signals";
export { useCallback, useEffect, useId, useLayoutEffect, useMemo, useRef, useState } from "preact/hooks";
export { Fragment, h, render };
export const html = htm.bind(h);

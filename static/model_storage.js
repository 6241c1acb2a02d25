// What the page remembers for each model from one visit to the next.

import { computed } from "./vendor/preact.js";
import { remembered } from "./local_storage.js";
import { session } from "./store.js";

const MAX_MODELS = 50; // of which something is remembered

/** Returns {kept, keep}: a signal with what is remembered for the model that is shown, null for nothing; and a function that remembers
 * another value, or null.
 *
 * @param name The name under which it is stored, as [{model, [field]: value}].
 */
export function rememberedByModel(name, field) {
  const all = remembered(name, []);
  const model = () => session.value?.model ?? null;
  return {
    kept: computed(() => all.value.find((one) => one.model === model())?.[field] ?? null),
    keep(value) {
      const mine = session.peek()?.model ?? null;
      all.value = [...all.newest().filter((one) => one.model !== mine), ...(value === null ? [] : [{ model: mine, [field]: value }])].slice(-MAX_MODELS);
    },
  };
}

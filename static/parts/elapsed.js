// The time that something has taken so far.

import { useEffect, useSignal } from "../vendor/preact.js";

/** Returns how much time has passed since a moment [ms since 1970] as text, `12 s`; it grows. There may be no moment. */
export function useElapsed(since) {
  const passed = useSignal(0);
  useEffect(() => {
    if (!since) return undefined;
    const look = () => (passed.value = (Date.now() - since) / 1000);
    look();
    const clock = setInterval(look, 200);
    return () => clearInterval(clock);
  }, [since]);
  return `${passed.value.toFixed(0)} s`;
}

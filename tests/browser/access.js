// What of a page cannot be read, named or reached by keyboard: a list of texts. Frames are not looked into.
() => {
  const MIN_CONTRAST = 4.5; // contrast of text, WCAG 2.2 AA
  const LARGE = 3; // and of large text, 24 px, or 18.66 px and bold; and of what shows where a field is
  const INTERACTIVE = "button, a[href], input, select, textarea, summary, [role=tab], [role=slider], [role=separator][tabindex], [role=checkbox], [role=button]";
  const found = [];
  const canvas = document.createElement("canvas").getContext("2d", { willReadFrequently: true });

  /** Returns red, green, blue and alpha of any colour of CSS. */
  function rgba(colour) {
    canvas.clearRect(0, 0, 1, 1);
    canvas.fillStyle = colour;
    canvas.fillRect(0, 0, 1, 1);
    const [r, g, b, a] = canvas.getImageData(0, 0, 1, 1).data;
    return [r, g, b, a / 255];
  }

  const over = ([r, g, b, a], back) => [r, g, b].map((part, n) => part * a + back[n] * (1 - a));

  function luminance(colour) {
    const [r, g, b] = colour.slice(0, 3).map((part) => (part / 255 <= 0.04045 ? part / 255 / 12.92 : ((part / 255 + 0.055) / 1.055) ** 2.4));
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  }

  function contrast(one, other) {
    const [light, dark] = [luminance(one), luminance(other)].sort((a, b) => b - a);
    return (light + 0.05) / (dark + 0.05);
  }

  /** Returns what is behind an element, as one colour. */
  function behind(element) {
    const layers = [];
    for (let at = element; at; at = at.parentElement) layers.unshift(rgba(getComputedStyle(at).backgroundColor));
    return layers.reduce((back, layer) => over(layer, back), [255, 255, 255]);
  }

  function seen(element) {
    return element.checkVisibility({ opacityProperty: true, visibilityProperty: true }) && element.getClientRects().length > 0;
  }

  const isOff = (element) => Boolean(element.closest(":disabled, [aria-disabled=true]"));
  const say = (element) => `<${element.tagName.toLowerCase()} class="${element.className?.baseVal ?? element.className}"> ${(element.textContent || element.value || "").trim().slice(0, 40)}`;

  function readable(element, colour, what) {
    const style = getComputedStyle(element);
    const size = parseFloat(style.fontSize);
    const large = size >= 24 || (size >= 18.66 && Number(style.fontWeight) >= 700);
    let opacity = 1;
    for (let at = element; at; at = at.parentElement) opacity *= Number(getComputedStyle(at).opacity);
    const back = behind(element);
    const [r, g, b, a] = rgba(colour);
    const ratio = contrast(over([r, g, b, a * opacity], back), back);
    if (ratio < (large ? LARGE : MIN_CONTRAST) - 0.005) found.push(`contrast ${ratio.toFixed(2)} of ${what}: ${say(element)}`);
  }

  for (const element of document.body.querySelectorAll("*")) {
    if (element.closest("iframe, .cm-announced") || !seen(element) || isOff(element)) continue;
    const own = [...element.childNodes].some((node) => node.nodeType === Node.TEXT_NODE && node.data.trim());
    if (own && !["SCRIPT", "STYLE", "OPTION", "OPTGROUP"].includes(element.tagName)) readable(element, getComputedStyle(element).color, "text");
    if (element.placeholder && !element.value) readable(element, getComputedStyle(element, "::placeholder").color, "placeholder");
  }

  const FIELD = "textarea, input:not([type=range], [type=checkbox], [type=radio], [type=file])";
  for (const element of document.body.querySelectorAll(FIELD)) {
    if (!seen(element) || isOff(element)) continue;
    const back = behind(element.parentElement);
    const ratio = contrast(over(rgba(getComputedStyle(element).borderTopColor), back), back);
    if (ratio < LARGE - 0.005) found.push(`contrast ${ratio.toFixed(2)} of the border of a field: ${say(element)} ${element.ariaLabel ?? element.id}`);
  }

  /** Returns what an element is called, as far as this page names things. */
  function nameOf(element) {
    const by = (element.getAttribute("aria-labelledby") ?? "").split(" ").map((id) => document.getElementById(id)?.textContent ?? "");
    const labels = [...(element.labels ?? [])].map((label) => label.textContent);
    return [element.getAttribute("aria-label"), ...by, ...labels, element.matches("input, select, textarea, [role=slider]") ? "" : element.textContent, element.title]
      .find((text) => text?.trim());
  }

  for (const element of document.querySelectorAll(INTERACTIVE)) {
    if (!seen(element) || isOff(element)) continue;
    if (!nameOf(element)) found.push(`no name: ${say(element)} ${element.outerHTML.slice(0, 120)}`);
    const set = element.closest("[role=tablist], .production-names, .rows, .graph-nodes"); // the arrow keys go from one to the next
    const reached = element.tabIndex >= 0 || set?.tabIndex === 0 || set?.querySelector("[tabindex='0']");
    if (!reached) found.push(`not reached by keyboard: ${say(element)}`);
  }
  for (const element of document.querySelectorAll("canvas, svg")) {
    if (seen(element) && !element.closest("[aria-hidden=true]") && element.getAttribute("role") !== "img") found.push(`neither named nor hidden: ${say(element)} ${element.outerHTML.slice(0, 100)}`);
  }
  const ids = [...document.querySelectorAll("[id]")].map(({ id }) => id);
  for (const id of new Set(ids.filter((one, n) => ids.indexOf(one) !== n))) found.push(`twice the same id: ${id}`);
  return [...new Set(found)];
}

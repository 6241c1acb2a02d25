// Completion: the names of the core, besides those of Python and of the file itself.

const CORE = {
  class: [
    "ACTR", "Buffer", "Memory", "Model", "ProductionSystem", "Chunk", "BlendingMemory", "Motor", "Vision", "SOSVision", "Timer", "TextOutput",
    "ImaginalModule", "DMAssociate", "DMBaseLevel", "DMFixed", "DMInhibition", "DMNoise", "DMSalience", "DMSpreading", "Partial",
    "PMCompile", "PMNew", "PMNoise", "PMPGC", "PMPGCMixedWeighted", "PMPGCSuccessWeighted", "PMTD",
    "Simulation", "BodyPort", "Scene", "Floor", "Aperture", "Mannequin", "Configuration", "Live",
  ],
  function: ["finished", "log", "log_everything", "run"],
};
const METHODS = ["add", "clear", "isEmpty", "modify", "now", "request", "run", "set", "stop"];

const core = Object.entries(CORE).flatMap(([type, words]) => words.map((label) => ({ label, type })));
const methods = METHODS.map((label) => ({ label, type: "method" }));

/** Returns completions for the word at the cursor, if it is in code. */
export function complete(context) {
  const member = context.matchBefore(/\.\w*$/);
  if (member) return { from: member.from + 1, options: methods, validFor: /^\w*$/ };
  const word = context.matchBefore(/\w+$/);
  if (!word && !context.explicit) return null;
  return { from: word ? word.from : context.pos, options: core, validFor: /^\w*$/ };
}

// The pieces of new models: short and runnable.

const ABOUT = "Say in one line what this model is about.";

/** Returns an agent that counts; `last` is the text of the number at which it ends. */
const counting = (last) => `class Agent(ACTR):
    goal = Buffer()
    last = ${last}

    def init():
        goal.set(f"count number:1 last:{last}")

    def count_on(goal="count number:?number last:!?number"):
        print(number)
        goal.modify(number=int(number) + 1)

    def finish(goal="count number:?number last:?number"):
        print(number)
        goal.clear()
`;

/** An agent alone: {imports, source}. */
export const AGENT = { imports: ["from actr3d.actr import *"], source: counting("5") };

/** The beginning of a program: its docstring, and its parameters, which must come before any other code. */
const WITH_PARAMETERS = `"""${ABOUT}

What to try
-----------
- \`last = 9\`: it counts further.
"""

last = 5`;

const START = `if __name__ == "__main__":
    model = Agent()
    model.run()
`;

/** An agent with a body in a world: {imports, source}. */
export const BODY = {
  imports: [
    "from dataclasses import dataclass",
    "from typing import Annotated",
    "from annotated_types import Gt, Le",
    "from actr3d.actr import *",
    "from actr3d.configuration import Configuration, Live",
    "from actr3d.simulation import BodyPort, Simulation",
    "from actr3d.world import Aperture, Floor, Mannequin, Scene",
  ],
  source: `@dataclass(frozen=True, kw_only=True)
class Parameters(Configuration):
    """The parameters of the model."""

    width: Annotated[float, Gt(0), Le(3), Live("aperture")] = 0.8
    """The free width of the doorway [m]."""

    speed: Annotated[float, Gt(0), Le(3)] = 1.2
    """How fast it walks [m/s]."""


class Walker(ACTR):
    goal = Buffer()
    felt = Buffer()
    skin = BodyPort(felt)

    def init():
        goal.set("walk")
        skin.set("walk", self.speed)

    def feel(goal="walk", felt=None, skin="busy:False"):
        skin.request("pose")

    def walk_on(goal="walk", felt="pose x:?x"):
        felt.clear()
        if float(x) > 8:
            goal.set("arrived")

    def arrive(goal="arrived"):
        skin.set("stop")
        print(f"{self.now():.2f} s: arrived")
        goal.set("done")
        self.stop()


def build(parameters: Parameters) -> Simulation:
    """Puts a walker in front of a doorway."""

    def agent():
        walker = Walker()
        walker.speed = parameters.speed
        return walker

    scene = Scene(parts=(Floor(), Aperture(width=parameters.width), Mannequin(name="walker")))
    return Simulation(scene, {"walker": agent})
`,
};

/** Returns the place of an import in a file: 0 among those of the standard library, 1 of other packages, 2 of this one. */
export const groupOf = (line) => (/^from (actr3d|workbench)/.test(line) ? 2 : /^from (annotated_types|numpy)/.test(line) ? 1 : 0);

/** Returns imports by their groups, as the text of each group. */
export function importGroups(imports) {
  const groups = [0, 1, 2].map((group) => ({ group, text: imports.filter((line) => groupOf(line) === group).join("\n") }));
  return groups.filter(({ text }) => text);
}

/** Returns imports in the order of a file, with a line between the groups. */
export const importLines = (imports) => importGroups(imports).map(({ text }) => text).join("\n\n");

const file = (...parts) => `${parts.map((part) => part.trimEnd()).join("\n\n\n")}\n`;

/** The templates to choose from: {value, text, source}. */
export const TEMPLATES = [
  { value: "agent", text: "An agent alone", source: file(`${WITH_PARAMETERS}\n\n${importLines(AGENT.imports)}`, counting("last"), START) },
  { value: "body", text: "An agent with a body in a world", source: file(`"""${ABOUT}"""\n\n${importLines(BODY.imports)}`, BODY.source) },
];

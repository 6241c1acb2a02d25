"""SOS vision: seeing what catches the eye.

Somebody glances at a crossing again and again, looking for a lamp. The red lamp catches the eye more often than the
green one, and sometimes neither does.

`SOSVision` finds things in the agent's environment that match a pattern. Each is noticed with a probability of its
own, its `salience`; one of those that are noticed comes to the buffer, at random. If none is, the buffer is
cleared and the module's `error` becomes True, which a production can match.

What to expect
--------------
With saliences r and g, the red lamp is seen with probability `r (1 - g) + r g / 2`, the green one with
`g (1 - r) + r g / 2`, and neither with `(1 - r) (1 - g)` (West & Emond 2002). For r = 0.9 and g = 0.4: 0.72, 0.22
and 0.06. The tree does not match, so its salience does not matter. Of n glances, shares differ from this by about
`sqrt(p (1 - p) / n)`.

What to try
-----------
- `red_salience = 0.4`: both lamps are seen equally often.
- `glances = 1000`: shares nearer to the equation.
- In the tab *Editor*: a third lamp; a lamp with `visible = False`; asking for `colour:red` alone.
"""

red_salience = 0.9
green_salience = 0.4
glances = 250

from actr3d.actr import *


class Observer(ACTR):
    goal = Buffer()
    seen = Buffer()
    vision = SOSVision(seen, delay=0.085)
    remaining = glances
    counts = {"red": 0, "green": 0, "nothing": 0}

    def init():
        goal.set("task:look")

    def look(goal="task:look", vision="busy:False"):
        seen.clear()
        vision.request("kind:lamp")
        goal.set("task:see")

    def see(goal="task:see", seen="kind:lamp colour:?colour"):
        counts[colour] += 1
        self.go_on()

    def miss(goal="task:see", vision="error:True busy:False"):
        counts["nothing"] += 1
        self.go_on()

    # No pattern, but a parameter: this is not a production, only a method that productions call.
    def go_on(self):
        self.remaining -= 1
        if self.remaining > 0:
            self.goal.set("task:look")
        else:
            self.goal.clear()


class Crossing(Model):
    red_lamp = Model(kind="lamp", colour="red", salience=red_salience)
    green_lamp = Model(kind="lamp", colour="green", salience=green_salience)
    tree = Model(kind="tree", colour="green", salience=1.0)


def predicted():
    """Returns how often each is seen."""
    both = red_salience * green_salience
    return {
        "red": red_salience - both / 2,
        "green": green_salience - both / 2,
        "nothing": (1 - red_salience) * (1 - green_salience),
    }


if __name__ == "__main__":
    crossing = Crossing()
    crossing.observer = Observer()
    crossing.run()
    print("seen      share  equation")
    counts = crossing.observer.counts
    done = max(1, sum(counts.values()))
    for what, share in predicted().items():
        print(f"{what:8} {counts[what] / done:6.3f} {share:9.3f}")

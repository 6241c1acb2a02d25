"""Utility learning: how rewards of actions form a habit.

Every morning somebody goes to work, by bus or on foot. Both have the same reward, but walking takes longer. Which
is better is learned by trying.

Of the productions that match, the one with the highest utility fires. `PMNew` learns utilities from rewards,
`PMNoise` adds noise, so that the second best is sometimes tried.

What to expect
--------------
At each reward R, every production chosen since the last one changes by `U += alpha (R - dt - U)`, where dt is the
time from its choice to the reward (Anderson 2007, How can the human mind occur in the physical universe?). So U
approaches R - dt. With a reward of 2, and 0.1 s for the two productions on the way, that is 2 - 2.1 for the bus and
2 - 3.1 on foot. Both begin at 0, and are chosen equally often at first. In the end the better one, ahead by d = 1,
is chosen with probability `p = 1 - ((x - 1) exp(-x) + exp(-2x)) / (1 - exp(-x))^2`, x = d / s, where s is the scale
of the logistic noise on both: 0.846 for s = 0.4.

What to try
-----------
- `noise = 0.1`: hardly ever walks.
- `alpha = 0.02`: learns slowly.
- `walk_time = 2`: which one becomes the habit?
- `reward = 10`: stays with whatever it tried first. That has been rewarded, and what was never tried is still worth 0.
"""

alpha = 0.1
noise = 0.4
reward = 2.0
bus_time = 2.0
walk_time = 3.0
mornings = 250

import math

from actr3d.actr import *


class Journey(Model):
    """The journey to work: it is not part of cognition, and takes time."""

    def go(self, time):
        yield time
        self.parent.goal.set("place:work")


class Commuter(ACTR):
    goal = Buffer()
    journey = Journey()
    pm_new = PMNew(alpha=alpha)
    pm_noise = PMNoise(noise=noise)
    reward_at_work, bus_time, walk_time, mornings = reward, bus_time, walk_time, mornings
    choices = []

    def init():
        goal.set("place:home")

    def by_bus(goal="place:home"):
        choices.append("bus")
        goal.set("place:under_way")
        journey.go(bus_time)

    def on_foot(goal="place:home"):
        choices.append("foot")
        goal.set("place:under_way")
        journey.go(walk_time)

    def arrive(goal="place:work"):
        self.reward(reward_at_work)
        if len(choices) < mornings:
            goal.set("place:home")
        else:
            goal.clear()


def predicted():
    """Returns how often the bus is taken once both utilities are learned, for noise above 0."""
    x = abs(walk_time - bus_time) / noise
    better = 1 - ((x - 1) * math.exp(-x) + math.exp(-2 * x)) / (1 - math.exp(-x)) ** 2 if x else 0.5
    return better if walk_time >= bus_time else 1 - better


if __name__ == "__main__":
    agent = Commuter()
    agent.run()
    print("mornings   by bus")
    for first in range(0, len(agent.choices), 25):
        block = agent.choices[first : first + 25]
        print(f"{first + 1:4}-{first + len(block):<4} {block.count('bus') / len(block):6.2f}")
    if noise > 0:
        print(f"equation  {predicted():6.2f}")
    # Without the noise, a production's activation is what it has learned.
    agent.pm_noise.noise = 0
    for name, time in (("by_bus", bus_time), ("on_foot", walk_time)):
        print(f"utility of {name:7} {agent.get_activation(name):6.3f}, equation {reward - time - 0.1:6.3f}")

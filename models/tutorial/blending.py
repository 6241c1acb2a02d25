"""Blending: an estimate from all that was experienced.

How long does one wait for the bus? Nobody answers this from the memory of one particular morning: all waits that were
experienced contribute to the estimate, recent ones more than old ones.

A `BlendingMemory` does not retrieve the most active chunk, but a mixture of all that match. Numbers in their slots
become a mean, in which each chunk counts with the weight `exp(A)`.

What to expect
--------------
The blend is `sum p_i v_i`, `p_i = exp(A_i) / sum exp(A_j)`, with the temperature 1 of Python ACT-R (Lebiere 1999,
Kognitionswissenschaft 8). With base-level learning, a chunk that was experienced once, t seconds ago, has
`A = ln t^-d`, so that exp(A) is just `t^-d`. Right after a wait of 20 minutes the estimate is high; as time
passes, all experiences become equally old, and it moves towards their plain mean, 11 minutes. The table in the
*Console* shows the estimates beside that equation.

What to try
-----------
- `decay = 0`: the plain mean, always.
- `decay = 1`: nearly the last experience alone.
- Another wait in `WAITS`, in the tab *Editor*.
"""

decay = 0.5

from actr3d.actr import *

# Waits [minutes], and how long ago they were [s].
WAITS = {7: 7 * 86400, 9: 2 * 86400, 8: 86400, 20: 60}
# How long to pause before each estimate [s].
PAUSES = (1, 600, 3600, 86400, 7 * 86400)


class Traveller(ACTR):
    goal = Buffer()
    retrieval = Buffer()
    memory = BlendingMemory(retrieval, threshold=-20)
    base_level = DMBaseLevel(memory, decay=decay)
    waits = WAITS
    pauses = list(PAUSES)
    asked = 0
    estimates = []

    def init():
        for minutes, ago in waits.items():
            memory.add(f"what:bus minutes:{minutes}", time=ago)
        goal.set("task:pause")
        self.pause()

    def pause(self):
        yield self.pauses.pop(0)
        self.goal.set("task:estimate")

    def estimate(goal="task:estimate"):
        retrieval.clear()
        memory.request("what:bus minutes:?")
        self.asked = self.now()
        goal.set("task:expect")

    def expect(goal="task:expect", retrieval="what:bus minutes:?minutes"):
        estimates.append((self.asked, float(minutes)))
        goal.set("task:pause")
        if pauses:
            self.pause()


def predicted(now):
    """Returns the mean of all waits, weighted by t^-d."""
    weights = [(now + ago) ** -decay for ago in WAITS.values()]
    return sum(weight * minutes for weight, minutes in zip(weights, WAITS)) / sum(weights)


if __name__ == "__main__":
    agent = Traveller()
    agent.run()
    print("      time   estimate   equation")
    for asked, minutes in agent.estimates:
        print(f"{asked:10.0f} s {minutes:8.2f} {predicted(asked):10.2f} minutes")

"""The fan effect: the more we know of something, the longer each fact about it takes to remember.

Facts of the form «the miller is in the harbour» have been learned, and now some of them are recognised. Of some
people and places only one fact is known, of others two or three: that number is their fan.

The mechanism is spreading activation. The person and the place in the goal buffer send activation to the facts in
memory that contain them; the more facts contain one of them, the less activation each fact receives.

What to expect
--------------
The activation of a fact is `A = sum W_j S_j` over the person and the place in the goal, where W_j is the weight of
each (here 0.5) and `S_j = S - ln(fan_j + 1)` (Anderson & Lebiere 1998, chapter 3; Anderson & Reder 1999, Journal of
Experimental Psychology: General 128). It is retrieved after `F exp(-A)`. The table in the *Console* shows the time
of each retrieval beside that equation. The time grows with the fan of the person and with that of the place alike,
and more slowly for each further fact.

What to try
-----------
- `strength = 2`: everything becomes faster.
- `attention = 0`: the effect disappears.
- A fourth fact on the miller, in the tab *Editor*.
"""

strength = 1.6
attention = 1.0
latency_factor = 0.63

import math

from actr3d.actr import *

FACTS = (
    "sailor cellar",
    "baker meadow",
    "tailor church",
    "tailor meadow",
    "miller harbour",
    "miller church",
    "miller meadow",
)


class Recognition(ACTR):
    goal = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval, latency=latency_factor)
    spreading = DMSpreading(memory, goal)
    spreading.strength = strength
    # The goal's attention is divided between the person and the place.
    spreading.weight[goal] = attention / 2
    facts = FACTS
    questions = list(FACTS)
    times = {}

    def init():
        for fact in facts:
            person, place = fact.split()
            memory.add(f"person:{person} place:{place}")
        goal.set("task:listen")

    def listen(goal="task:listen"):
        if questions:
            person, place = questions.pop(0).split()
            goal.set(f"task:recognise person:{person} place:{place} since:none")
        else:
            goal.clear()

    def recognise(goal="task:recognise person:?person place:?place since:none"):
        memory.request("person:?person place:?place")
        goal.modify(since=self.now())

    def say_yes(goal="task:recognise person:?person place:?place", retrieval="person:?person place:?place"):
        # Firing took a production's time after the fact had arrived.
        times[f"{person} {place}"] = self.now() - goal["since"] - self.production_time
        goal.set("task:listen")


def predicted(person_fan, place_fan):
    """Returns the equation's retrieval time [s]."""
    activation = attention / 2 * (2 * strength - math.log(person_fan + 1) - math.log(place_fan + 1))
    return latency_factor * math.exp(-activation)


def fan(word):
    return sum(word in fact.split() for fact in FACTS)


if __name__ == "__main__":
    agent = Recognition()
    agent.run()
    print("fact              fan of person, place   time   equation")
    for fact, time in agent.times.items():
        fans = [fan(word) for word in fact.split()]
        print(f"{fact:17} {fans[0]:13} {fans[1]:6}   {time:.3f} s   {predicted(*fans):.3f} s")

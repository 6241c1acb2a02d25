"""Counting, step by step: how long a thought takes.

The agent counts from one number to another, with nothing but remembered facts of the form «after 3 comes 4».

It repeats a cycle of productions and retrievals. A production asks declarative memory for a fact (`memory.request`).
The fact arrives in the retrieval buffer a little later, and the next production waits for that.

What to expect
--------------
A production takes 0.05 s. A retrieval takes `F exp(-A)` (Anderson & Lebiere 1998, chapter 3), with F = 0.05 s here,
and A = 0 as the memory has no activation modules: 0.05 s too. So the first number comes after
0.05 + 0.05 + 0.05 = 0.150 s, and each further one 0.1 s later. The last one needs no fact, so it is said 0.05 s
after the one before it.

What to try
-----------
- `first = 3, last = 9`: other numbers.
- `latency_factor = 0.5`: a slow memory.
- `first = 5, last = 2`: where does it stop?
- Step from production to production (key C), and watch the buffers.
"""

first = 2
last = 6
latency_factor = 0.05

from actr3d.actr import *


class Counting(ACTR):
    goal = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval, latency=latency_factor)
    # Productions see the agent's attributes by name, so what they need is made one.
    first, last = first, last

    def init():
        for number in range(20):
            memory.add(f"number:{number} next:{number + 1}")
        goal.set(f"task:begin number:{first} last:{last}")

    def begin(goal="task:begin number:?now"):
        memory.request("number:?now next:?")
        goal.modify(task="count")

    def count_on(goal="task:count number:?now last:!?now", retrieval="number:?now next:?following"):
        print(f"{self.now():.3f} s: {now}")
        goal.modify(number=following)
        memory.request("number:?following next:?")

    def finish(goal="task:count number:?now last:?now"):
        print(f"{self.now():.3f} s: {now}, and that is all")
        goal.clear()


if __name__ == "__main__":
    Counting().run()

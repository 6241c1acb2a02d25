"""Counts from 2 to 5, by remembering what comes after each number.

This is the smallest model. An agent is a class of type `ACTR`. It has buffers, each of which holds one chunk (a few slots with values)
or nothing, and a memory. Each method whose parameters all have patterns for defaults is a production:
«if the goal buffer holds ... and the retrieval buffer holds ..., then ...». One production fires at a
time, and takes 50 ms.

Productions need no `self`: inside them, the agent's parts are known by name. `?now` in a pattern binds the
variable `now` to the value of that slot, for the whole production; `!?now` means «anything but this».
Only slots that a pattern names are looked at.

What to expect
--------------
The tab *Console* shows 2, 3, 4, 5. Counting begins with a production and a retrieval of 0.05 s each; each further number
takes the same again.

What to try
-----------
- Step through it (key C goes to the next production), and watch the goal and the retrieval buffer.
- Other numbers in `goal.set`, in the tab *Editor*; then let it count further than it knows.
"""

from actr3d.actr import *


class Counting(ACTR):
    goal = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval)

    # A method without parameters is carried out once, before anything else.
    def init():
        for number in range(10):
            memory.add(f"count {number} {number + 1}")
        goal.set("task:start number:2 last:5")

    def start_counting(goal="task:start number:?now"):
        memory.request("count ?now ?next")
        goal.modify(task="count")

    # ?now is in both patterns: the retrieved fact must be about the number in the goal.
    def count_on(goal="task:count number:?now last:!?now", retrieval="count ?now ?next"):
        print(now)
        goal.modify(number=next)
        memory.request("count ?next ?after")

    def stop_counting(goal="task:count number:?now last:?now"):
        print(now)
        goal.clear()


if __name__ == "__main__":
    model = Counting()
    model.run()

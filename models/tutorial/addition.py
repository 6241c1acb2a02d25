"""Addition by counting up, as children do it on their fingers.

5 + 3 is found by counting 6, 7, 8 while the fingers show 1, 2, 3. The only knowledge is what comes after each
number.

The goal buffer is the working memory. Its slots change step by step, and what they hold decides which
production is next: `fingers:!?b` asks for fingers that do not show the second number yet, `fingers:?b` for just
that number.

What to expect
--------------
Each step takes 0.25 s: three productions of 0.05 s and two retrievals of 0.05 s (`F exp(-A)` with F = 0.05 s and
A = 0). With 0.05 s to begin and 0.05 s to answer, a + b takes 0.1 + 0.25 b s, here 0.850 s: the time grows with
the second number alone. People who first choose the larger number show times that grow with the smaller one
instead (the «min» model of Groen & Parkman 1972, Psychological Review 79).

What to try
-----------
- `a = 3, b = 5`: the same sum takes longer.
- In the tab *Editor*: facts on which number is larger, and a production that swaps the numbers first.
- Or a stored answer (`memory.add("a:5 b:3 sum:8")`), and a production that looks for one before it counts.
"""

a = 5
b = 3

from actr3d.actr import *


class Addition(ACTR):
    goal = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval)
    a, b = a, b

    def init():
        for number in range(30):
            memory.add(f"number:{number} next:{number + 1}")
        goal.set(f"task:begin a:{a} b:{b} sum:{a} fingers:0")

    def begin(goal="task:begin"):
        goal.modify(task="count")

    def ask_for_sum(goal="task:count sum:?sum b:?b fingers:!?b"):
        memory.request("number:?sum next:?")
        goal.modify(task="raise_sum")

    # The last answer stays in the retrieval buffer until the next one comes. So it is not enough to wait
    # for an answer: ?sum and ?fingers make sure that it is about the right number.
    def raise_sum(goal="task:raise_sum sum:?sum fingers:?fingers", retrieval="number:?sum next:?larger"):
        memory.request("number:?fingers next:?")
        goal.modify(task="raise_fingers", sum=larger)

    def raise_fingers(goal="task:raise_fingers fingers:?fingers", retrieval="number:?fingers next:?more"):
        goal.modify(task="count", fingers=more)

    def answer(goal="task:count a:?a b:?b sum:?sum fingers:?b"):
        print(f"{a} + {b} = {sum} after {self.now():.3f} s")
        goal.clear()


if __name__ == "__main__":
    Addition().run()

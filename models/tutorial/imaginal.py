"""The imaginal module: holding a thought in mind takes time.

The agent does mental arithmetic with an intermediate result: start at 3, add 4, add 2. The running total is held
in mind while the goal says what to do.

An imaginal buffer is filled and changed through the `ImaginalModule`. Unlike a change of the goal, which costs
nothing, each change of what is imagined takes 0.2 s. Meanwhile the module is busy, and productions can wait until
it is not (`imagine="busy:False"`): a request to a busy module is lost.

What to expect
--------------
Imagining the first number takes 0.05 s for the production and 0.2 s for the module (ACT-R's imaginal delay). Each
addition takes two productions of 0.05 s, a retrieval of `F exp(-A)` = 0.05 s, and 0.2 s: 0.35 s. Saying the result
takes 0.05 s: 0.25 + 0.35 n + 0.05 s for n additions, here 1.000 s.

What to try
-----------
- `imaginal_delay = 0.4`: how much longer does the sum take?
- More numbers, in the tab *Editor*.
- Take `imagine="busy:False"` away from `hear`. It then adds 2 to the old total, and as the module is still busy with
  the first sum, it does not take the second: the result is 7.
"""

imaginal_delay = 0.2

from actr3d.actr import *


class Arithmetic(ACTR):
    goal = Buffer()
    retrieval = Buffer()
    image = Buffer()
    memory = Memory(retrieval)
    imagine = ImaginalModule(image, delay=imaginal_delay)
    start_number = 3
    additions = [4, 2]

    def init():
        for a in range(10):
            for b in range(10):
                memory.add(f"a:{a} b:{b} sum:{a + b}")
        goal.set("task:begin")

    def begin(goal="task:begin"):
        imagine.set(f"total:{start_number}")
        goal.set("task:listen")

    def hear(goal="task:listen", image="total:?total", imagine="busy:False"):
        retrieval.clear()
        if additions:
            number = additions.pop(0)
            print(f"{self.now():.3f} s: {total}, and add {number}")
            memory.request(f"a:{total} b:{number} sum:?")
            goal.set("task:add")
        else:
            print(f"{self.now():.3f} s: {total}, and that is all")
            goal.clear()

    def add(goal="task:add", retrieval="sum:?sum"):
        imagine.modify(total=sum)
        goal.set("task:listen")


if __name__ == "__main__":
    Arithmetic().run()

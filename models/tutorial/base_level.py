"""Base-level learning: practice and forgetting.

Words were studied once, twice, four or eight times. Later they are tested: at once, after minutes, after an hour,
after days.

The mechanism is `DMBaseLevel`. Each time a chunk is added to memory again, it gains activation, which fades
with time.

What to expect
--------------
`B = ln sum t_j^-d`, where t_j is the time since the j-th study (Anderson & Schooler 1991, Psychological Science 2;
Anderson & Lebiere 1998, chapter 4), with d = 0.5. A word is retrieved after `F exp(-B)` if B is above
the threshold; otherwise it is forgotten. So forgetting follows power functions: each tenfold delay costs nearly the
same activation, d ln 10 = 1.15, when all studies are long ago. Twice as many studies add nearly the same each time,
ln 2 = 0.69. The table in the *Console* compares the activations that follow from the times of retrieval with those
of the equation.

What to try
-----------
- `decay = 0.3`: forgets more slowly.
- `threshold = -5`: forgets less.
- `gap = 60`: more time between studies.
"""

decay = 0.5
threshold = -4.0
gap = 5.0

import math

from actr3d.actr import *

LOOKS = {"anchor": 1, "button": 2, "candle": 4, "dragon": 8}
# When to ask for the words [s after the last look].
DELAYS = (1, 60, 600, 3600, 86400)


class Learner(ACTR):
    goal = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval, latency=0.05, threshold=threshold)
    base_level = DMBaseLevel(memory, decay=decay)
    # How long each look at a word lies back when the clock begins [s].
    looks = {word: [gap * n for n in range(number)] for word, number in LOOKS.items()}
    tests = [(delay, word) for delay in DELAYS for word in LOOKS]
    asked = 0
    answers = []

    def init():
        for word, ages in looks.items():
            for age in ages:
                memory.add(f"word:{word}", time=age)
        self.wait()

    def wait(self):
        delay, word = self.tests.pop(0)
        yield max(0, delay - self.now())
        self.goal.set(f"task:ask word:{word}")

    def ask(goal="task:ask word:?word"):
        retrieval.clear()
        self.asked = self.now()
        memory.request("word:?word")
        goal.modify(task="answer")

    def answer(goal="task:answer word:?word", retrieval="word:?word"):
        # Firing took a production's time after the word had arrived.
        answers.append((word, self.asked, self.now() - self.asked - self.production_time))
        self.go_on()

    def give_up(goal="task:answer word:?word", memory="error:True"):
        answers.append((word, self.asked, None))
        self.go_on()

    def go_on(self):
        self.goal.clear()
        if self.tests:
            self.wait()


def predicted(word, now):
    """Returns the equation's base level."""
    return math.log(sum((now + gap * n) ** -decay for n in range(LOOKS[word])))


if __name__ == "__main__":
    agent = Learner()
    agent.run()
    print("word    looks     asked at  retrieved after  activation  equation")
    for word, asked, time in agent.answers:
        if time is None:
            found = f"{'forgotten':>15}  {'':10}"
        else:
            found = f"{time:13.3f} s  {-math.log(time / 0.05):10.3f}"
        print(f"{word:7} {LOOKS[word]:5} {asked:10.1f} s  {found}{predicted(word, asked):10.3f}")

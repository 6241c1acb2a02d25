"""Production compilation: from remembering to knowing how.

Words are translated. At first each word must be remembered: ask, wait for the answer, say it. With practice the
memory is no longer needed: seeing the word is enough to say it.

`PMCompile` watches for a production that makes a request, followed by one that uses the answer. It combines
the two into a new production that contains the answer and needs no retrieval: one for each word.

What to expect
--------------
Remembering takes 0.15 s: two productions of 0.05 s, and a retrieval of `F exp(-A)` = 0.05 s between them. The
compiled production takes 0.05 s. In Python ACT-R it begins with a utility of 0; as `ask` has -1, it is used at
once, and each word is remembered just once. (In ACT-R 7 the utility of a compiled production approaches that of its
parents each time it is compiled again: Taatgen & Anderson 2002, Cognition 86.) The tab *Productions* lists the new
productions.

What to try
-----------
- `utility_of_asking = 0`: equal utilities, so that each way is chosen half of the time.
- `utility_of_asking = 1`: the new production is never used.
"""

utility_of_asking = -1
rounds = 4

from actr3d.actr import *


class Translator(ACTR):
    goal = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval)
    # The goal may be matched and changed; the retrieval buffer drops out of the compiled production.
    compiler = PMCompile(keep="goal", request="memory.request", retrieve="retrieval")
    words = ["house", "river", "bread"] * rounds
    since = 0
    times = []

    def init():
        for word, german in (("house", "Haus"), ("river", "Fluss"), ("bread", "Brot")):
            memory.add(f"english:{word} german:{german}")
        goal.set("task:listen")

    def listen(goal="task:listen"):
        retrieval.clear()
        if words:
            self.since = self.now()
            goal.set(f"task:translate word:{words.pop(0)}")
        else:
            goal.clear()

    # It may make the request and change the goal, but do nothing else: otherwise it is not compiled.
    def ask(goal="task:translate word:?word", utility=utility_of_asking):
        goal.modify(task="say")
        memory.request("english:?word german:?")

    # The values bound here become part of the compiled production. The time does not: it is read again at each firing.
    def say(goal="task:say word:?word", retrieval="english:?word german:?german"):
        times.append((word, german, self.now() - self.since))
        goal.set("task:listen")


if __name__ == "__main__":
    agent = Translator()
    agent.run()
    for number, (word, german, time) in enumerate(agent.times):
        print(f"round {number // 3 + 1}: {word} is {german}, after {time:.3f} s")

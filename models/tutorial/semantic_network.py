"""A semantic network: is a heron an animal?

Knowledge of kinds is a network, in which each thing is only linked to the next more general one: a heron is a bird,
a bird is an animal. Whether a heron is an animal is found by walking from link to link.

The model makes chains of retrievals, and shows what happens when memory finds nothing: the memory's `error` becomes
True, which a production can match like anything else (`memory="error:True"`).

What to expect
--------------
Each link takes 0.15 s: two productions of 0.05 s, and a retrieval of `F exp(-A)` = 0.05 s. The answer yes
comes after 0.05 + 0.15 n s for n links: each level adds the same time, as Collins & Quillian (1969, Journal of Verbal
Learning and Verbal Behavior 8) found. The answer no comes when the network ends and a retrieval fails, which takes
`F exp(-threshold)`, with the threshold of 0 also 0.05 s: no heron is a fish after 0.15 * 3 + 0.15 = 0.600 s.

What to try
-----------
- `threshold = -1`: the memory searches longer before it gives up.
- Further kinds, in the tab *Editor*.
- A direct link from a heron to an animal: what happens to the time, and to the search where there are two links?
"""

threshold = 0

from actr3d.actr import *

LINKS = (
    ("heron", "bird"),
    ("owl", "bird"),
    ("bird", "animal"),
    ("pike", "fish"),
    ("fish", "animal"),
    ("animal", "thing"),
)


class Network(ACTR):
    goal = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval, threshold=threshold)
    links = LINKS
    # What it is asked, one question after another.
    questions = ["heron heron", "heron bird", "heron animal", "heron thing", "bird animal", "heron fish"]
    asked = 0

    def init():
        for thing, kind in links:
            memory.add(f"thing:{thing} kind:{kind}")
        goal.set("task:listen")

    def listen(goal="task:listen"):
        if questions:
            thing, kind = questions.pop(0).split()
            self.asked = self.now()
            goal.set(f"task:decide question:{thing} at:{thing} kind:{kind}")
        else:
            goal.clear()

    # A buffer keeps its chunk until another comes. Emptied, it holds nothing from the last question that
    # would fit this one.
    def ask_memory(goal="task:decide at:?thing kind:!?thing"):
        retrieval.clear()
        memory.request("thing:?thing kind:?")
        goal.modify(task="remember")

    def climb(goal="task:remember at:?thing", retrieval="thing:?thing kind:?higher"):
        goal.modify(task="decide", at=higher)

    def say_yes(goal="task:decide question:?question at:?kind kind:?kind"):
        print(f"{question}, {kind}: yes after {self.now() - self.asked:.3f} s")
        goal.set("task:listen")

    def say_no(goal="task:remember question:?question kind:?kind", memory="error:True"):
        print(f"{question}, {kind}: no after {self.now() - self.asked:.3f} s")
        goal.set("task:listen")


if __name__ == "__main__":
    Network().run()

"""Partial matching: remembering the wrong thing because it is similar.

Each letter represents a word. Asked for the word of b, one sometimes says the word of d; less often, for m, the word
of n; hardly ever, for c, the word of g.

With a `Partial`, a request also finds chunks that are only similar to what was asked for. Each mismatch adds `MP M`
to their activation, where M is the similarity (0 for the same, less for less similar) and MP the penalty (Anderson
& Lebiere 1998, chapter 3). Noise in activation then sometimes lifts the wrong chunk above the right one.

What to expect
--------------
The right chunk is ahead by `d = -MP M`. Each has logistic noise of scale s, so that the wrong one wins with
probability `p = ((x - 1) exp(-x) + exp(-2x)) / (1 - exp(-x))^2`, x = d / s: the difference of two such noises is
larger than d. The table in the *Console* shows the share of errors beside this, and beside the usual approximation
`1 / (1 + exp(d / t))`, t = sqrt(2) s (Anderson & Lebiere 1998, chapter 3). Of n trials, the share differs from p by
about `sqrt(p (1 - p) / n)`.

What to try
-----------
- `trials = 5000`: shares nearer to the equation.
- `noise = 0.6`: more errors.
- `penalty = 20`: fewer errors.
- A similarity of -0.1 between b and g, in the tab *Editor*.
"""

penalty = 10.0
noise = 0.3
trials = 55

import math

from actr3d.actr import *

WORDS = {"b": "boat", "d": "door", "m": "moon", "n": "nest", "c": "coat", "g": "gate"}
SIMILARITIES = {("b", "d"): -0.03, ("m", "n"): -0.06, ("c", "g"): -0.12}


class LetterWords(ACTR):
    goal = Buffer()
    retrieval = Buffer()
    # Nothing is forgotten: the threshold lies far below. No finsts: what was just retrieved is not marked.
    memory = Memory(retrieval, threshold=-30, finst_size=0)
    dm_noise = DMNoise(memory, noise=noise)
    # Letters of which nothing is said have similarity -1, so low that they are never confused.
    partial = Partial(memory, strength=penalty, limit=-1.0)
    words = WORDS
    similarities = SIMILARITIES
    cues = list(WORDS) * trials
    answers = {letter: [] for letter in WORDS}

    def init():
        for letter, word in words.items():
            memory.add(f"letter:{letter} word:{word}")
        for (one, other), similarity in similarities.items():
            partial.similarity(one, other, similarity)
        goal.set(f"task:ask cue:{cues.pop()}")

    def ask(goal="task:ask cue:?cue"):
        retrieval.clear()
        memory.request("letter:?cue")
        goal.modify(task="say")

    def say(goal="task:say cue:?cue", retrieval="word:?word"):
        answers[cue].append(word)
        if cues:
            goal.set(f"task:ask cue:{cues.pop()}")
        else:
            goal.clear()


def predicted(similarity):
    """Returns how often the wrong chunk wins: by the exact formula, and by the approximation."""
    x = -penalty * similarity / noise
    exact = ((x - 1) * math.exp(-x) + math.exp(-2 * x)) / (1 - math.exp(-x)) ** 2 if x else 0.5
    return exact, 1 / (1 + math.exp(x / math.sqrt(2)))


if __name__ == "__main__":
    agent = LetterWords()
    agent.run()
    print("letters  similarity  errors  equation  approximation")
    for (one, other), similarity in SIMILARITIES.items():
        wrong = agent.answers[one].count(WORDS[other]) + agent.answers[other].count(WORDS[one])
        share = wrong / max(1, len(agent.answers[one]) + len(agent.answers[other]))
        exact, approximate = predicted(similarity)
        print(f"{one} and {other}  {similarity:10.2f} {share:7.3f} {exact:9.3f} {approximate:14.3f}")

"""Practice and forgetting: learning which digit belongs to which noun.

One run is one session of a participant. It has eight blocks; each asks for all 20 pairs, in a new order. A noun is shown for
5 s, to be answered with its digit; then the digit is shown for 5 s, to be studied. Nothing is known in the first block.

Each pair that has been studied or retrieved leaves its buffer and so becomes stronger in memory (`DMBaseLevel`). With the
noise (`DMNoise`), a pair is sometimes too weak to be retrieved.

What to expect
--------------
The activation of a pair is `A = ln(n / (1 - d)) - d ln L` plus noise, for n uses in the L seconds since the first one
(Anderson & Lebiere 1998, chapter 4). Above the threshold, the pair is retrieved after `F exp(-A)`; below, there is no answer.
So with each block more answers are right, and faster. An answer takes 0.592 s besides the retrieval.

The experiment is that of Anderson (1981), Interference: The relationship between response latency and response accuracy,
Journal of Experimental Psychology: Human Learning and Memory 7, 326-343. The means of people, as the ACT-R tutorial (unit
4) quotes them, and of `actr3d experiment paired_associates` with 100 sessions:

| block | right answers: people | model | latency [s]: people | model |
|---|---|---|---|---|
| 1 | 0.000 | 0.000 | | |
| 2 | 0.526 | 0.547 | 2.158 | 2.196 |
| 3 | 0.667 | 0.762 | 1.967 | 1.932 |
| 4 | 0.798 | 0.859 | 1.762 | 1.709 |
| 5 | 0.887 | 0.908 | 1.680 | 1.602 |
| 6 | 0.924 | 0.933 | 1.552 | 1.491 |
| 7 | 0.958 | 0.946 | 1.467 | 1.426 |
| 8 | 0.954 | 0.955 | 1.402 | 1.363 |

Blocks 2 to 8: right answers r² = 0.96, RMSE = 0.044; latencies r² = 0.99, RMSE = 0.051 s.

- Put in: F, d, the noise and the threshold of the tutorial's model, and the times of attention, imagination and key.
- Fitted: nothing here. The authors of the tutorial chose these four for the same means.
- Predicted from them: the form of both curves, and that the same activations give both.
- It differs: people learn more slowly from the second to the third block.

What to try
-----------
- `study_time = 60.0`: more time passes between two tests of a pair, so more is forgotten.
- `noise = 0.2`: nearly all answers are right from the third block on.
- `decay = 0.3`: forgets more slowly.
"""

pairs = 20
blocks = 8
# [s]. Source: ACT-R tutorial, unit 4.
answer_time = 5.0
study_time = 5.0
# s of the activation noise, the threshold, F [s] and d: ACT-R tutorial, unit 4.
noise = 0.5
threshold = -2.0
latency_factor = 0.4
decay = 0.5
# A shift of attention, and a change of what is imagined [s]: the defaults of ACT-R 7.
attention_time = 0.085
imaginal_delay = 0.2
# Pressing a digit's key [s]: four features of 50 ms, 50 ms to begin, a movement of 107 ms, as in ACT-R 7.
key_time = 0.357

from actr3d.actr import *

NOUNS = (
    "apple",
    "basket",
    "cloud",
    "desk",
    "engine",
    "feather",
    "glove",
    "hammer",
    "island",
    "jacket",
    "kettle",
    "ladder",
    "mirror",
    "needle",
    "orange",
    "pillow",
    "queen",
    "river",
    "saddle",
    "table",
)
# Each digit belongs to two nouns.
DIGITS = {noun: number % 10 for number, noun in enumerate(NOUNS[:pairs])}


class Screen(Model):
    """Shows the nouns and digits, and keeps the answers."""

    showing = "nothing"

    def start(self):
        self.latencies = []
        for _ in range(blocks):
            # The latencies of the right answers of a block.
            self.latencies.append([])
            for self.noun in self.random.sample(NOUNS[:pairs], pairs):
                self.shown_at, self.showing = self.now(), "noun"
                yield answer_time
                self.showing = "digit"
                yield study_time

    def answered(self, digit):
        if self.showing == "noun" and digit == DIGITS[self.noun]:
            self.latencies[-1].append(self.now() - self.shown_at)


class Eyes(Model):
    """Attends to what the screen shows, which takes time."""

    def attend(self):
        yield attention_time
        screen = self.parent.screen
        self.parent.visual.set(f"kind:{screen.showing} word:{screen.noun if screen.showing == 'noun' else DIGITS[screen.noun]}")


class Hand(Model):
    """Presses a key, which takes time."""

    def press(self, digit):
        yield key_time
        self.parent.screen.answered(int(digit))


class Learner(ACTR):
    profile = "act-r-7"
    goal = Buffer()
    visual = Buffer()
    imaginal = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval, latency=latency_factor, threshold=threshold)
    base_level = DMBaseLevel(memory, decay=decay)
    activation_noise = DMNoise(memory, noise=noise)
    imagine = ImaginalModule(imaginal, delay=imaginal_delay)
    screen = Screen()
    eyes = Eyes()
    hand = Hand()

    def init():
        goal.set("task:find")

    def attend_noun(goal="task:find", screen="showing:noun"):
        eyes.attend()
        goal.modify(task="read")

    def recall(goal="task:read", visual="kind:noun word:?noun"):
        memory.request("noun:?noun digit:?")
        imagine.set("noun:?noun digit:unknown")
        goal.modify(task="answer")

    # The retrieved pair leaves its buffer, which strengthens it in memory.
    def answer(goal="task:answer", retrieval="noun:? digit:?digit"):
        hand.press(digit)
        retrieval.clear()
        goal.modify(task="study")

    def give_up(goal="task:answer", memory="error:True"):
        goal.modify(task="study")

    def attend_digit(goal="task:study", screen="showing:digit"):
        eyes.attend()
        goal.modify(task="associate")

    # So does the pair that has been studied.
    def associate(goal="task:associate", visual="kind:digit word:?digit", imaginal="noun:?"):
        imaginal.modify(digit=digit)
        imaginal.clear()
        goal.modify(task="find")


if __name__ == "__main__":
    agent = Learner()
    agent.run()
    # The measures of a session, for each block: the share of right answers, and their mean latency [s].
    accuracy = [len(times) / pairs for times in agent.screen.latencies]
    latency = [sum(times) / len(times) if times else None for times in agent.screen.latencies]
    print("block  accuracy  latency")
    for block, (share, time) in enumerate(zip(accuracy, latency), start=1):
        print(f"{block:5} {share:9.2f}  {'':7}" if time is None else f"{block:5} {share:9.2f}  {time:.3f} s")

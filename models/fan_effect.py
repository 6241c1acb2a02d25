"""The fan experiment: is the hippie in the park?

Facts such as «the hippie is in the park» have been learned. Then a sentence is shown, and the answer is whether it is one
of the facts. One run is one trial. The fan of a person is the number of facts about that person, the fan of a location the
number of facts about that place. A target is a learned fact; a foil pairs a person and a location of different facts.

The person and the location of the sentence are the sources of activation. A fact about the person, or one about the
location, is retrieved (which of the two is chosen at random), and compared with the sentence.

What to expect
--------------
The activation of a fact is `A = sum W_j S_j` over the words that it shares with the sentence, with `W_j = 1/2` and
`S_j = S - ln(fan_j + 1)`; its retrieval takes `F exp(-A)` (Anderson & Reder 1999, Journal of Experimental Psychology:
General 128). Everything else takes 0.845 s. A target shares both words, the fact that a foil retrieves only one: the time
grows with both fans, and foils take longer. All answers are right.

The experiment is that of Anderson (1974), Retrieval of propositional information from long-term memory, Cognitive
Psychology 6, 451-474. The reaction times [s] of people, as the ACT-R tutorial (unit 5) quotes them, and of
`actr3d experiment fan_effect`, with 20 participants and 10 trials of each in each condition:

| sentence | fan of location | people: fan of person 1 | 2 | 3 | model: 1 | 2 | 3 |
|---|---|---|---|---|---|---|---|
| target | 1 | 1.11 | 1.17 | 1.22 | 1.099 | 1.157 | 1.205 |
| target | 2 | 1.17 | 1.20 | 1.22 | 1.157 | 1.227 | 1.286 |
| target | 3 | 1.15 | 1.23 | 1.36 | 1.205 | 1.286 | 1.354 |
| foil | 1 | 1.20 | 1.22 | 1.26 | 1.245 | 1.291 | 1.326 |
| foil | 2 | 1.25 | 1.36 | 1.29 | 1.297 | 1.335 | 1.371 |
| foil | 3 | 1.26 | 1.47 | 1.47 | 1.323 | 1.371 | 1.411 |

r² = 0.75, RMSE = 0.053 s (targets alone 0.81 and 0.036 s, foils alone 0.72 and 0.065 s).

- Put in: F, S, and the 0.845 s, which are the sum of the times that the tutorial gives to its model without eyes and hands.
- Fitted: nothing here. The authors of the tutorial chose F, S and these times for the same 18 reaction times.
- Predicted from them: the order of the conditions, the form of the curves, and the difference of targets and foils. In the
  model, person and location have equal effects; people were slowed more by the fan of the location in foils.
- Not modelled: differences between people, variability and errors.

What to try
-----------
- `person_fan = 3`: three facts are known of the person, too.
- `probe = "foil"`: the answer is no.
- `strength = 2.0`: everything becomes faster.
"""

person_fan = 1
location_fan = 3
probe = "target"
# F [s] and S: ACT-R tutorial, unit 5.
latency_factor = 0.63
strength = 1.6
# From the sentence to its two words in mind, after the first production [s]; and pressing a key [s]: ACT-R tutorial, unit 5.
reading_time = 0.535
key_time = 0.16

from actr3d.actr import *

# Three people and six places with one fact each, three and three with two, three and two with three: one fact for each person in each
# combination of fans.
FACTS = (
    "hippie park",
    "lawyer bank",
    "sailor cave",
    "captain park",
    "captain tower",
    "baker park",
    "baker bank",
    "painter harbour",
    "painter mill",
    "doctor church",
    "doctor harbour",
    "doctor forest",
    "farmer church",
    "farmer castle",
    "farmer cellar",
    "singer church",
    "singer castle",
    "singer lake",
)


def fan(word):
    """Returns the number of facts about a person or a location."""
    return sum(word in fact.split() for fact in FACTS)


def sentences():
    """Returns the sentences of the condition, as a person and a location each."""
    people, locations = zip(*(fact.split() for fact in FACTS))
    return [
        (person, location)
        for person in dict.fromkeys(people)
        for location in dict.fromkeys(locations)
        if (fan(person), fan(location)) == (person_fan, location_fan) and (f"{person} {location}" in FACTS) == (probe == "target")
    ]


class Eyes(Model):
    """Reads the sentence, which takes time."""

    def read(self):
        yield reading_time
        self.parent.imaginal.set(f"person:{self.parent.person} location:{self.parent.location}")


class Hand(Model):
    """Presses a key, which takes time."""

    def press(self, key):
        yield key_time
        self.parent.answer, self.parent.reaction_time = key, self.now()


class Recognition(ACTR):
    profile = "act-r-7"
    goal = Buffer()
    imaginal = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval, latency=latency_factor)
    spreading = DMSpreading(memory, imaginal)
    spreading.strength = strength
    eyes = Eyes()
    hand = Hand()
    answer = reaction_time = None

    def init():
        self.person, self.location = self.random.choice(sentences())
        for fact in FACTS:
            person, location = fact.split()
            memory.add(f"person:{person} location:{location}")
        goal.set("task:read")

    def read(goal="task:read"):
        eyes.read()
        goal.modify(task="recall")

    # Both productions match: one of them is chosen at random.
    def recall_by_person(goal="task:recall", imaginal="person:?person"):
        memory.request("person:?person location:?")
        goal.modify(task="compare")

    def recall_by_location(goal="task:recall", imaginal="location:?location"):
        memory.request("person:? location:?location")
        goal.modify(task="compare")

    def say_yes(goal="task:compare", imaginal="person:?who location:?where", retrieval="person:?who location:?where"):
        hand.press("yes")
        goal.modify(task="wait")

    def say_no_other_person(goal="task:compare", imaginal="person:?who", retrieval="person:!?who"):
        hand.press("no")
        goal.modify(task="wait")

    def say_no_other_location(goal="task:compare", imaginal="location:?where", retrieval="location:!?where"):
        hand.press("no")
        goal.modify(task="wait")


if __name__ == "__main__":
    agent = Recognition()
    agent.run()
    # The measures of a trial: the reaction time [s], and whether the answer is right; None if the run has ended before the answer.
    reaction_time = agent.reaction_time
    correct = None if agent.answer is None else agent.answer == ("yes" if probe == "target" else "no")
    answered = "no answer" if agent.answer is None else f"{agent.answer}, after {reaction_time:.3f} s"
    print(f"The {agent.person} is in the {agent.location}: {answered}")

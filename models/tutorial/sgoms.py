"""SGOMS: planning units and unit tasks, interruption, and resumption.

Somebody makes tea: boil, steep, pour. The telephone rings, and is answered. Then tea-making continues.

Work is divided into *planning units*, these into *unit tasks*, these into methods and operators (West & Nagy 2007, Journal of
Cognitive Engineering and Decision Making 1). `Ordered` unit tasks are a chain in memory: the last one is the cue for the
next. `Situated` ones are chosen by what `b_context` says. The ears, a quick parallel system, ask for an interruption by another
planning unit, the response. `when:end` lets the unit task end first, `when:now` cuts it short. The place is kept as a chunk in memory,
and remembered when the response is over.

What to expect
--------------
From one ordered unit task to the next it takes two productions and a retrieval (0.05 s each, as plans have a base level of 0); from
one situated unit task to the next, two productions. The telephone rings at 2.0 s, while the tea steeps, the ears notice at 2.01 s,
and a production of 0.05 s begins the response: the tea is left at 2.060 s. The place has one reference then. T seconds later its
activation is `A = ln T^-0.5`, and resumption takes `F exp(-A)` = 0.05 T^0.5, beside two productions: the longer the call, the longer
it takes. Here, T = 5.55 s and 0.118 s. The interrupted unit task begins again: the tea steeps from 7.828 s on. All is done at 10.328 s.

What to try
-----------
- `when = "end"`: the unit task ends before the telephone is answered.
- `ring_at = 1.27`: it rings between two unit tasks.
- `call_time = 30`: T exceeds exp(2 * 1.5) = 20 s, so the place is below the threshold of -1.5, and is forgotten; the tea is begun
  again.
"""

ring_at = 2.0
call_time = 4.0
when = "now"
threshold = -1.5

from actr3d.actr import *
from actr3d.sgoms import SGOMS, Ordered, Situated


class Telephone(Model):
    ringing = False

    def start(self):
        yield ring_at
        print(f"{self.now():.3f} s: the telephone rings")
        self.ringing = True


class Hands(Model):
    busy = False
    jobs = 0

    def do(self, seconds):
        self.jobs += 1
        job = self.jobs
        self.busy = True
        yield seconds
        if job == self.jobs:  # what was left for something else does not end
            self.busy = False


class Ears(ProductionSystem):
    production_time = 0.01

    def hear(telephone="ringing:True"):
        telephone.ringing = False
        b_context.set("call:waiting")
        b_interrupt.set(f"planning_unit:answer when:{when}")


class Cook(SGOMS):
    DM = Memory(SGOMS.b_DM, threshold=threshold)
    base_level = DMBaseLevel(DM)
    ears = Ears()
    hands = Hands()
    make_tea = Ordered("boil", "steep", "pour", baselevel=0)
    answer = Situated(pick_up="call:waiting", talk="call:open", until="call:none")

    def init():
        b_context.set("call:none")
        b_plan_unit.set("planning_unit:make_tea")

    def begin(b_unit_task="unit_task:?task state:start"):
        print(f"{self.now():.3f} s: {task}")
        b_method.set("method:use_hands")
        hands.do(call_time if task == "talk" else 1.0)
        b_unit_task.modify(state="running")

    def end(b_unit_task="unit_task:?task type:ordered state:running", hands="busy:False"):
        b_unit_task.modify(state="finished")

    def picked_up(b_unit_task="unit_task:pick_up state:running", hands="busy:False"):
        b_context.set("call:open")
        b_unit_task.modify(state="finished")

    def hung_up(b_unit_task="unit_task:talk state:running", hands="busy:False"):
        b_context.set("call:none")
        b_unit_task.modify(state="finished")

    def wonder(b_plan_unit="state:lost lost:place interrupted:?unit"):
        print(f"{self.now():.3f} s: where was I?")
        b_plan_unit.set("planning_unit:?unit")

    def done(b_plan_unit="planning_unit:make_tea state:finished"):
        print(f"{self.now():.3f} s: that is all")
        self.stop()


class Kitchen(Model):
    telephone = Telephone()
    cook = Cook()


if __name__ == "__main__":
    Kitchen().run()

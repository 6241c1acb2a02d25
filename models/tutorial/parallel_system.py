"""A parallel production system: a fast eye beside slow central cognition.

A cook stirs a soup, and watches the stove. Stirring is central cognition, step by step. Watching runs beside it all
the time and is faster, but it can only raise an alarm.

A `ProductionSystem` inside an agent has productions and a cycle time of its own, and sees the agent's buffers by
name. The two run at the same time, and meet in a buffer. (This is how Python ACT-R models simple, automatic
processes in parallel to central cognition: Stewart & West 2007, Cognitive Systems Research 8.)

What to expect
--------------
Smoke rises at 0.33 s. The watch takes 0.01 s, and raises the alarm at 0.34 s. At that time the cook has decided on a
stir that is done at 0.35 s. Only then the central system matches again: it chooses the alarm, as that has the
higher utility, and turns the stove off at 0.40 s. Cognition reacts to an alarm after 0.05 to 0.10 s, whatever the
moment.

What to try
-----------
- `smoke_time = 0.36`: another moment within the stir.
- `watch_time = 0.1`: a slow watch.
- `utility=1` for `stir`, in the tab *Editor*: the cook stirs on, though the alarm is there.
"""

smoke_time = 0.33
watch_time = 0.01

from actr3d.actr import *


class Stove(Model):
    smoke = False
    on = True

    def start(self):
        yield smoke_time
        print(f"{self.now():.3f} s: smoke")
        self.smoke = True


class Watch(ProductionSystem):
    production_time = watch_time

    def raise_alarm(stove="smoke:True on:True", alarm=None):
        print(f"{self.now():.3f} s: the eye raises the alarm")
        alarm.set("danger:smoke")


class Cook(ACTR):
    goal = Buffer()
    alarm = Buffer()
    watch = Watch()

    def init():
        goal.set("task:stir")

    def stir(goal="task:stir"):
        print(f"{self.now():.3f} s: stirs")

    def turn_off(alarm="danger:smoke", utility=1):
        print(f"{self.now():.3f} s: turns the stove off")
        stove.on = False
        alarm.clear()
        goal.clear()


class Kitchen(Model):
    stove = Stove()
    cook = Cook()


if __name__ == "__main__":
    Kitchen().run()

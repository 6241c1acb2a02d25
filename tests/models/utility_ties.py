# seeds: 1 2 3
# utility=, ties at random, production_time as a function, its noise, a threshold, match delay.
from python_actr import *


class Chooser(ACTR):
    goal = Buffer()
    production_time_sd = 0.01

    def init():
        goal.set('n:0 kind:tie')

    def left(goal='n:?n kind:tie', utility=0.5):
        goal.set('n:%d kind:%s' % (int(n) + 1, 'tie' if int(n) < 8 else 'fixed'))

    def right(goal='n:?n kind:tie', utility=0.5):
        goal.set('n:%d kind:%s' % (int(n) + 1, 'tie' if int(n) < 8 else 'fixed'))

    def weak(goal='kind:fixed', utility=0.1):
        print('never')

    def strong(goal='kind:fixed', utility=0.2):
        goal.set('kind:end')

    def below(goal='kind:end', utility=-2):
        print('threshold is lowered')
        goal.clear()

    def production_threshold(self):
        return -3 if self.now() > 1 else 0


class Timed(ACTR):
    goal = Buffer()
    production_match_delay = 0.02
    fast = True

    def production_time(self):
        return 0.03 if self.fast else 0.125

    def init():
        goal.set('n:0')

    def up(goal='n:?n!12'):
        self.fast = not self.fast
        n = int(n) + 1
        goal.set('n:?n')


class Clock(Model):
    ticks = 0

    def start(self):
        for i in range(20):
            yield 0.1
            self.ticks += 1


class World(Model):
    clock = Clock()


world = World()
world.a = Chooser()
world.run(limit=0.0137)
world.b = Timed()
log_everything(world)
world.run(limit=3)

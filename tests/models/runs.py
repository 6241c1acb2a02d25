# run(limit) again and again, stop(), several programs' runs in one file, func, parts added and taken away on the way.
from python_actr import *


class Beeper(Model):
    name = 'beeper'
    beeps = 0

    def start(self):
        while True:
            yield 0.1
            self.beeps += 1
            print('%.2f beep %d' % (self.now(), self.beeps))


class Thing(Model):
    name = 'thing'
    x = 1


class Agent(ACTR):
    goal = Buffer()
    production_time = 0.06
    stopping = False

    def init():
        goal.set('count:0')

    def count(goal='count:?n!6'):
        n = int(n) + 1
        goal.set('count:?n')
        if n == 2 and self.stopping:
            self.stop()


class World(Model):
    first = Thing()
    value = 0


world = World()
world.agent = Agent()
for i in range(5):
    world.run(limit=0.07)
    print(i, round(world.now(), 3), world.agent.goal.chunk)
world.beeper = Beeper()
world.run(limit=0.25)
world.thing = Thing()
world.run(limit=0.25)
print(round(world.now(), 3), world.beeper.beeps)
print(sorted(c.name for c in world.get_children() if hasattr(c, 'x')))
world.thing.parent = None
print(sorted(c.name for c in world.get_children() if hasattr(c, 'x')))
print(world.thing.parent is None, world.agent.parent is world)


def late():
    world.value = 5
    print('func at', round(world.now(), 3))


world.run(limit=0.15, func=late)
for i in range(3):
    agent = Agent()
    agent.stopping = True
    agent.run()
    print(round(agent.now(), 3), agent.goal.chunk)
    agent.run()
    print(round(agent.now(), 3), agent.goal.chunk)
    agent.run(limit=1)
    print(round(agent.now(), 3))

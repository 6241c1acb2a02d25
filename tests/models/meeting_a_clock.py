# Clocks and agents that meet at one moment: who comes first depends on how the delays until then add up as floating point
# numbers; and so does whether what falls on a run's end still belongs to it.
from python_actr import *


class World(Model):
    light = 'off'
    changes_made = 0

    def __init__(self, period):
        Model.__init__(self)
        self.period = period

    def start(self):
        while True:
            yield self.period
            self.changes_made += 1
            self.light = 'on' if self.light == 'off' else 'off'


class Agent(ACTR):
    goal = Buffer()

    def init():
        goal.set('count 0')

    def tick(goal='count ?n', top='light:off'):
        n = int(n) + 1
        goal.set('count ?n')

    def seen(goal='count ?n', top='light:on'):
        print('%.3f on after %s' % (self.now(), n))
        goal.set('wait')

    def off(goal='wait', top='light:off'):
        print('%.3f off' % self.now(), top.changes_made)
        goal.set('count 0')


class Slower(Agent):
    production_time = 0.025
    production_match_delay = 0.01


for period in (1, 0.3, 0.7, 0.85):
    for kind in (Agent, Slower):
        world = World(period)
        world.agent = kind()
        world.run(limit=9)
        print(period, kind.__name__, world.changes_made, world.agent.goal.chunk)
        for i in range(150):
            world.run(limit=0.01)
        world.run(limit=0.5)
        print('%.3f' % world.now(), world.changes_made, world.agent.goal.chunk)

for limit in (1, 2, 3, 4, 5, 6):
    agent = Agent()
    agent.light = 'off'
    agent.run(limit=limit)
    print(limit, agent.goal.chunk)

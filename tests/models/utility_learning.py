# seeds: 1 2 3
# PMNew with noise; rewards from bodies and from the environment; utilities printed.
from python_actr import *


class Agent(ACTR):
    goal = Buffer()
    pm = PMNew(alpha=0.2)
    noise = PMNoise(noise=0.4, baseNoise=0.2)
    production_threshold = -20

    def init():
        goal.set('choose')

    def heads(goal='choose'):
        goal.set('check heads')

    def tails(goal='choose', utility=0.5):
        goal.set('check tails')

    def right(goal='check heads'):
        self.reward(4)
        goal.set('choose')

    def wrong(goal='check tails'):
        self.parent.judge(self)
        goal.set('choose')


class World(Model):
    judged = 0

    def judge(self, agent):
        self.judged += 1
        if self.judged % 2:
            agent.reward(-1)
        else:
            agent.success()
            agent.failure()


world = World()
world.agent = Agent()
world.run(limit=3)
for name, value in sorted(world.agent.get_activation().items()):
    print(name, '%.4f' % value)
print(world.agent.get_activation('nobody'), world.judged)
print(['%.4f %s' % (p.util, p.name) for p in world.agent._productions])

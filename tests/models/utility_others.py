# seeds: 1 2
# PMPGC and its variants, PMTD, and a production_threshold that noise gets over.
from python_actr import *


class Base(ACTR):
    goal = Buffer()
    noise = PMNoise(noise=0.3)
    tries = 0

    def init():
        goal.set('choose')

    def slow(goal='choose'):
        goal.set('slow 1')

    def slow_more(goal='slow 1'):
        goal.set('slow 2')

    def slow_end(goal='slow 2'):
        self.tries += 1
        if self.tries % 3:
            self.success()
        else:
            self.failure()
        goal.set('choose')

    def fast(goal='choose', utility=0.1):
        goal.set('fast')

    def fast_end(goal='fast'):
        self.tries += 1
        self.reward(0.5 if self.tries % 2 else -0.5)
        goal.set('choose')


class Gain(Base):
    pm = PMPGC(goal=10)


class Success(Base):
    pm = PMPGCSuccessWeighted(goal=5)


class Mixed(Base):
    pm = PMPGCMixedWeighted()


class Difference(Base):
    pm = PMTD(alpha=0.3, discount=0.5, cost=0.01)


class Lazy(Base):
    production_threshold = 0.3

    def start(self):
        while True:
            yield 0.1
            self.woken = True


for kind in [Gain, Success, Mixed, Difference, Lazy]:
    agent = kind()
    agent.run(limit=2.5)
    print(kind.__name__, agent.tries, ' '.join('%s %.4f' % item for item in sorted(agent.get_activation().items())))

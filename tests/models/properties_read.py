# A property may change something each time it is read: it is read just as often as python_actr reads it.
from python_actr import *


class Counter(Model):
    reads = 0

    @property
    def next(self):
        self.__dict__['reads'] += 1
        return self.__dict__['reads']


class Agent(ACTR):
    goal = Buffer()
    counter = Counter()

    def init():
        goal.set('go')

    def look(goal='go', counter='next:?n'):
        print('look', n)


Agent().run(0.41)

# In a body, Python's own names mean what they always mean, also where the file has others of that name.
from python_actr import *
from math import *


def max(a, b):
    return 'mine'


id = 7


class Agent(ACTR):
    goal = Buffer()
    goal.set('a')

    def first(goal='a'):
        print(pow(2, 3), max(1, 2), callable(id))
        goal.set('b')

    def second(goal='b'):
        total = 0
        for n in [1, 2, 3]:
            total = max(total, n)
        sum = sum([1, 2])
        print(total, sum)
        goal.clear()


Agent().run()
print('done', id)

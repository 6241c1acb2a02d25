# Failures with other thresholds, caps of time, and a memory that fails at once.
from python_actr import *


class Agent(ACTR):
    goal = Buffer()
    a = Buffer()
    b = Buffer()
    slow = Memory(a, latency=1.0, threshold=-5, maximum_time=3)
    quick = Memory(b, latency=0.01, threshold=2)
    level_a = DMFixed(slow)
    level_b = DMFixed(quick, default=2)

    def init():
        slow.add('x 1', fixed=-4)
        slow.add('x 2', fixed=-0.25)
        quick.add('y 1')
        quick.add('y 2', fixed=3)
        quick.add('y 3', fixed=1.5)
        quick.add('y 3', fixed=1.25)
        goal.set('n:0')

    def first(goal='n:0'):
        slow.request('x 1')
        quick.request('y ?')
        goal.set('n:1')

    def second(goal='n:1', b='y ?v'):
        print('b', v)
        quick.request('y 1')
        goal.set('n:2')

    def third(goal='n:2', a='x ?v', b='y ?w'):
        print('a', v, w)
        slow.request('nothing')
        quick.request('y !1!2!3')
        goal.set('n:3')

    def fourth(goal='n:3', quick='error:True', slow='error:?e busy:?b'):
        print('quick failed', e, b)
        goal.set('n:4')

    def fifth(goal='n:4', slow='error:True'):
        print('slow failed')
        print(quick.get_activation('y 3'), slow.get_activation('x 2'))
        goal.clear()


agent = Agent()
log_everything(agent)
agent.run()

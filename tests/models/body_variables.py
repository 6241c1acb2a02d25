"""Bodies of productions that look at their variables with locals, vars, eval and exec."""

from python_actr import *


class Agent(ACTR):
    goal = Buffer()
    step = 2

    def init():
        exec('goal.set("a 1")')
        print('%(step)s' % locals())

    def evaluate(goal='a ?n'):
        print(eval('int(n) + step'), 'n' in locals(), eval('n + m', {'n': 'x', 'm': 'y'}))
        exec('m = int(n) + 5')
        exec('goal.set("b ?n ?m")')
        print(m)

    def look(goal='b ?n ?m'):
        print('%(n)s %(m)s' % locals(), sorted(vars()), 'Agent' in dir(), vars(self)['step'])
        locals()['k'] = 7
        print(k, sorted(locals()))
        goal.set('c ?k')

    def inner(goal='c ?n'):
        def own(a):
            return '%(a)s' % locals(), 'n' in locals()
        print(own(1), (lambda b: eval('b + 1'))(2))
        goal.clear()


Agent().run(1)

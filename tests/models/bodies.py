# Bodies in all their forms: one-liners, several lines of parameters, docstrings, imports, loops, functions, exceptions.
from python_actr import *


class Agent(ACTR):
    goal = Buffer()
    other = Buffer()
    words = {'one': 1}
    production_time = 0.04

    def b_init():
        shared = 'seen by all'
        import math
        def double(x):
            return x * 2
        goal.set('step:1')

    def c_init():
        print(shared, double(4), math.floor(2.5))

    def one_line(goal='step:1'): print('one line', shared); goal.set('step:2')

    def long_signature(
            goal='step:2 with:?w!None',
            other='a:?a b:!?a',
            utility=0.3):
        print('long', w, a)

    def long_signature_2(
        goal='step:2',  # a remark
        other=None,
        utility=0.2,
    ):
        """A docstring in a body."""
        # a remark
        text = '''two
lines'''
        print(text)
        for i in range(2):
            for word in ['x', 'y']:
                if word == 'y' and i == 0:
                    continue
                print(i, word)
            else:
                print('else')
        while True:
            break
        try:
            words['missing']
        except KeyError as error:
            print('KeyError', error)
        finally:
            goal.set('step:3 n:4')
        self.production_time = 0.1

    def functions(goal='step:3 n:?n'):
        import json
        from math import sqrt as root
        square = lambda x: x * x
        with_default = dict(a=1, b=[2, 3])
        print(json.dumps(with_default), square(3), root(16), n, random is self.random)
        n = int(n) * 2
        a, (b, c) = 1, (2, 3)
        del a
        assert n == 8
        print([i for i in range(3)], sum(i for i in [1, 2]), max(double(i) for i in range(3)) if False else '', f'{n} {b + c:>3}')
        goal.modify(step=4, n=n)

    def typed(goal='step:4 n:8', self='words:?w'):
        print('typed', goal['n'], type(goal['n']).__name__, w)
        goal['extra'] if 'extra' in goal.chunk else goal.chunk.__setitem__('extra', 'e')
        print(goal.chunk, goal.chunk.get('none'), sorted(goal.chunk.items()))
        if goal.chunk == {'step': 4, 'n': 8, 'extra': 'e'}:
            print('equal')
        print(goal == goal.chunk, goal == None, other == None)
        goal.clear()


agent = Agent()
log_everything(agent)
agent.run()

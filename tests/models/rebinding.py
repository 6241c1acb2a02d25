# What a body assigns is seen by ?name in what it passes on; text that was bound stays text.
from python_actr import *


class Agent(ACTR):
    goal = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval)
    total = 0

    def init():
        a_number = 5
        goal.set('count:0')
        memory.add('double 3 6')

    def count(goal='count:?n!4'):
        print('n is', repr(n))
        n = int(n) + 1
        self.total += n
        goal.set('count:?n')
        print('chunk', goal.chunk, repr(goal['count']))

    def done(goal='count:4', retrieval=None):
        half = '3'
        word = 'double'
        memory.request('?word ?half ?')
        goal.set('done:?word was:?half')

    def answer(goal='done:?w was:?h', retrieval='?w ?h ?r'):
        r = float(r) / 4
        for i in range(2):
            goal.set('r:?r i:?i')
            print(goal.chunk)
        x = y = z = 1
        x += 1
        (p, q) = 'left right'.split()
        goal.set('?p ?q ?x')
        print(goal.chunk, self.total)
        retrieval.clear()

    def last(goal='?p ?q ?x'):
        if x == '2':
            p = 'changed'
        else:
            p = 'same'
        goal.set('end ?p')
        memory.add('?p ?q ?x')
        print([str(c) for c in memory.dm])


agent = Agent()
log_everything(agent)
agent.run()

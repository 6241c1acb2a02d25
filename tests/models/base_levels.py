# seeds: 1 2
# Base levels exact, optimized and hybrid, with noise of both kinds.
from python_actr import *


def make(limit):
    class Agent(ACTR):
        goal = Buffer()
        retrieval = Buffer()
        memory = Memory(retrieval, latency=0.3, threshold=-3)
        base = DMBaseLevel(memory, decay=0.5, limit=limit)
        noise = DMNoise(memory, noise=0.2, baseNoise=0.1)

        def init():
            for i in range(5):
                memory.add('item %d' % i)
            goal.set('n:0')

        def ask(goal='n:?n!15'):
            memory.request('item ?')
            goal.set('got:?n')

        def got(goal='got:?n', retrieval='item ?i', memory='busy:False'):
            print('%.3f' % self.now(), i, '%.3f' % memory.get_activation('item ?i'))
            memory.add('item ?i')
            retrieval.clear()
            goal.set('n:%d' % (int(n) + 1))

        def failed(goal='got:?n', memory='error:True'):
            print('%.3f' % self.now(), 'failed')
            goal.set('n:%d' % (int(n) + 1))

    return Agent()


for limit in [None, 0, 1, 3]:
    print('limit', limit)
    make(limit).run(limit=20)
